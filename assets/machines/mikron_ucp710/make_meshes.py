#!/usr/bin/env python3
"""Meshes of the MIKRON UCP 710's links, all axes at zero, mm. The shapes are our own.

The table's face is at z = 0 under the tool tip, the A axis along x through (y, z) = (-49.93, 120). The spindle's nose is
drawn 150 above the tip. Room: the cradle's floor swings within 370 of the A axis (slide top at z = -300), the table and
a part up to 200 high within 345 (saddle bottom at z = 560). At home the slide stands at y - 200 and the head 450 higher.
"""
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
from machine_kit import *  # noqa: E402,F403


PIVOT = (-49.93, 120.0)


def bed():
    part = Part()
    ribbed(part, (-520, 520), (-720, 640), (-640, -400), 130)
    plinth(part, (-520, 520), (-720, 640), -640)
    feet(part, [(x, y) for x in (-440, 440) for y in (-640, 0, 560)], -674)
    for x in (-300, 300):
        guide(part, "y", "z", (x, -700, -400), 1300, 1.2, 12)
    ball_screw(part, "y", "z", (0, -690, -378), 1280)
    part.add(PAINT_DARK, box(-46, 46, -716, -680, -404, -352, 3), box(-46, 46, 596, 632, -404, -352, 3))
    part.add(ACCENT, box(-150, 150, -733, -722, -560, -480, 2))
    return part


def column():
    part = Part()
    for side in (-1, 1):
        x = sorted((side * 545, side * 745))
        ribbed(part, x, (180, 560), (-640, 900), 130, faces="x- x+ y+")
        plinth(part, x, (180, 560), -640)
        band(part, x, (180, 560), 560)
    ribbed(part, (-745, 745), (180, 480), (660, 1010), 150, faces="x- x+ y+")
    for z in (720, 950):
        guide(part, "x", "-y", (-730, 180, z), 1460, 1.2, 10)
    ball_screw(part, "x", "-y", (-700, 150, 835), 1400)
    part.add(PAINT_DARK, box(-720, -680, 130, 184, 800, 870, 3), box(680, 720, 130, 184, 800, 870, 3))
    motor(part, "x", "z", (745, 330, 835), 52, 120)
    return part


def y_slide():
    part = Part()
    ribbed(part, (-470, 470), (-330, 230), (-354, -300), 110)
    for x in (-300, 300):
        runner(part, "y", "z", (x, 0, -400), (-250, 150), 110, 1.2)
    covers(part, "-y", "z", (0, -322, -396), 880, 84, 3, 58)
    covers(part, "y", "z", (0, 222, -396), 880, 84, 3, 58)
    trunnion_bracket(part, 330, PIVOT, -302)
    return part


def cradle():
    part = Part()
    trunnion_cradle(part, 330, PIVOT, -50, 70, 0, 205)
    part.add(PAINT_DARK, lathe([(0, -178), (120, -178, 6), (140, -158, 4), (140, -118), (0, -118)], 56))
    part.add(PAINT_DARK, lathe([(0, -52), (196, -52), (196, -47, 1.5), (0, -47)], 64))
    part.add(ORANGE, box(-3, 3, -207, -199, -52, -42, 1))
    return part


def rotary_table_mesh():
    part = Part()
    rotary_table(part, 195, 0)
    return part



def x_saddle():
    part = Part()
    part.add(PAINT, box(-190, 190, 64, 134, 600, 1240, 8))
    band(part, (-190, 190), (64, 134), 1160)
    for z in (720, 950):
        runner(part, "x", "-y", (0, 180, z), (-130, 130), 100, 1.2)
    for x in (-120, 120):
        guide(part, "z", "-y", (x, 64, 612), 616, 1.0, 8)
    motor(part, "z", "-y", (0, 100, 1240), 46, 110)
    return part


def spindle_head():
    part = Part()
    upper = prism(rectangle(-120, 120, -120, 10, 34, 5), "z", 250, 800, 6)
    part.add(PAINT, upper, box(-160, 160, -6, 18, 470, 820, 5))
    band(part, (-120, 120), (-120, 10), 720)
    nose = Placed(part, lambda solid: move(solid, 0, 0, 150))
    spindle(nose, 120, 60)
    nozzles(nose, 44)
    for x in (-120, 120):
        runner(part, "z", "-y", (x, 64, 0), (540, 760), 90)
    part.add(PAINT_DARK, prism(rectangle(-70, 70, 330, 640, 14), "y", -128, -116, 3))
    for k in range(7):
        part.add(RUBBER, box(-52, 52, -132, -124, 360 + 26 * k, 372 + 26 * k, 1.5))
    motor(part, "z", "-y", (0, -52, 800), 62, 150)
    return part


if __name__ == "__main__":
    write(HERE, (bed, column, y_slide, cradle, rotary_table_mesh, x_saddle, spindle_head))
