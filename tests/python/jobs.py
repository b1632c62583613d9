"""A small job with a known answer: a pocket of 20 x 10 x 2 by a flat end D 6 in four rows."""
import math
import pathlib

POCKET = """G21 G17 G90 G94 G54
T1 M6
S9000 M3
G0 X3 Y3
Z5
G1 Z-2 F300
X17 F900
Y7
X3
Y3
G0 Z20
M5
M2
"""

#: Its corners keep the tool's radius of 3 mm.
POCKET_MM3 = 2 * (20 * 10 - (4 - math.pi) * 3**2)


def write_pocket(folder, program=POCKET):
    """Writes pocket.ngc; returns its path."""
    path = pathlib.Path(folder, "pocket.ngc")
    path.write_text(program)
    return path


def pocket_scene(program):
    """The scene: its design is the floor, away from the walls."""
    return {
        "title": "pocket",
        "nc": str(program),
        "dialect": "linuxcnc",
        "machine": "mill_3axis",
        "tools": "T1=6",
        "setup": {"work_origin_mm": "on_table", "without_length": "tip"},
        "stock": {"box_mm": [[-5, -5, -10], [25, 15, 0]], "voxel_mm": 0.25},
        "design": {"kind": "plane", "origin_mm": [2, 2, -2], "along_u_mm": [16, 0, 0], "along_v_mm": [0, 6, 0]},
        "accept": {"gouge_max_um": 1},
    }
