#!/usr/bin/env python3
"""Writes the jobs of this folder: part.step, part.stl, the program, scene.toml and fault.json of each.

Needs FreeCAD's Python (Debian: freecad-python3, 0.20) for the solids. `make_parts.py NAME ..` writes those jobs alone,
`--programs` leaves the parts as they are."""
import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from generator import axes, features, plates  # noqa: E402, F401
from generator.job import JOBS  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", choices=[[], *JOBS])
    parser.add_argument("--programs", action="store_true", help="programs and scenes only")
    words = parser.parse_args()
    for name in words.names or JOBS:
        JOBS[name].write(HERE / name, not words.programs)


if __name__ == "__main__":
    main()
