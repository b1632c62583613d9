"""blender -b --factory-startup --python-exit-code 1 --python blender_plays.py -- MACHINE.glb TRAJECTORY.csv

What Blender makes of a machine.glb: at three times the tool stands over the work as in that cycle of the table (tip
and axis), within what asset.extras says of the keys; the stock is seen in one stage at a time, later ones later, the
finished part at the end; nothing is lost on the way in. Prints a line for each time and BLENDER PLAYS at the end."""
import csv
import json
import math
import struct
import sys

import bpy
import numpy
from mathutils import Vector

numpy.bool = bool  # Debian 12: the importer asks for a name that its NumPy has dropped
MM = 1000.0  # in a metre
glb_file, table_file = sys.argv[sys.argv.index("--") + 1 :]
with open(glb_file, "rb") as file:
    glb = file.read()
model = json.loads(glb[20 : 20 + struct.unpack("<I", glb[12:16])[0]])
extras = model["asset"]["extras"]

for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.ops.import_scene.gltf(filepath=glb_file)
scene = bpy.context.scene
fps = scene.render.fps / scene.render.fps_base
named = {node["name"] for node in model["nodes"]}
missing = named - {thing.name for thing in bpy.data.objects}
assert not missing, f"lost: {missing}"


def role(name):
    return [thing for thing in bpy.data.objects if thing.get("role") == name]


def is_seen(thing):
    return thing.matrix_world.to_scale().length > 1e-9


cutters = [thing for thing in role("tool") if thing.name.startswith("cutter")]
stages = sorted((thing for thing in role("stock") if thing.name != "part"), key=lambda thing: int(thing.name.split()[1]))
stages.append(bpy.data.objects["part"])
with open(table_file, encoding="ascii") as file:
    rows = list(csv.DictReader(file))
start, scale = float(extras["program_seconds_at_start"]), float(extras["program_seconds_per_second"])
seen_stages = []
for share in (0.1, 0.55, 1.0):
    row = rows[round(share * (len(rows) - 1))]
    frame = (float(row["t_s"]) - start) / scale * fps
    scene.frame_set(math.floor(frame), subframe=frame - math.floor(frame))
    tool = [thing for thing in cutters if is_seen(thing)]
    stock = [number for number, thing in enumerate(stages) if is_seen(thing)]
    assert len(tool) == 1 and len(stock) == 1, f"at {row['t_s']} s: tools {tool}, stages {stock}"
    # The work and the tool, each at the end of its own chain of axes; a root turned both into Blender's frame.
    tool_in_work = stages[stock[0]].matrix_world.inverted() @ tool[0].matrix_world
    # Below the root a node's Z has become Blender's -Y, its Y Blender's Z.
    def own(v):
        return Vector((v.x, v.z, -v.y))

    tip, axis = own(tool_in_work.to_translation()), own(tool_in_work.to_3x3() @ Vector((0, -1, 0))).normalized()
    wanted = Vector(float(row[f"tip_{name}_mm"]) for name in "xyz")
    direction = Vector(float(row[name]) for name in "ijk")
    far = sum(value for key, value in extras.items() if key.startswith("key_error_max") and key.endswith("_mm"))
    turn = math.radians(sum(value for key, value in extras.items() if key.startswith("key_error_max") and key.endswith("_deg")))
    lever = wanted.length + max(thing.matrix_world.to_translation().length * MM for thing in (tool[0], stages[stock[0]]))
    allowed = far + turn * lever + 1e-6 * lever * 4
    off, angle = (tip - wanted).length, axis.angle(direction)
    print(f"{row['t_s']} s: stage {stock[0]}, tip off by {off:.5f} mm (allowed {allowed:.5f}), axis by {math.degrees(angle):.5f} deg")
    assert off <= allowed and angle <= turn + 1e-5
    seen_stages.append(stock[0])
assert seen_stages == sorted(set(seen_stages)) and seen_stages[-1] == len(stages) - 1, seen_stages
print("BLENDER PLAYS")
