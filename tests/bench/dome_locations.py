#!/usr/bin/env python3
"""CL data of many locations on a dome, normal to it, for the Maho: five axes move, all pairs and the stock are in play.

dome_locations.py LOCATIONS FOLDER writes FOLDER/dome.cl, dome.stl (the raw part, 0.5 mm above it) and scene.toml; then
contacts_cost.py tells what the contacts cost of a run: contacts_cost.py build/release/cli/swarf FOLDER/..
"""
import math
import os
import sys

locations, folder = int(sys.argv[1]), sys.argv[2]
RADIUS, FOOT, RAW, STEEPEST = 40.0, 30.0, 0.5, 1.1  # mm, mm, mm, rad from the pole
os.makedirs(folder, exist_ok=True)

with open(os.path.join(folder, "dome.cl"), "w") as out:
    out.write("PARTNO/DOME\nUNITS/MM\nLOADTL/1\nMULTAX/ON\nSPINDL/8000,CLW\nRAPID\n")
    turn = 0.0
    for k in range(locations):
        polar = 0.05 + STEEPEST * k / locations
        turn += 0.5 / (RADIUS * math.sin(polar))
        normal = (math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar))
        tip = [RADIUS * n + (FOOT if i == 2 else 0.0) for i, n in enumerate(normal)]
        words = ",".join(f"{v:.9f}" for v in (*tip, *normal))
        if k == 0:
            out.write("GOTO/" + ",".join(f"{v + 30.0 * n:.9f}" for v, n in zip(tip, normal)) +
                      "," + ",".join(f"{n:.9f}" for n in normal) + "\nFEDRAT/3000,MMPM\n")
        out.write(f"GOTO/{words}\n")
    out.write("FINI\n")

AROUND, RINGS = 96, 48
points = [(0.0, 0.0, FOOT + RADIUS + RAW), (0.0, 0.0, 0.0)]
rings = [[((RADIUS + RAW) * math.sin(p) * math.cos(t), (RADIUS + RAW) * math.sin(p) * math.sin(t),
           FOOT + (RADIUS + RAW) * math.cos(p)) for t in (2 * math.pi * j / AROUND for j in range(AROUND))]
         for p in (0.5 * math.pi * i / RINGS for i in range(1, RINGS + 1))]
rings.append([(x, y, 0.0) for x, y, _ in rings[-1]])
facets = []
for j in range(AROUND):
    k = (j + 1) % AROUND
    facets.append((points[0], rings[0][j], rings[0][k]))
    facets.append((points[1], rings[-1][k], rings[-1][j]))
    for upper, lower in zip(rings, rings[1:]):
        facets += [(upper[j], lower[j], lower[k]), (upper[j], lower[k], upper[k])]
with open(os.path.join(folder, "dome.stl"), "w") as out:
    out.write("solid dome\n")
    for facet in facets:
        corners = "".join(f"vertex {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in facet)
        out.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    out.write("endsolid dome\n")

with open(os.path.join(folder, "scene.toml"), "w") as out:
    out.write('''title = "locations on a dome"
machine = "maho_600c"
cl = "dome.cl"

[setup]
work_origin_mm = [0, 0, 0]

[cutter]
number = 1
diameter_mm = 10
flute_length_mm = 30
length_mm = 60
gauge_length_mm = 120
holder = [{ diameter_mm = 20, top_diameter_mm = 40, length_mm = 20 }, { diameter_mm = 62, length_mm = 40 }]

[stock]
mesh = "dome.stl"
voxel_mm = 0.5

[[fixture]]
name = "clamp"
box_mm = [[44, -15, 0], [64, 15, 34]]
on = "part"

[interpolator]
mode = "joint"

[design]
kind = "none"

[movie]
seconds = 0
''')
