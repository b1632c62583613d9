#!/usr/bin/env python3
"""The long three-axis program of reports/perf/long_programs.txt: a wave in blocks of 1 mm.

wave.py BLOCKS FOLDER writes FOLDER/wave.ngc and FOLDER/scene.toml; then: swarf run FOLDER/scene.toml --no-render
"""
import math
import os
import sys

blocks, folder = int(sys.argv[1]), sys.argv[2]
rows = max(1, blocks // 100)
os.makedirs(folder, exist_ok=True)


def height(x, y):
    return -1.0 + 0.5 * math.sin(x / 10) * math.cos(y / 15)


with open(os.path.join(folder, "wave.ngc"), "w") as out:
    out.write("G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\nS8000 M3\nG0 X0 Y0\nG0 Z10\n")
    out.write("G1 Z%.4f F500\nG1 F2000\n" % height(0, 0))
    for row in range(rows):
        y = row * 51.0 / rows
        for x in range(101) if row % 2 == 0 else range(100, -1, -1):
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
box_mm = [[-6, -6, -11], [106, 56, 1]]
voxel_mm = 0.2

[design]
kind = "none"

[movie]
seconds = 0
''')
