#!/usr/bin/env python3
"""Meshes of the nutating head portal's links, all axes at zero, mm. The shapes are our own.

The table's face is at z = 0 and so is the spindle's gauge line; C runs along z, B along (0, 1, 1)/sqrt 2 through
(0, 0, 250). Room: the head is 50 to 500 higher in any pose that exists; what turns with B stays on this side of the
plane 128 up the B axis from that point, the swivel beyond it.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
from machine_kit import *  # noqa: E402,F403


H = math.sqrt(0.5)
B_AXIS = (0.0, H, H)
PIVOT = (0.0, 0.0, 250.0)


def on_b(solid):
    """A solid drawn about z, put about the B axis with z counted from the crossing with C."""
    return put(solid, "x", B_AXIS, PIVOT)


def bed():
    part = Part()
    ribbed(part, (-1500, 1500), (-420, 420), (-640, -290), 220)
    plinth(part, (-1500, 1500), (-420, 420), -640)
    for y in (-280, 280):
        guide(part, "x", "z", (-1480, y, -290), 2960, 1.6, 14)
    ball_screw(part, "x", "z", (-1460, 0, -250), 2920, 16)
    for x in (-1490, 1430):
        part.add(PAINT_DARK, box(x, x + 60, -60, 60, -294, -200, 3))
    return part


def table():
    part = Part()
    t_slots(part, (-700, 700), (-480, 480), 0, 7)
    ribbed(part, (-690, 690), (-470, 470), (-216, -66), 180)
    for y in (-280, 280):
        runner(part, "x", "z", (0, y, -290), (-560, -200, 200, 560), 150, 1.6)
    return part


def portal():
    part = Part()
    for side in (-1, 1):
        y = sorted((side * 640, side * 960))
        ribbed(part, (180, 720), y, (-640, 1190), 180, faces="x- x+ y- y+")
        plinth(part, (180, 720), y, -640)
        band(part, (180, 720), y, 1070, 28)
    ribbed(part, (240, 660), (-960, 960), (1170, 1610), 220, faces="x+ y- y+")
    for z in (1240, 1540):
        guide(part, "y", "-x", (240, -940, z), 1880, 1.6, 12)
    ball_screw(part, "y", "-x", (202, -920, 1390), 1840, 16)
    for y in (-930, 880):
        part.add(PAINT_DARK, box(164, 246, y, y + 50, 1348, 1432, 4))
    motor(part, "y", "z", (450, 960, 1390), 76, 170)
    return part


def y_saddle():
    part = Part()
    part.add(PAINT, box(130, 168, -270, 270, 1140, 1660, 8))
    for z in (1240, 1540):
        runner(part, "y", "-x", (240, 0, z), (-190, 190), 140, 1.6)
    for side in (-1, 1):
        part.add(PAINT, box(-170, 140, *sorted((side * 200, side * 270)), 1150, 1650, 8))
        runner(part, "z", "y" if side > 0 else "-y", (0, side * 130, 0), (1240, 1400, 1560), 110, 1.5)
    part.add(PAINT, box(-170, -140, -240, 240, 1150, 1650, 6))
    part.add(ACCENT, box(-173, -139, -240, 240, 1600, 1624, 2))
    motor(part, "z", "x", (204, 0, 1664), 62, 140)
    part.add(PAINT_DARK, box(132, 268, -70, 70, 1628, 1666, 4))
    return part


def ram():
    part = Part()
    ribbed(part, (-110, 110), (-130, 130), (620, 1760), 400, faces="x- x+", depth=5)
    part.add(PAINT_DARK, lathe([(0, 566), (170, 566, 4), (170, 626, 4), (0, 626)], 64))
    for side in (-1, 1):
        guide(part, "z", "y" if side > 0 else "-y", (0, side * 130, 650), 1100, 1.5)
    part.add(PAINT_DARK, prism(rectangle(-90, 90, -110, 110, 16), "z", 1756, 1780, 4))
    return part


def swivel():
    part = Part()
    part.add(STEEL, lathe([(0, 548), (160, 548, 3), (160, 565, 1), (0, 565)], 64))
    part.add(ACCENT, lathe([(0, 492), (176, 492, 8), (184, 520, 4), (184, 550, 5), (0, 550)], 64))

    def at(s, t):  # s along the B axis, t across it, both from the crossing; in the plane x = 0
        return (H * (s - t), 250 + H * (s + t))

    side = [at(150, -118), at(150, 118), (-112, 500), (150, 500, 30), (232, 430, 40)]
    part.add(ACCENT, prism(outline(side, 10), "x", -112, 112, 8))
    part.add(PAINT_DARK, on_b(disc(126, 134, 160, 3)))
    part.add(PAINT_DARK, prism(rectangle(-60, 60, 380, 470, 12), "y", 214, 226, 3))
    return part


def nutator():
    part = Part()
    spindle(part, 286, 76)
    nozzles(part, 50)
    part.add(PAINT_DARK, lathe([(0, 282), (58, 282), (58, 298, 5), (0, 298)], 48))
    part.add(ACCENT, on_b(disc(118, 20, 118, 6)))
    part.add(STEEL, on_b(lathe([(0, 116), (108, 116), (108, 131, 1), (0, 131)], 64)))
    part.add(OXIDE, *[on_b(s) for s in screw_circle(112, 16, 117, 3.5, 4)])
    return part


if __name__ == "__main__":
    write(HERE, (bed, table, portal, y_saddle, ram, swivel, nutator))
