#!/usr/bin/env python3
"""Generates the part meshes of Lin & Koren's five-axis machine (their Fig. 7) as PLY files beside this script.

Machine frame M, mm, all axes at zero: x to the right, y to the back, z up. The tool tip stands at the origin,
A turns about the x axis through it, B about the vertical through (0, 96). The work frame's origin is at
(8, 96, 120) and the stock stands on the fixture at z = 100.

Room to move, which the shapes respect for A within +-70 deg, X +-80, Y -10..250, Z 40..400:
  below    nothing on the cradle reaches lower than z = -195 (slide top -200)
  above    cradle, table and stock stay within 226 of the A axis (Y slide bottom 240)
  behind   the Y slide's back reaches y = 400 at Y = 250 (column front 415)
"""

import math
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from machine_kit import (ACCENT, ALUMINIUM, BRASS, GROUND, ORANGE, OXIDE, PAINT, PAINT_DARK, RUBBER, STEEL,  # noqa: E402
                         cap_screw, downward, screw_circle, sector)
from solid_kit import (Part, along_x, along_y, box, circle, cylinder, lathe, mirror_x, move, outline, prism,  # noqa: E402
                       rectangle, tube, turn_z)



def hexagon_nut(x, y, z, across=16.0, height=9.0):
    r = across / math.sqrt(3.0)
    points = [(x + r * math.cos(k * math.pi / 3), y + r * math.sin(k * math.pi / 3)) for k in range(6)]
    return prism(outline(points), "z", z, z + height, 1.0)


def rail(axis, low, high, across, top):
    """A profiled guide rail 18 wide and 18 high with its screw caps, its foot at `top` - 18."""
    w = 9.0
    shape = [(-w, 0), (w, 0), (w, 6), (w - 2.5, 9), (w - 2.5, 12), (w, 15), (w, 18, 1.5), (-w, 18, 1.5), (-w, 15),
             (-w + 2.5, 12), (-w + 2.5, 9), (-w, 6)]
    if axis == "x":  # across = y, up = z
        return prism(outline([(across + p[0], top - 18 + p[1], *p[2:]) for p in shape]), "x", low, high, 0.6)
    if axis == "y":  # across = x, up = z
        return prism(outline([(across + p[0], top - 18 + p[1], *p[2:]) for p in shape]), "y", low, high, 0.6)
    # vertical rail standing on a wall that faces -y: across = x, top = y of its front
    return prism(outline([(across + p[0], top + 18 - p[1], *p[2:]) for p in shape]), "z", low, high, 0.6)


def screw_row(axis, low, high, count, across, top):
    """Screw caps on top of a rail."""
    spots = [low + (high - low) * (k + 0.5) / count for k in range(count)]
    cap = cylinder(4.0, -1.0, 0.3, 0.2, 10)
    if axis == "x":
        return [move(cap, s, across, top) for s in spots]
    if axis == "y":
        return [move(cap, across, s, top) for s in spots]
    flat = along_y(cylinder(4.0, -0.3, 1.0, 0.2, 10))
    return [move(flat, across, top, s) for s in spots]


# ---------------------------------------------------------------- fixed

