#!/usr/bin/env python3
"""Meshes of the Spinner U5-620's links, all axes at zero, mm. The shapes are our own.

The table's face is at z = 0 and so is the spindle's gauge line; the B axis runs along y at z = 45. The bridge rides on
two side walls in Y, the carriage in front of it in X, the ram in Z. Room: the ram is 150 to 610 higher in any pose that
exists; its sides stay within |x| <= 455 of the walls at 480; the cradle swings within 330 of the B axis.
"""
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
from machine_kit import *  # noqa: E402,F403


PIVOT = (0.0, 45.0)


def bed():
    part = Part()
    ribbed(part, (-640, 640), (-560, 720), (-620, -380), 140)
    plinth(part, (-640, 640), (-560, 720), -620)
    feet(part, [(x, y) for x in (-560, 560) for y in (-480, 80, 640)], -654)
    for side in (-1, 1):
        x = sorted((side * 480, side * 640))
        part.add(PAINT, prism(outline([(-430, -390), (720, -390), (720, 690), (-240, 690, 40), (-430, 300, 60)]), "x", *x, 8))
        part.add(ACCENT, box(x[0] - 2, x[1] + 2, -250, 722, 600, 624, 2))
        for y in (-300, -40, 220, 480):
            part.add(PAINT_DARK, prism(rectangle(y, y + 200, -300, 220, 30), "x", *sorted((side * 636, side * 645)), 3))
        guide(part, "y", "z", (side * 560, -236, 690), 950, 1.3, 10)
    # the cradle's bearings stand in front and behind
    trunnion_bracket(Placed(part, lambda solid: turn_z(solid, 90)), 300, PIVOT, -382)
    part.add(PAINT_DARK, box(-280, 280, -300, 300, -386, -366, 4))
    return part


def cradle():
    part = Part()
    trunnion_cradle(Placed(part, lambda solid: turn_z(solid, 90)), 300, PIVOT, -60, 74, 0, 200)
    part.add(PAINT_DARK, lathe([(0, -200), (118, -200, 6), (138, -180, 4), (138, -130), (0, -130)], 56))
    part.add(PAINT_DARK, lathe([(0, -62), (190, -62), (190, -51, 1.5), (0, -51)], 64))
    return part


def rotary_table_mesh():
    part = Part()
    rotary_table(part, 190, 0, 50, 8)
    return part



def bridge():
    part = Part()
    ribbed(part, (-640, 640), (150, 400), (752, 1060), 140, faces="x- x+ y+")
    for side in (-1, 1):
        runner(part, "y", "z", (side * 560, -236, 690), (430, 590), 110, 1.3)
        part.add(PAINT, box(*sorted((side * 500, side * 620)), 164, 430, 749, 800, 5))
    for z in (800, 1010):
        guide(part, "x", "-y", (-620, 150, z), 1240, 1.2, 10)
    ball_screw(part, "x", "-y", (-600, 122, 905), 1200)
    part.add(PAINT_DARK, box(-632, -590, 100, 154, 875, 940, 3), box(590, 632, 100, 154, 875, 940, 3))
    band(part, (-640, 640), (150, 400), 1030, 16)
    return part


def x_carriage():
    part = Part()
    part.add(PAINT, box(-150, 150, 64, 104, 730, 1090, 6))
    for z in (800, 1010):
        runner(part, "x", "-y", (0, 150, z), (-95, 95), 90, 1.2)
    for x in (-88, 88):
        runner(part, "z", "y", (x, 28, 0), (790, 1010), 100, 0.78)
    part.add(BRASS, box(-30, 30, 40, 70, 860, 940, 3))
    motor(part, "y", "z", (0, 430, 1120), 46, 100)
    part.add(PAINT_DARK, box(-60, 60, 70, 432, 1086, 1160, 6))
    return part


def ram():
    part = Part()
    spindle(part, 240, 60)
    nozzles(part, 44)
    part.add(PAINT, prism(rectangle(-118, 118, -100, 28, 26, 5), "z", 230, 1190, 7))
    band(part, (-118, 118), (-100, 28), 330)
    for x in (-88, 88):
        guide(part, "z", "y", (x, 28, 262), 900, 0.78, 0)
    part.add(PAINT_DARK, prism(rectangle(-66, 66, 420, 900, 16), "y", -108, -96, 3))
    motor(part, "z", "-y", (0, -36, 1190), 62, 140)
    return part


if __name__ == "__main__":
    write(HERE, (bed, cradle, rotary_table_mesh, bridge, x_carriage, ram))
