#!/usr/bin/env python3
"""The wave of wave.py in FreeCAD's PathSimulator (a height map, one thread): blocks/s of processor time.

wave.py BLOCKS FOLDER VOXEL_MM, then: wave_freecad.py FOLDER VOXEL_MM. Needs FreeCAD's Python module; ends with 77 where
it is not installed. Reading the program and making the commands is not timed, cutting alone is.
"""
import os
import re
import sys
import time

try:
    import FreeCAD
    import Part
    import Path
    import PathSimulator
except ImportError as error:
    print(f"wave_freecad: FreeCAD is not installed here ({error}): not measured", file=sys.stderr)
    sys.exit(77)

folder, voxel = sys.argv[1], float(sys.argv[2])
scene = open(os.path.join(folder, "scene.toml")).read()
low, high = re.search(r"box_mm = \[\[(.*?)\], \[(.*?)\]\]", scene).groups()
low, high = [[float(a) for a in corner.split(",")] for corner in (low, high)]
diameter = float(re.search(r"diameter_mm = (\S+)", scene).group(1))

commands, place = [], {"X": 0.0, "Y": 0.0, "Z": 20.0}
feed_blocks = 0
for line in open(os.path.join(folder, "wave.ngc")):
    words = dict((letter, float(value)) for letter, value in re.findall(r"([XYZ])(-?[\d.]+)", line))
    if not words:
        continue
    place.update(words)
    rapid = line.startswith("G0")
    feed_blocks += not rapid
    commands.append(Path.Command("G0" if rapid else "G1", dict(place)))

stock = Part.makeBox(*[b - a for a, b in zip(low, high)], FreeCAD.Vector(*low))
simulator = PathSimulator.PathSim()
simulator.BeginSimulation(stock, voxel)
simulator.SetToolShape(Part.makeCylinder(diameter / 2, 25), 0.05 * voxel)
at = FreeCAD.Placement(FreeCAD.Vector(0, 0, 20), FreeCAD.Rotation())
start = time.process_time()
for command in commands:
    at = simulator.ApplyCommand(at, command)
seconds = time.process_time() - start
_, inner = simulator.GetResultMesh()  # the sides of the box, and what was cut
print(f"FreeCAD {'.'.join(FreeCAD.Version()[:3])}: {feed_blocks} blocks at {voxel:g} mm in {seconds:.3f} s of processor time, "
      f"{feed_blocks / seconds:.0f} blocks/s; {inner.CountFacets} facets cut, z {inner.BoundBox.ZMin:.3f} to {inner.BoundBox.ZMax:.3f}")