def bed():
    part = Part()
    part.add(PAINT, prism(rectangle(-540, 540, -210, 330, 22), "z", -470, -318, 5),
             prism(rectangle(-290, 290, 250, 880, 22), "z", -470, -305, 5))
    # ribs of the casting, front and sides
    for x in range(-480, 481, 120):
        part.add(PAINT, prism(outline([(x - 9, -222), (x + 9, -222), (x + 9, -200), (x - 9, -200)], 4, 3),
                              "z", -462, -326, 3))
    for y in range(-150, 300, 105):
        for x in (-1, 1):
            part.add(PAINT, box(*sorted((x * 530, x * 552)), y - 9, y + 9, -462, -326, 3))
    # plinth, feet
    part.add(PAINT_DARK, prism(rectangle(-556, 556, -228, 340, 26), "z", -500, -466, 4),
             prism(rectangle(-306, 306, 250, 896, 26), "z", -500, -466, 4))
    for x, y in ((-480, -160), (480, -160), (-480, 270), (480, 270), (-240, 830), (240, 830)):
        part.add(OXIDE, move(lathe([(0, 0), (44, 0, 2), (44, 12, 3), (20, 24), (20, 60), (0, 60)], 24), x, y, -540))
    # way seats, rails and the drip edges beside them
    for y in (-90, 220):
        part.add(GROUND, box(-520, 520, y - 26, y + 26, -322, -300, 2))
        part.add(STEEL, rail("x", -515, 515, y, -282))
        part.add(OXIDE, *screw_row("x", -515, 515, 16, y, -282))
    # stainless roof between the rails with its folds, ball screw trough ends
    part.add(ALUMINIUM, prism(outline([(-56, -316), (186, -316), (186, -304, 3), (65, -288, 6), (-56, -304, 3)]),
                              "x", -520, 520, 1.0))
    for x in (-1, 1):
        part.add(PAINT_DARK, box(*sorted((x * 512, x * 536)), -130, 260, -322, -240, 4))
        part.add(OXIDE, move(along_x(cylinder(8, -2, 3, 1, 12)), x * 524, -100, -262))
    # chip trough with a lip along the front
    part.add(PAINT_DARK, prism(outline([(-196, -322), (-150, -322), (-150, -310), (-184, -310), (-184, -292, 2),
                                        (-196, -292, 2)]), "x", -525, 525, 2))
    # operator's emergency stop and a name plate on the front
    part.add(ACCENT, prism(rectangle(-110, 110, -425, -365, 6), "y", -226, -220, 1.5))
    part.add(GROUND, prism(rectangle(-96, 96, -401, -389, 2), "y", -228, -224, 0.6))
    # T-slotted pad in front of the column
    for x in (-262, 224):
        part.add(GROUND, *[box(x + 14 * k, x + 14 * k + 9, 345, 405, -308, -292, 1) for k in range(3)])
    return part


def column():
    part = Part()
    side = [(-215, -310), (215, -310), (165, 395), (-165, 395)]
    part.add(PAINT, prism(outline(side, 14), "y", 415, 810, 8))
    # foot flange with its bolts
    part.add(PAINT, prism(rectangle(-245, 245, 400, 840, 20), "z", -310, -272, 4))
    for y in range(440, 821, 76):
        for x in (-232, 232):
            part.add(OXIDE, hexagon_nut(x, y, -273, 20, 10))
    # framed front: raised ribs on the casting's face
    for z0, z1 in ((-240, -90), (-60, 90), (120, 270)):
        def half(z):
            return 215 - 50 * (z + 310) / 705 - 34
        part.add(PAINT_DARK, prism(outline([(-half(z0), z0), (half(z0), z0), (half(z1), z1), (-half(z1), z1)], 14),
                                   "y", 411, 424, 3))
        for k in range(1, 4):
            z = z0 + (z1 - z0) * k / 4
            part.add(PAINT, box(-half(z) + 14, half(z) - 14, 408, 420, z - 4, z + 4, 2))
    # side ribs
    for y in (470, 612, 754):
        lean = [(-224, -276), (-180, -276), (-130, 380), (-172, 380)]
        rib = prism(outline(lean, 4), "y", y - 11, y + 11, 3)
        part.add(PAINT, rib, mirror_x(rib))
    # accent band and top table with the Y rails
    part.add(ACCENT, prism(rectangle(-182, 182, 409, 816, 16), "z", 330, 352, 3))
    part.add(PAINT, prism(rectangle(-172, 172, 412, 812, 14), "z", 386, 412, 4))
    for x in (-120, 120):
        part.add(GROUND, box(x - 22, x + 22, 416, 808, 408, 418, 1.5))
        part.add(STEEL, rail("y", 418, 806, x, 436))
        part.add(OXIDE, *screw_row("y", 418, 806, 8, x, 436))
    part.add(STEEL, move(along_y(cylinder(9, 425, 800, 1, 20)), 0, 0, 430))
    part.add(PAINT_DARK, box(-36, 36, 420, 450, 408, 452, 4), box(-36, 36, 780, 812, 408, 452, 4))
    part.add(OXIDE, move(along_y(cylinder(30, 808, 920, 3, 32)), 0, 0, 430))
    return part


# ---------------------------------------------------------------- table side

