#!/usr/bin/env python3
"""Runs each *.ngc of a folder through LinuxCNC's own interpreter and writes the moves beside it, as *.moves.

    record.py RS274 FOLDER [axes]     RS274: the program rs274 of LinuxCNC (Debian: package linuxcnc-uspace)

A line of a .moves file, in machine coordinates of the gauge line, mm; feed in mm/min:
    R x y z rpm                         rapid
    L x y z rpm feed exact              straight feed; exact: 1 in exact path mode, 0 in continuous mode
    A x y z rpm feed exact cx cy cz     arc or helix; what its centre has along the plane's normal means nothing
    E text                              the control refuses the block after these moves
Moves that go nowhere are left out. rs274 prints four decimals. With "axes" R and L are followed by x y z a b c and, of
a feed, the seconds that it takes: along x y z, by the degrees where they stand still.
"""
import math
import pathlib
import re
import subprocess
import sys
import tempfile

# As in linuxcnc_agreement_test.cpp. rs274 reads its table in inches.
TOOLS = {1: (50.8, 6.35), 2: (25.4, 12.7), 3: (12.7, 2.54)}
CALL = re.compile(r"^\s*\d+\s+N\S*\s+([A-Z0-9_]+)\((.*)\)\s*$")
NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")
NOWHERE = 2e-4


class Axes:
    """The same with rotary axes, straight moves alone."""

    def __init__(self, canon):
        self.canon, self.at, self.turn = canon, [0.0] * 3, [0.0] * 3

    def call(self, name, text):
        if name not in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            return self.canon.call(name, text)
        numbers = [float(value) for value in NUMBER.findall(text)]
        to, turn = self.canon.machine(numbers[:3]), numbers[3:6]
        way, turned = math.dist(to, self.at), math.dist(turn, self.turn)
        self.at, self.turn = to, turn
        if max(way, turned) < NOWHERE:
            return None
        feed = name == "STRAIGHT_FEED"
        seconds = f" {60.0 * (way if way >= NOWHERE else turned) / self.canon.feed:.6f}" if feed else ""
        self.canon.lines.append(("L" if feed else "R") + "".join(f" {value:.4f}" for value in to + turn) + seconds)
        return None


class Canon:
    """The offsets between program and machine, and what else holds."""

    def __init__(self):
        self.offset, self.shift, self.tool, self.turn = [0.0] * 3, [0.0] * 3, [0.0] * 3, 0.0
        self.plane, self.feed, self.exact, self.rpm, self.sense, self.unit = "XY", 0.0, 0, 0.0, 0, 1.0
        self.at = [0.0] * 3
        self.lines = []

    def machine(self, p):
        x, y, z = (self.unit * a + b for a, b in zip(p, self.shift))
        c, s = math.cos(math.radians(self.turn)), math.sin(math.radians(self.turn))
        return [a + b + d for a, b, d in zip((c * x - s * y, s * x + c * y, z), self.offset, self.tool)]

    def lengths(self, numbers):
        return [self.unit * value for value in numbers[:3]]

    def call(self, name, text):
        numbers = [float(value) for value in NUMBER.findall(text)]
        if name == "USE_LENGTH_UNITS":
            self.unit = 25.4 if "INCH" in text else 1.0
        elif name == "SET_G5X_OFFSET":
            self.offset = self.lengths(numbers[1:])
        elif name == "SET_G92_OFFSET":
            self.shift = self.lengths(numbers)
        elif name == "USE_TOOL_LENGTH_OFFSET":
            self.tool = self.lengths(numbers)
        elif name == "SET_XY_ROTATION":
            self.turn = numbers[0]
        elif name == "SELECT_PLANE":
            self.plane = text[-2:]
        elif name == "SET_FEED_RATE":
            self.feed = self.unit * numbers[0]
        elif name == "SET_MOTION_CONTROL_MODE":
            self.exact = int("EXACT" in text)
        elif name == "SET_SPINDLE_SPEED":
            self.rpm = numbers[1]
        elif name in ("START_SPINDLE_CLOCKWISE", "START_SPINDLE_COUNTERCLOCKWISE", "STOP_SPINDLE_TURNING"):
            self.sense = {"START_SPINDLE_CLOCKWISE": 1, "STOP_SPINDLE_TURNING": 0}.get(name, -1)
        elif name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            self.move("R" if name == "STRAIGHT_TRAVERSE" else "L", numbers[:3], "")
        elif name == "ARC_FEED":
            a, b, ca, cb, _, height = numbers[:6]
            place = {"XY": lambda u, v: (u, v, height), "YZ": lambda u, v: (height, u, v),
                     "XZ": lambda u, v: (v, height, u)}[self.plane]
            centre = self.machine(place(ca, cb))
            self.move("A", place(a, b), "".join(f" {value:.4f}" for value in centre))

    def move(self, kind, to, more):
        to = self.machine(to)
        if kind != "A" and math.dist(to, self.at) < NOWHERE:
            return
        self.at = to
        how = f" {self.feed:.4f} {self.exact}" if kind != "R" else ""
        self.lines.append(kind + "".join(f" {value:.4f}" for value in to) + f" {self.rpm * self.sense:.4f}{how}{more}")


def record(rs274, program, table, axes=False):
    done = subprocess.run([rs274, "-g", "-t", table, program], capture_output=True, text=True, errors="replace",
                          timeout=60)
    canon = Canon()
    reader = Axes(canon) if axes else canon
    for line in done.stdout.splitlines():
        call = CALL.match(line)
        if call and call[1] not in ("COMMENT", "MESSAGE"):
            reader.call(*call.groups())
    refused = [line for line in done.stderr.splitlines() if line and line != "executing"]
    return canon.lines + ([f"E {refused[0]}"] if refused else [])


def main():
    rs274, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.NamedTemporaryFile("w", suffix=".tbl") as table:
        for number, (length, diameter) in TOOLS.items():
            table.write(f"T{number} P{number} Z{length / 25.4:.6f} D{diameter / 25.4:.6f} ;\n")
        table.flush()
        for program in sorted(folder.glob("*.ngc")):
            program.with_suffix(".moves").write_text("\n".join(record(rs274, program, table.name, "axes" in sys.argv[3:])) + "\n")


if __name__ == "__main__":
    main()
