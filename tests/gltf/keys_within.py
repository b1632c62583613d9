#!/usr/bin/env python3
"""keys_within.py MACHINE.glb TRAJECTORY.h5: plays the axes of a machine.glb as a viewer does, in straight
lines between the keys of each node, and compares them with every cycle of the table. Fails where one is farther away
than asset.extras says for its axis. Needs h5py; a node that an axis moves is named after it at its end."""
import json
import struct
import sys

import h5py
import numpy

glb, table = open(sys.argv[1], "rb").read(), h5py.File(sys.argv[2], "r")
length = struct.unpack("<I", glb[12:16])[0]
model, data = json.loads(glb[20 : 20 + length]), glb[28 + length :]
extras = model["asset"]["extras"]


def floats(index):
    accessor = model["accessors"][index]
    view = model["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return numpy.frombuffer(data, numpy.float32, accessor["count"] * width, start).reshape(-1, width).astype(float)


def angle(quaternions):
    """About the one axis that all of them turn about, deg, without jumps."""
    farthest = quaternions[numpy.argmax(numpy.linalg.norm(quaternions[:, :3], axis=1)), :3]
    along = quaternions[:, :3] @ farthest / numpy.linalg.norm(farthest)
    return numpy.degrees(numpy.unwrap(2 * numpy.arctan2(along, quaternions[:, 3])))


times = (table["t_s"][:] - table["t_s"][0]) / float(extras["program_seconds_per_second"])
moving = set()
for channel in model["animations"][0]["channels"]:
    sampler, path = model["animations"][0]["samplers"][channel["sampler"]], channel["target"]["path"]
    if path == "scale":
        continue
    axis = model["nodes"][channel["target"]["node"]]["name"].split()[-1]
    unit = "deg" if path == "rotation" else "mm"
    keys, values = floats(sampler["input"])[:, 0], floats(sampler["output"])
    values = angle(values) if unit == "deg" else values[:, numpy.argmax(numpy.ptp(values, axis=0))]
    played, cycles = numpy.interp(times, keys, values), table[f"axis_{axis}_{unit}"][:]
    # A table's axis moves its link the other way; an angle counts from anywhere.
    error = min(
        numpy.abs(sign * (played - played[0]) - (cycles - cycles[0])).max() for sign in (1, -1)
    )
    stated = float(extras[f"key_error_max_{axis}_{unit}"])
    print(f"{axis}: {len(keys)} keys for {len(times)} cycles, within {error:.6f} {unit}, stated {stated} {unit}")
    # Both are counted from the first key, whose value is a float.
    assert error <= stated + 1.2e-7 * abs(cycles[0]), axis
    moving.add(axis)
expected = {name.split("_")[1] for name in table if name.startswith("axis_") and numpy.ptp(table[name][:]) > 1e-6}
assert moving == expected, (moving, expected)