def x_slide():
    part = Part()
    part.add(PAINT, prism(rectangle(-262, 262, -122, 252, 16), "z", -246, -204, 4))
    # skirt ribs
    for x in range(-220, 221, 55):
        part.add(PAINT, box(x - 6, x + 6, -127, -118, -240, -212, 2), box(x - 6, x + 6, 248, 257, -240, -212, 2))
    # ground top with T-slots: strips with gaps over a dark floor
    part.add(OXIDE, box(-156, 156, -112, 242, -208, -203, 0.5))
    edges = [-112, -58, -46, 8, 20, 110, 122, 176, 188, 242]
    for y0, y1 in zip(edges[::2], edges[1::2]):
        part.add(GROUND, box(-158, 158, y0, y1, -206, -200, 1.0))
    # carriages on the bed rails, wipers in front
    for x in (-200, 200):
        for y in (-90, 220):
            part.add(STEEL, prism(outline([(y - 30, -296), (y - 12, -296), (y - 12, -278), (y + 12, -278), (y + 12, -296),
                                           (y + 30, -296), (y + 30, -244, 4), (y - 30, -244, 4)]),
                                  "x", x - 46, x + 46, 1.5))
            part.add(RUBBER, box(x - 52, x - 45, y - 28, y - 12, -294, -250, 1), box(x - 52, x - 45, y + 12, y + 28, -294, -250, 1),
                     box(x + 45, x + 52, y - 28, y - 12, -294, -250, 1), box(x + 45, x + 52, y + 12, y + 28, -294, -250, 1))
    # telescopic way covers, three nested roofs a side
    for step in range(3):
        reach = 262 + 46 * (step + 1)
        low = -214 - 8 * step
        roof = prism(outline([(-116 + 7 * step, -276), (-110 + 7 * step, -276), (-110 + 7 * step, low - 20),
                              (240 - 7 * step, low - 20), (240 - 7 * step, -276), (246 - 7 * step, -276),
                              (246 - 7 * step, low - 14, 2), (150, low, 8), (-20, low, 8), (-116 + 7 * step, low - 14, 2)]),
                     "x", 246 + 40 * step, reach, 1.0)
        lip = prism(outline([(-118 + 7 * step, -276), (-114 + 7 * step, -276), (-114 + 7 * step, low - 20),
                             (244 - 7 * step, low - 20), (244 - 7 * step, -276), (248 - 7 * step, -276),
                             (248 - 7 * step, low - 13, 2), (150, low + 1.5, 8), (-20, low + 1.5, 8),
                             (-118 + 7 * step, low - 13, 2)]), "x", reach - 5, reach + 1, 0.8)
        part.add(ALUMINIUM, roof, mirror_x(roof))
        part.add(RUBBER, lip, mirror_x(lip))
    for side in (1, -1):
        _bearing_bracket(part, side)
    return part


def _bearing_bracket(part, side):
    def put(colour, *solids):
        part.add(colour, *[s if side > 0 else mirror_x(s) for s in solids])

    arc = [(76 * math.cos(math.radians(d)), 76 * math.sin(math.radians(d))) for d in range(-8, 189, 14)]
    shape = outline([(-96, -200), (112, -200)] + arc)
    smooth = [(p, n0, n1) if n0[0] * n1[0] + n0[1] * n1[1] < 0.85 else (p, *_blend(n0, n1)) for p, n0, n1 in shape]
    put(PAINT, prism(smooth, "x", 168, 236, 5))
    put(PAINT, prism(rectangle(160, 258, -112, 150, 10), "z", -202, -176, 3))
    for y in (-98, -40, 20, 80, 134):
        put(OXIDE, move(cap_screw(7, 7), 248, y, -176))
    # gussets
    for y in (-62, 60):
        put(PAINT, prism(outline([(230, -180), (254, -180), (237, -40), (230, -40)], 2), "y", y - 7, y + 7, 2))
    # bearing caps inside and outside
    put(PAINT_DARK, move(along_x(cylinder(66, -8, 0, 2, 48)), 168), move(along_x(cylinder(66, 0, 10, 2, 48)), 236))
    put(STEEL, *[move(along_x(s), 246) for s in screw_circle(57, 12, 0, 4, 3.5)])
    if side > 0:  # torque motor of the A axis with cooling ribs and its terminal box
        fins = [(0, 0)]
        for k in range(7):
            z = 10 + 12 * k
            fins += [(58, z, 1), (58, z + 7, 1), (52, z + 7), (52, z + 12)]
        fins += [(58, 94, 1), (58, 104, 4), (0, 104)]
        fins = [(0, 0), (50, 0), (50, 10)] + fins[1:]
        put(OXIDE, move(along_x(lathe(fins, 44)), 244))
        put(PAINT_DARK, box(262, 330, -32, 32, 44, 84, 6))
        put(BRASS, move(along_x(cylinder(7, 0, 14, 1.5, 14)), 328, 0, 66))
    else:  # encoder cover
        put(ACCENT, move(along_x(lathe([(0, 0), (44, 0), (44, 22, 6), (30, 30, 3), (0, 30)], 44)), 246))
        put(GROUND, move(along_x(cylinder(12, 0, 4, 1.5, 24)), 275))


