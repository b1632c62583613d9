#!/usr/bin/env python3
"""Meshes of the Maho 600C's links, all axes at zero, mm. The shapes are our own.

The table's face is at z = 0 and so is the spindle's gauge line; the B axis runs along y at z = 60. The knee carries
the table in Z: it stands 100 to 550 lower in any pose that exists. Room: the arm swings within 250 of the B axis
(slide top at z = -215) and in front of y = 190; the B housing's top is at z = 190, lowered at least to 90 under the ram
at z = 150.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
from machine_kit import *  # noqa: E402,F403


def column():
    part = Part()
    ribbed(part, (-300, 300), (440, 1080), (-1240, 110), 130, faces="x- x+ y+")
    part.add(PAINT, box(-430, 430, -420, 1140, -1330, -1230, 10))
    plinth(part, (-430, 430), (-420, 1140), -1330)
    feet(part, [(x, y) for x in (-360, 360) for y in (-340, 400, 1060)], -1364)
    for x in (-210, 210):
        guide(part, "z", "-y", (x, 440, -1200), 1290, 1.3, 12)
    ball_screw(part, "z", "-y", (0, 412, -1190), 1270, 14)
    part.add(PAINT_DARK, box(-60, 60, 380, 446, -1236, -1180, 4))
    for x in (-140, 140):
        guide(part, "y", "z", (x, 452, 110), 610, 1.2, 10)
    band(part, (-300, 300), (440, 1080), 40)
    part.add(PAINT_DARK, box(296, 322, 560, 960, -900, -420, 5))
    part.add(ACCENT, box(318, 326, 600, 920, -520, -470, 2))
    return part


def knee():
    part = Part()
    part.add(PAINT, box(-300, 300, 336, 380, -620, -250, 6))
    ribbed(part, (-290, 290), (-190, 340), (-520, -345), 120, faces="x- x+ y-")
    for x in (-1, 1):
        part.add(PAINT, prism(outline([(-120, -518), (340, -518), (340, -640)], 4), "x", *sorted((x * 200, x * 232)), 3))
    for x in (-210, 210):
        runner(part, "z", "-y", (x, 440, 0), (-560, -320), 130, 1.3)
    for y in (-130, 280):
        guide(part, "x", "z", (-286, y, -345), 572, 1.1, 10)
    motor(part, "-y", "z", (0, -190, -430), 48, 110)
    return part


def x_slide():
    part = Part()
    ribbed(part, (-420, 420), (-180, 318), (-300, -240), 110, faces="x- x+ y-")
    for y in (-130, 280):
        runner(part, "x", "z", (0, y, -345), (-200, 200), 110, 1.1)
    # housing of the B axis
    part.add(PAINT, prism(outline([(-210, -246), (210, -246)] + [(150 * math.cos(math.radians(d)), 60 + 130 *
             math.sin(math.radians(d))) for d in range(0, 181, 15)]), "y", 206, 326, 6))
    part.add(PAINT, box(-240, 240, 196, 330, -246, -216, 4))
    part.add(PAINT_DARK, put(disc(104, 0, 10), "x", "-y", (0, 208, 60)))
    for x in (-180, 180):
        part.add(OXIDE, move(cap_screw(9, 9), x, 250, -216))
    return part


def arm():
    part = Part()
    part.add(STEEL, put(disc(98, 0, 12, 1.5), "x", "y", (0, 180, 60)))
    face = [(118 * math.cos(math.radians(d)), 60 + 118 * math.sin(math.radians(d))) for d in range(-10, 191, 16)]
    part.add(ACCENT, prism(outline([(-150, -140, 20), (150, -140, 20)] + face), "y", 136, 182, 5))
    part.add(ACCENT, prism(rectangle(-150, 150, -165, 150, 30), "z", -140, -56, 5))
    part.add(PAINT_DARK, put(disc(52, 0, 10), "x", "-y", (0, 138, 60)))
    part.add(STEEL, *[put(s, "x", "-y", (0, 136, 60)) for s in screw_circle(84, 12, 0, 5, 5)])
    part.add(PAINT_DARK, lathe([(0, -190), (88, -190, 5), (100, -178, 4), (100, -136), (0, -136)], 48))
    part.add(PAINT_DARK, lathe([(0, -58), (132, -58), (132, -48, 1.5), (0, -48)], 60))
    return part


def rotary_table_mesh():
    part = Part()
    rotary_table(part, 128, 0, 47)
    return part



def ram():
    part = Part()
    spindle(part, 160, 74)
    nozzles(part, 50)
    part.add(PAINT, prism(rectangle(-125, 125, -115, 160, 40, 5), "z", 150, 420, 7))
    part.add(ACCENT, prism(rectangle(-127, 127, -117, 162, 41, 5), "z", 380, 402, 2))
    ribbed(part, (-200, 200), (150, 1000), (166, 400), 130)
    for x in (-140, 140):
        runner(part, "y", "z", (x, 452, 110), (90, 330), 110, 1.2)
    motor(part, "z", "y", (0, 10, 420), 70, 170)
    motor(part, "y", "z", (0, 1000, 280), 52, 120)
    part.add(PAINT_DARK, box(-90, 90, -124, -110, 230, 360, 4))
    return part


if __name__ == "__main__":
    write(HERE, (column, knee, x_slide, arm, rotary_table_mesh, ram))
