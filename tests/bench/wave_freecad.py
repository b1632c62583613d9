#!/usr/bin/env python3
"""The wave of wave.py in FreeCAD's PathSimulator (a height map, one thread), beside Swarf's of the same blocks.

wave.py BLOCKS FOLDER VOXEL_MM, then: wave_freecad.py FOLDER VOXEL_MM [BENCH_STOCK]. Needs FreeCAD's Python module; ends
with 77 where it is not installed. Reading the program and making the commands is not timed, cutting alone is: FreeCAD's
in processor time. With BENCH_STOCK (build/release/tests/bench_stock) both cut in turn, three times each, and the ratio is
that of the medians: Swarf's two threads by the clock, and one thread of it in processor time.
"""
import json
import os
import re
import statistics
import subprocess
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
bench = sys.argv[3] if len(sys.argv) > 3 else None
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


def freecad_rate():
    """Blocks/s of processor time; says what was cut."""
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
    return feed_blocks / seconds


def swarf_rates():
    """Blocks/s of one thread by processor time and of two threads by the clock."""
    rates = []
    for threads, clock in ((1, "cpu_time"), (2, "real_time")):
        name = f"cut_wave_rows/voxel_um:{1000 * voxel:.0f}/threads:{threads}/process_time/real_time"
        run = subprocess.run([bench, f"--benchmark_filter=^{name}$", "--benchmark_format=json"], capture_output=True, text=True, check=True,
                             env={key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"})
        results = json.loads(run.stdout)["benchmarks"]
        if not results:
            sys.exit(f"wave_freecad: {bench} has no case {name}")
        case = results[0]
        rates.append(case["blocks_per_s"] * case["real_time"] / case[clock])
    print(f"Swarf: one thread {rates[0]:.0f} blocks/s of processor time, two threads {rates[1]:.0f} by the clock")
    return rates


if bench is None:
    freecad_rate()
else:
    turns = [(freecad_rate(), *swarf_rates()) for _ in range(3)]
    theirs, one, two = map(statistics.median, zip(*turns))
    print(f"medians: FreeCAD {theirs:.0f}; Swarf one thread {one:.0f} ({one / theirs:.2f} x), two threads {two:.0f} ({two / theirs:.2f} x)")