def _blend(a, b):
    n = (a[0] + b[0], a[1] + b[1])
    length = math.hypot(*n)
    n = (n[0] / length, n[1] / length)
    return n, n


def cradle():
    part = Part()
    # arms: from the journals back to the floor
    arc = [(60 * math.cos(math.radians(d)), 60 * math.sin(math.radians(d))) for d in range(78, 266, 11)]
    corners = [(208, -8), (208, 42), (80, 42)] + arc + [(96, -42), (170, -42)]
    shape = outline([(x, y, 10 if i in (0, 1) else 0) for i, (x, y) in enumerate(corners)])
    smooth = [(p, n0, n1) if n0[0] * n1[0] + n0[1] * n1[1] < 0.85 else (p, *_blend(n0, n1)) for p, n0, n1 in shape]
    arm = prism(smooth, "x", 122, 150, 4)
    part.add(ACCENT, arm, mirror_x(arm))
    # weight pockets on the arms' outer faces
    pocket = prism(outline([(70, -26), (168, -26), (192, 0), (192, 24), (70, 24)], 9), "x", 148, 152.5, 2)
    part.add(PAINT_DARK, pocket, mirror_x(pocket))
    # floor with ribs, and the housing of the B axis below
    part.add(ACCENT, prism(rectangle(-130, 130, -20, 208, 20), "z", -8, 40, 5))
    part.add(ACCENT, box(-124, 124, 202, 211, -2, 34, 3))
    part.add(PAINT_DARK, move(lathe([(0, -52), (64, -52, 4), (72, -44, 3), (72, -4), (0, -4)], 48), 0, 96))
    part.add(STEEL, *[move(s, 0, 96) for s in downward(screw_circle(56, 8, 0, 4, 3.5), -52)])
    # journals with seal rings, cap screws of the flange
    journal = along_x(lathe([(0, 146), (56, 146), (56, 154, 1.5), (44, 154), (44, 166), (0, 166)], 48))
    part.add(STEEL, journal, mirror_x(journal))
    for s in screw_circle(50, 10, 153.5, 3, 2.5):
        part.add(OXIDE, along_x(s), mirror_x(along_x(s)))
    # inner face of the journals: cover discs
    cover = along_x(lathe([(0, 112), (34, 112, 3), (38, 118, 1), (38, 124), (0, 124)], 40))
    part.add(PAINT_DARK, cover, mirror_x(cover))
    # collar under the rotary table with the index mark of its graduation
    part.add(PAINT_DARK, move(lathe([(0, 36), (107, 36), (107, 44, 1.5), (0, 44)], 64), 0, 96))
    part.add(ORANGE, box(-2.5, 2.5, -19, -14.5, 38, 47, 0.8))
    return part


def rotary_table():
    part = Part()
    part.add(GROUND, move(lathe([(0, 44.6), (110, 44.6, 1), (110, 58, 0.8), (0, 58)], 96), 0, 96))
    # six T-slots: sectors with a wide gap below and a narrow one above
    for k in range(6):
        middle = 60.0 * k + 30.0
        for z0, z1, half_gap, bevel in ((57.5, 63, 9.0, 0.3), (62.5, 70, 5.0, 1.0)):
            part.add(GROUND, move(sector(110, 24, half_gap, middle, z0, z1, bevel), 0, 96))
    part.add(STEEL, move(lathe([(0, 57), (25, 57), (25, 69.5, 1), (16, 69.5), (16, 66), (0, 66)], 40), 0, 96))
    # graduation ring: a line each 5 degrees, longer each 15
    for k in range(72):
        long = k % 3 == 0
        line = box(109.4, 110.25, -0.45, 0.45, 47, 55.5 if long else 51.5, 0)
        part.add(OXIDE, move(turn_z(line, 5.0 * k), 0, 96))
    return part


