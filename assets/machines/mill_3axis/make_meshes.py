#!/usr/bin/env python3
"""Meshes of the three-axis mill's links, all axes at zero, mm. The shapes are our own.

The table's face is at z = 0 and so is the spindle's gauge line. Room: the head is 100 to 610 higher in any pose that
exists; the table's back edge reaches y = 425 (column front 450).
"""
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
from machine_kit import *  # noqa: E402,F403


def bed():
    part = Part()
    ribbed(part, (-400, 400), (-470, 900), (-640, -340), 130)
    plinth(part, (-400, 400), (-470, 900), -640)
    feet(part, [(x, y) for x in (-330, 330) for y in (-400, 200, 830)], -674)
    part.add(PAINT_DARK, prism(outline([(-470, -360), (-430, -360), (-430, -346), (-560, -300), (-560, -316)]), "x", -396, 396, 3))
    for x in (-240, 240):
        guide(part, "y", "z", (x, -440, -340), 860, 1.3, 12)
    ball_screw(part, "y", "z", (0, -430, -312), 840, 12)
    part.add(PAINT_DARK, box(-50, 50, -456, -420, -344, -276, 3), box(-50, 50, 380, 416, -344, -276, 3))
    part.add(ACCENT, box(-160, 160, -484, -474, -540, -470, 2))
    return part


def column():
    part = Part()
    part.add(PAINT, prism(outline([(-300, -340), (300, -340), (230, 1420), (-230, 1420)], 10), "y", 474, 880, 8))
    part.add(PAINT, box(-340, 340, 452, 900, -344, -280, 6))
    band(part, (-246, 246), (474, 880), 1250, 26)
    for x in (-150, 150):
        guide(part, "z", "-y", (x, 474, 120), 1280, 1.3, 8)
    ball_screw(part, "z", "-y", (0, 440, 140), 1250, 14)
    part.add(PAINT_DARK, box(-50, 50, 400, 478, 100, 150, 3), box(-50, 50, 400, 478, 1340, 1396, 3))
    motor(part, "z", "-y", (0, 560, 1420), 60, 140)
    return part


def saddle():
    part = Part()
    ribbed(part, (-330, 330), (-190, 190), (-282, -190), 120)
    for x in (-240, 240):
        runner(part, "y", "z", (x, 0, -340), (-120, 120), 120, 1.3)
    for y in (-130, 130):
        guide(part, "x", "z", (-326, y, -190), 652, 1.2, 10)
    covers(part, "-y", "z", (0, -186, -336), 640, 90, 2, 70)
    covers(part, "y", "z", (0, 186, -336), 640, 90, 2, 70)
    return part


def table():
    part = Part()
    t_slots(part, (-480, 480), (-215, 215), 0, 4)
    part.add(PAINT, box(-470, 470, -190, 190, -136, -66, 6))
    for y in (-130, 130):
        runner(part, "x", "z", (0, y, -190), (-240, 240), 110, 1.2)
    motor(part, "x", "z", (470, 0, -100), 32, 110)
    return part


def spindle_head():
    part = Part()
    spindle(part, 170, 78)
    nozzles(part)
    part.add(PAINT, prism(rectangle(-170, 170, -130, 412, 60, 5), "z", 160, 560, 9))
    part.add(ACCENT, prism(rectangle(-172, 172, -132, 414, 61, 5), "z", 500, 524, 2))
    part.add(PAINT_DARK, prism(rectangle(-90, 90, 230, 450, 16), "y", -138, -126, 3))
    for k in range(7):
        part.add(RUBBER, box(-66, 66, -142, -134, 256 + 26 * k, 268 + 26 * k, 1.5))
    for x in (-150, 150):
        runner(part, "z", "-y", (x, 474, 0), (230, 490), 120, 1.3)
    motor(part, "z", "y", (0, 0, 560), 84, 220)
    part.add(PAINT_DARK, box(-120, 120, 150, 380, 556, 700, 8))
    return part


if __name__ == "__main__":
    write(HERE, (bed, column, saddle, table, spindle_head))
