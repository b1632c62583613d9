#!/usr/bin/env python3
"""The long three-axis program of reports/perf/long_programs.txt: a wave in blocks of 1 mm.

wave.py BLOCKS FOLDER [VOXEL_MM] writes FOLDER/wave.ngc and FOLDER/scene.toml; then: swarf run FOLDER/scene.toml --no-render
wave.py BLOCKS FOLDER VOXEL_MM WIDTH_MM DEPTH_MM HEIGHT_MM: over a box of this size instead of 112 x 62 x 12.
"""
import math
import os
import sys

blocks, folder = int(sys.argv[1]), sys.argv[2]
voxel = float(sys.argv[3]) if len(sys.argv) > 3 else 0.2
width, depth, height_of_box = [int(a) for a in sys.argv[4:7]] if len(sys.argv) > 4 else (112, 62, 12)
across, along = width - 12, depth - 11  # mm between the first and the last tip
rows = max(1, blocks // across)
os.makedirs(folder, exist_ok=True)


def height(x, y):
    return -1.0 + 0.5 * math.sin(x / 10) * math.cos(y / 15)


with open(os.path.join(folder, "wave.ngc"), "w") as out:
    out.write("G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\nS8000 M3\nG0 X0 Y0\nG0 Z10\n")
    out.write("G1 Z%.4f F500\nG1 F2000\n" % height(0, 0))
    for row in range(rows):
        y = row * along / rows
        for x in range(across + 1) if row % 2 == 0 else range(across, -1, -1):
            if row > 0 or x > 0:
                out.write("X%.4f Y%.4f Z%.4f\n" % (x, y, height(x, y)))
    out.write("G0 Z20\nM30\n")

machine = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../assets/machines/mill_3axis/machine.toml")
with open(os.path.join(folder, "scene.toml"), "w") as out:
    out.write(f'''title = "wave"
machine = "{os.path.relpath(machine, folder)}"
nc = "wave.ngc"
dialect = "linuxcnc"

[cutter]
number = 1
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
gauge_length_mm = 100

[setup]
work_origin_mm = [0, 0, 150]
start = {{ X_mm = 0, Y_mm = 0, Z_mm = 610 }}

[stock]
box_mm = [[-6, -6, {1 - height_of_box}], [{width - 6}, {depth - 6}, 1]]
voxel_mm = {voxel:g}

[design]
kind = "none"

[movie]
seconds = 0
''')