def fixture():
    part = Part()
    cx, cy = 8.0, 96.0
    part.add(OXIDE, prism(rectangle(cx - 72, cx + 72, cy - 62, cy + 62, 12), "z", 70, 84, 1.5))
    part.add(ALUMINIUM, prism(rectangle(cx - 64, cx + 64, cy - 54, cy + 54, 5), "z", 83, 100, 1.2))
    # hold-down screws in the corners of the base step; dowels on the plate
    for x in (-1, 1):
        for y in (-1, 1):
            part.add(STEEL, move(cap_screw(3.6, 5), cx + x * 67.5, cy + y * 46, 84))
    # edge clamps: they stop 1 mm beside the stock and below work z = -12
    for x in (-30, 30):
        for sign in (-1, 1):
            _edge_clamp(part, lambda s, x=x, sign=sign: move(turn_z(s, 90 * sign), cx + x, cy + sign * 41))
    for sign in (-1, 1):
        _edge_clamp(part, lambda s, sign=sign: move(turn_z(s, 0 if sign > 0 else 180), cx + sign * 51, cy))
    return part


def _edge_clamp(part, put):
    """Jaw and wedge with its screw, seen along +x from the stock's edge at x = 0; 13 mm deep."""
    # the jaw's brass stands proud: where faces of two colours lie in one plane neither is drawn whole
    steel = outline([(0.3, 99), (13, 99), (13, 104, 1), (7, 106.5, 1), (0.3, 106.5)])
    part.add(OXIDE, put(prism(steel, "y", -11, 11, 0.7)))
    part.add(BRASS, put(prism(rectangle(0, 1.6, 100, 105.5), "y", -8, 8, 0.2)))
    part.add(STEEL, put(move(cap_screw(2.6, 2.4), 7.5, 0, 105.2)))


# ---------------------------------------------------------------- head side

def y_slide():
    part = Part()
    # the plate that carries the Z rails, with a stiffening frame behind
    part.add(PAINT, prism(rectangle(-118, 118, 108, 150, 8), "z", 240, 910, 5))
    for x in (-60, 60):
        part.add(GROUND, box(x - 20, x + 20, 103, 112, 246, 904, 1.5))
        part.add(STEEL, rail("z", 250, 900, x, 86))
        part.add(OXIDE, *screw_row("z", 250, 900, 12, x, 86))
    # ball screw, its bearings and motor
    part.add(STEEL, move(cylinder(9, 262, 905, 1, 20), 0, 92))
    part.add(PAINT_DARK, box(-26, 26, 80, 112, 246, 268, 3), box(-30, 30, 74, 112, 880, 906, 3))
    part.add(PAINT_DARK, prism(rectangle(-44, 44, 62, 150, 10), "z", 908, 934, 3))
    part.add(OXIDE, move(lathe([(0, 930), (34, 930), (34, 940, 1), (31, 942), (31, 1010), (34, 1012), (34, 1034, 5),
                                (0, 1034)], 36), 0, 100))
    part.add(ACCENT, move(lathe([(0, 1032), (26, 1032), (26, 1046, 4), (0, 1046)], 36), 0, 100))
    # ram on the column's rails
    part.add(PAINT, prism(outline([(-100, 478), (100, 478), (100, 690), (-100, 690)], 14), "y", 146, 610, 6))
    for y in range(230, 560, 66):
        for x in (-1, 1):
            part.add(PAINT, box(*sorted((x * 94, x * 107)), y - 7, y + 7, 492, 676, 3))
    for x in (-1, 1):  # gussets between plate and ram; below it flat ribs that pass the column's front
        part.add(PAINT, prism(outline([(146, 684), (330, 684), (146, 868)], 3), "x", x * 78 - 9, x * 78 + 9, 3),
                 box(x * 78 - 9, x * 78 + 9, 146, 159, 262, 484, 3))
    part.add(ACCENT, box(-109, 109, 200, 596, 572, 592, 3))
    part.add(PAINT_DARK, prism(outline([(-84, 494), (84, 494), (84, 674), (-84, 674)], 12), "y", 606, 622, 4))
    part.add(PAINT, prism(rectangle(-150, 150, 404, 548, 10), "z", 462, 484, 4))
    for x in (-120, 120):
        for y in (412, 486):
            part.add(STEEL, prism(outline([(x - 26, 422), (x - 11, 422), (x - 11, 440), (x + 11, 440), (x + 11, 422),
                                           (x + 26, 422), (x + 26, 464, 3), (x - 26, 464, 3)]), "y", y, y + 54, 1.5))
    part.add(BRASS, box(-24, 24, 450, 520, 441, 466, 3))
    return part


