#!/usr/bin/env python3
"""Meshes of the fork head gantry's links, all axes at zero, mm. The shapes are our own.

The table's face is at z = 0 and so is the spindle's gauge line; the A axis runs along x at z = 215, C along z through it.
The bridge rides on two side walls in X, the saddle in front of it in Y, the ram in Z. Room: the ram is 50 to 650 higher
in any pose that exists.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
from machine_kit import *  # noqa: E402,F403


def bed():
    part = Part()
    ribbed(part, (-1350, 1700), (-760, 760), (-430, -114), 240)
    plinth(part, (-1350, 1700), (-1180, 1180), -430)
    for side in (-1, 1):
        y = sorted((side * 950, side * 1170))
        ribbed(part, (-1350, 1700), y, (870, 1170), 260)
        band(part, (-1350, 1700), y, 1070, 30)
        for x in (-1350, -80, 1390):
            ribbed(part, (x, x + 310), y, (-430, 890), 150)
        for corner, way in ((-1044, 170), (-76, -170), (226, 170), (1394, -170)):  # gussets under the beam
            part.add(PAINT, prism(outline([(corner, 875), (corner + way, 875), (corner, 640)], 4), "y", y[0] + 60,
                                  y[1] - 60, 4))
        part.add(PAINT, box(-1300, 1650, *sorted((side * 740, side * 960)), -430, -300, 6))
        guide(part, "x", "z", (-1330, side * 1060, 1170), 3010, 2.0, 14)
    return part


def table():
    part = Part()
    t_slots(part, (-1150, 1150), (-700, 700), 0, 9)
    part.add(PAINT, box(-1130, 1130, -680, 680, -112, -60, 6))
    return part


def bridge():
    part = Part()
    ribbed(part, (240, 640), (-1180, 1180), (1262, 1730), 240, faces="x+ y- y+")
    for side in (-1, 1):
        runner(part, "x", "z", (-1330, side * 1060, 1170), (1630, 1910), 180, 2.0)
        part.add(PAINT, box(210, 660, *sorted((side * 960, side * 1160)), 1258, 1370, 8))
    band(part, (240, 640), (-1180, 1180), 1680, 28)
    for z in (1340, 1650):
        guide(part, "y", "-x", (240, -1160, z), 2320, 1.6, 12)
    ball_screw(part, "y", "-x", (200, -1130, 1495), 2260, 18)
    for y in (-1150, 1096):
        part.add(PAINT_DARK, box(160, 246, y, y + 54, 1450, 1540, 4))
    motor(part, "y", "z", (440, 1180, 1495), 80, 180)
    return part


def y_saddle():
    part = Part()
    part.add(PAINT, box(130, 168, -300, 300, 1230, 1770, 8))
    for z in (1340, 1650):
        runner(part, "y", "-x", (240, 0, z), (-220, 220), 150, 1.6)
    for side in (-1, 1):
        part.add(PAINT, box(-170, 140, *sorted((side * 200, side * 290)), 1250, 1750, 8))
        runner(part, "z", "y" if side > 0 else "-y", (0, side * 130, 0), (1330, 1500, 1670), 110, 1.5)
    part.add(PAINT, box(-170, -140, -240, 240, 1250, 1750, 6))
    part.add(ACCENT, box(-173, -139, -240, 240, 1700, 1724, 2))
    motor(part, "z", "x", (204, 0, 1774), 64, 150)
    part.add(PAINT_DARK, box(132, 270, -70, 70, 1738, 1776, 4))
    return part


def ram():
    part = Part()
    ribbed(part, (-110, 110), (-130, 130), (560, 1900), 400, faces="x- x+", depth=5)
    part.add(PAINT_DARK, lathe([(0, 520), (150, 520, 4), (150, 566, 4), (0, 566)], 64))
    for side in (-1, 1):
        guide(part, "z", "y" if side > 0 else "-y", (0, side * 130, 600), 1280, 1.5)
    part.add(PAINT_DARK, prism(rectangle(-90, 90, -110, 110, 16), "z", 1896, 1920, 4))
    return part


def fork():
    part = Part()
    part.add(STEEL, lathe([(0, 500), (140, 500, 3), (140, 519, 1), (0, 519)], 64))
    part.add(ACCENT, lathe([(0, 404), (168, 404, 10), (178, 430, 4), (178, 502, 6), (0, 502)], 64))
    for side in (-1, 1):
        prong = [(88 * math.cos(math.radians(d)), 215 + 88 * math.sin(math.radians(d))) for d in range(180, 361, 18)]
        part.add(ACCENT, prism(outline(prong + [(120, 420, 10), (-120, 420, 10)]), "x", *sorted((side * 112, side * 178)), 6))
        part.add(PAINT_DARK, put(disc(66, 174, 192), "z", "x" if side > 0 else "-x", (0, 0, 215)))
    return part


def spindle_mesh():
    part = Part()
    spindle(part, 330, 82)
    nozzles(part)
    part.add(PAINT_DARK, lathe([(0, 326), (70, 326), (70, 352, 6), (0, 352)], 48))
    part.add(STEEL, put(disc(58, -110, 110), "z", "x", (0, 0, 215)))
    return part


if __name__ == "__main__":
    write(HERE, (bed, table, bridge, y_saddle, ram, fork, spindle_mesh))
