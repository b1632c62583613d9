#!/usr/bin/env python3
"""Meshes of the links of the mill with swivel head and rotary table, all axes at zero, mm. The shapes are our own.

The table's face is at z = 0 and so is the spindle's gauge line; the B axis runs along y at z = 190. Room: the head is
50 to 600 higher in any pose that exists; what turns with B stays in front of y = 112.
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
    ribbed(part, (-900, 900), (-340, 380), (-620, -320), 150)
    ribbed(part, (-420, 420), (370, 1120), (-620, -260), 150)
    plinth(part, (-900, 900), (-340, 380), -620)
    plinth(part, (-420, 420), (400, 1120), -620)
    feet(part, [(x, y) for x in (-820, 0, 820) for y in (-270, 310)] + [(-340, 1040), (340, 1040)], -654)
    for y in (-220, 220):
        guide(part, "x", "z", (-880, y, -320), 1760, 1.4, 12)
    ball_screw(part, "x", "z", (-860, 0, -288), 1720, 14)
    for x in (-884, 834):
        part.add(PAINT_DARK, box(x, x + 50, -56, 56, -324, -248, 3))
    return part


def column():
    part = Part()
    part.add(PAINT, prism(outline([(-380, -270), (380, -270), (300, 900), (-300, 900)], 14), "y", 580, 1080, 9))
    for side in (-1, 1):
        part.add(PAINT, prism(outline([(580, -262), (1080, -262), (1000, 860), (640, 860)], 8), "x",
                              *sorted((side * 300, side * 372)), 4))
    band(part, (-312, 312), (580, 1080), 800, 26)
    for x in (-190, 190):
        guide(part, "y", "z", (x, 590, 900), 480, 1.4, 12)
    return part


def x_slide():
    part = Part()
    ribbed(part, (-330, 330), (-290, 290), (-256, -160), 120)
    for y in (-220, 220):
        runner(part, "x", "z", (0, y, -320), (-240, 240), 130, 1.4)
    part.add(PAINT, lathe([(0, -164), (262, -164, 3), (240, -60, 6), (0, -60)], 72))
    part.add(ORANGE, box(-3, 3, -252, -239, -70, -52, 1))
    covers(part, "x", "z", (322, 0, -316), 540, 100, 3, 80)
    covers(part, "-x", "z", (-322, 0, -316), 540, 100, 3, 80)
    return part


def rotary_table_mesh():
    part = Part()
    rotary_table(part, 235, 0, 56, 8, 32)
    return part



def y_ram():
    part = Part()
    ribbed(part, (-260, 260), (214, 1080), (964, 1330), 170, faces="x- x+ y+")
    band(part, (-260, 260), (214, 1080), 1290, 22)
    for x in (-190, 190):
        runner(part, "y", "z", (x, 590, 900), (90, 390), 140, 1.4)
    part.add(PAINT, box(-240, 240, 190, 232, 640, 1420, 7))
    for x in (-170, 170):
        guide(part, "z", "-y", (x, 190, 652), 756, 1.2, 8)
    ball_screw(part, "z", "-y", (0, 162, 664), 730, 12)
    motor(part, "z", "y", (0, 250, 1420), 54, 120)
    return part


def z_slide():
    part = Part()
    part.add(PAINT, prism(outline([(-220, 20), (220, 20), (220, 780), (-220, 780)], 26), "y", 116, 135, 4))
    part.add(PAINT_DARK, put(disc(140, 0, 10), "x", "-y", (0, 117, 190)))
    for x in (-170, 170):
        runner(part, "z", "-y", (x, 190, 0), (690, 560), 100, 1.2)
    for x in (-200, 200):
        part.add(PAINT, box(x - 12, x + 12, 96, 118, 360, 770, 3))
    part.add(PAINT, prism(rectangle(-150, 150, 420, 740, 24), "y", 60, 118, 8))
    part.add(ACCENT, prism(rectangle(-120, 120, 640, 700, 8), "y", 55, 62, 2))
    return part


def swivel_head():
    part = Part()
    spindle(part, 96, 78)
    nozzles(part, 52)
    face = [(132 * math.cos(math.radians(d)), 190 + 132 * math.sin(math.radians(d))) for d in range(-50, 231, 20)]
    part.add(ACCENT, prism(outline(face), "y", 40, 98, 6))
    part.add(STEEL, put(disc(124, 96, 106), "x", "y", (0, 0, 190)))
    part.add(PAINT, prism(rectangle(-92, 92, -96, 60, 36, 5), "z", 92, 330, 7))
    part.add(ACCENT, prism(rectangle(-94, 94, -98, 62, 37, 5), "z", 292, 312, 2))
    part.add(PAINT_DARK, prism(rectangle(-52, 52, 130, 270, 14), "y", -104, -92, 3))
    part.add(OXIDE, *[put(s, "x", "-y", (0, 40, 190)) for s in screw_circle(114, 10, 0, 5, 5, 18)])
    return part


if __name__ == "__main__":
    write(HERE, (bed, column, x_slide, rotary_table_mesh, y_ram, z_slide, swivel_head))