def spindle_head():
    part = Part()
    # head casting: rounded front, waist above the nose
    part.add(PAINT, prism(rectangle(-82, 82, -82, 66, 30, 6), "z", 226, 520, 7))
    part.add(PAINT, lathe([(0, 190), (64, 190, 3), (78, 226), (78, 240), (0, 240)], 64))
    part.add(ACCENT, prism(rectangle(-84, 84, -84, 68, 31, 6), "z", 470, 490, 2))
    # front cover with louvres
    part.add(PAINT_DARK, prism(rectangle(-48, 48, 290, 440, 12), "y", -88, -78, 3))
    for k in range(6):
        part.add(RUBBER, box(-34, 34, -91, -84, 312 + 20 * k, 321 + 20 * k, 1.5))
    # nose: cartridge, flange and face, labyrinth ring
    part.add(STEEL, lathe([(0, 110), (32, 110, 1), (34, 116), (46, 116, 1.5), (46, 128), (0, 128)], 56))
    part.add(GROUND, lathe([(0, 127), (54, 127, 2), (60, 160, 2), (60, 178), (0, 178)], 64))
    part.add(OXIDE, lathe([(0, 177), (72, 177, 2), (72, 192, 2), (0, 192)], 64))
    part.add(STEEL, *[s for s in downward(screw_circle(65.5, 12, 0, 4, 3.5, 15), 177)])
    part.add(ORANGE, lathe([(58.0, 164), (60.8, 164), (60.8, 168), (58.0, 168)], 64))
    # coolant nozzles: knuckles on the flange, pipes aimed at the tip
    for x, y in ((46, -34), (-46, -34), (50, 26)):
        path = [(x, y, 180), (x * 1.05, y * 1.05, 150), (x, y, 128), (x * 0.86, y * 0.86, 106), (x * 0.72, y * 0.72, 90)]
        part.add(OXIDE, tube([(x, y, 180), (x * 1.02, y * 1.02, 160)], 7.0, 12))
        part.add(ACCENT, tube(path, 3.6, 10))
        part.add(BRASS, tube([path[-2], path[-1], tuple(0.97 * c for c in path[-1])], 4.6, 10))
    # motor housing above with cooling ribs, cover and terminal box
    fins = [(0, 512), (66, 512)]
    for k in range(9):
        z = 526 + 13 * k
        fins += [(66, z, 1), (58, z), (58, z + 6), (66, z + 6, 1)]
    fins += [(66, 652, 2), (60, 668, 5), (0, 668)]
    part.add(OXIDE, lathe(fins, 48))
    part.add(ACCENT, lathe([(0, 666), (40, 666), (40, 684, 6), (0, 684)], 40))
    part.add(PAINT_DARK, box(-34, 34, -88, -50, 560, 632, 7))
    part.add(BRASS, move(cylinder(7, -12, 2, 1.5, 14), -16, -72, 558), move(cylinder(7, -12, 2, 1.5, 14), 16, -72, 558))
    part.add(RUBBER, tube([(-16, -72, 552), (-17, -73, 540), (-24, -70, 528), (-30, -60, 516)], 5, 10),
             tube([(16, -72, 552), (17, -73, 540), (24, -70, 528), (30, -60, 516)], 5, 10))
    # carriage plate and its runner blocks
    part.add(PAINT, prism(rectangle(-86, 86, 60, 80, 6), "z", 196, 500, 3))
    for x in (-60, 60):
        for z in (214, 420):
            part.add(STEEL, prism(outline([(x - 26, 80), (x - 26, 76), (x + 26, 76), (x + 26, 101, 2), (x + 11, 101),
                                           (x + 11, 84), (x - 11, 84), (x - 11, 101), (x - 26, 101, 2)]), "z", z, z + 62, 1.5))
            part.add(RUBBER, box(x - 24, x - 12, 79, 99, z - 5, z + 1, 1), box(x + 12, x + 24, 79, 99, z - 5, z + 1, 1))
    part.add(BRASS, box(-22, 22, 76, 106, 330, 380, 3))
    return part


def main():
    folder = os.path.dirname(os.path.abspath(__file__))
    total_triangles = total_bytes = 0
    for make in (bed, column, x_slide, cradle, rotary_table, fixture, y_slide, spindle_head):
        part = make()
        path = os.path.join(folder, make.__name__ + ".ply")
        part.write_ply(path)
        total_triangles += len(part.triangles)
        total_bytes += os.path.getsize(path)
        print(f"{make.__name__:14s} {len(part.triangles):6d} triangles")
    print(f"{'together':14s} {total_triangles:6d} triangles, {total_bytes / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
