#!/usr/bin/env python3
"""Writes README.md and each machine's chain.svg from the machine.toml files, so that neither can drift.

    reference_page.py            write them
    reference_page.py --check    say which of them is not what the machine.toml files give, and fail

Python 3.11 (tomllib), standard library only.
"""

import math
import os
import sys
import tomllib

HERE = os.path.dirname(os.path.abspath(__file__))
WIDTH, ROW, TOP = 1000, 150, 66
INK, SOFT, LINEAR, ROTARY, FRAME = "#20262c", "#7b858e", "#185c8a", "#c2571a", ("#c0392b", "#2e8b57", "#2c5fb3")


# ---------------------------------------------------------------- the machine

class Machine:
    def __init__(self, folder):
        self.folder = folder
        path = os.path.join(HERE, folder, "machine.toml")
        with open(path, "rb") as file:
            self.toml = tomllib.load(file)
        with open(path, encoding="utf-8") as file:
            lines = file.read().split("\n")
        comment = []
        for line in lines:
            if not line.startswith("#"):
                break
            comment.append(line[1:].strip())
        self.comment = " ".join(comment)
        self.axes = {axis["name"]: axis for axis in self.toml["axis"]}
        self.links = {link["name"]: link for link in self.toml["link"]}
        self.table = self.chain("work")
        self.head = self.chain("tool")

    def chain(self, mount):
        """Links from the floor to the mount."""
        link = next(link for link in self.toml["link"] if link.get("mount") == mount)
        found = [link]
        while "parent" in link:
            link = self.links[link["parent"]]
            found.insert(0, link)
        return found

    def side(self, letter):
        return "table" if any(link.get("axis") == letter for link in self.table) else "head"

    def kind(self):
        sides = [self.side(a["name"]) for a in self.toml["axis"] if a["type"] == "rotary"]
        if not sides:
            return "three linear axes"
        return "-".join(sorted(sides, reverse=True)) if len(sides) == 2 and sides[0] == sides[1] else "head-table"


def number(value):
    return f"{value:.6g}"


def vector(values):
    return "(" + ", ".join(number(round(v, 6)) for v in values) + ")"


# ---------------------------------------------------------------- the drawing

def project(v):
    """M seen from the front right: x to the right, y to the back (up and to the right), z up."""
    return (v[0] + 0.45 * v[1], -v[2] - 0.32 * v[1])


def arrow(x, y, dx, dy, colour, width=2.2):
    length = math.hypot(dx, dy)
    if length < 1e-9:
        return ""
    ux, uy = dx / length, dy / length
    tip, back = (x + dx, y + dy), (x + dx - 9 * ux, y + dy - 9 * uy)
    wing = f"{back[0] - 4 * uy:.1f},{back[1] + 4 * ux:.1f} {back[0] + 4 * uy:.1f},{back[1] - 4 * ux:.1f}"
    return (f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{back[0]:.1f}" y2="{back[1]:.1f}" stroke="{colour}" '
            f'stroke-width="{width}"/><polygon points="{tip[0]:.1f},{tip[1]:.1f} {wing}" fill="{colour}"/>')


def text(x, y, words, size=13, colour=INK, anchor="middle", weight="normal"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{colour}" text-anchor="{anchor}" '
            f'font-weight="{weight}">{words.replace("&", "&amp;").replace("<", "&lt;")}</text>')


def frame(x, y, letter, turned=False):
    """The three directions of M at a place, named by the frame's letter."""
    parts = []
    for axis, colour, name in (((1, 0, 0), FRAME[0], "x"), ((0, 1, 0), FRAME[1], "y"), ((0, 0, 1), FRAME[2], "z")):
        dx, dy = (26 * c for c in project(axis))
        parts.append(arrow(x, y, dx, dy, colour, 1.8))
        parts.append(text(x + 1.35 * dx, y + 1.35 * dy + 4, name, 10, colour))
    parts.append(text(x - 11, y + 15, letter, 15, INK, "middle", "bold"))
    return "".join(parts)


def joint(x, y, axis):
    """The joint that lets a link move: a slide along its direction or a hinge about it, drawn in M."""
    direction = axis["direction"]
    dx, dy = (34 * c for c in project(direction))
    length = math.hypot(dx, dy)
    ux, uy = dx / length, dy / length
    parts = []
    if axis["type"] == "linear":
        for side in (-5, 5):
            parts.append(f'<line x1="{x - dx - side * uy:.1f}" y1="{y - dy + side * ux:.1f}" x2="{x + dx - side * uy:.1f}" '
                         f'y2="{y + dy + side * ux:.1f}" stroke="{SOFT}" stroke-width="1.6"/>')
        parts.append(f'<rect x="{x - 11}" y="{y - 8}" width="22" height="16" rx="3" fill="white" stroke="{LINEAR}" '
                     f'stroke-width="2.4" transform="rotate({math.degrees(math.atan2(uy, ux)):.1f} {x} {y})"/>')
        parts.append(arrow(x, y, 1.25 * dx, 1.25 * dy, LINEAR))
        colour = LINEAR
    else:
        parts.append(f'<line x1="{x - 1.2 * dx:.1f}" y1="{y - 1.2 * dy:.1f}" x2="{x + 1.2 * dx:.1f}" y2="{y + 1.2 * dy:.1f}" '
                     f'stroke="{SOFT}" stroke-width="1.6" stroke-dasharray="9 3 2 3"/>')
        parts.append(arrow(x, y, 1.3 * dx, 1.3 * dy, ROTARY))
        parts.append(circle_about(x, y, direction))
        colour = ROTARY
    parts.append(text(x, y + 58, axis["name"], 17, colour, "middle", "bold"))
    return "".join(parts)


def circle_about(x, y, direction):
    """Three quarters of a circle about the direction, ending in an arrow: the positive turn, right-handed."""
    helper = (0.0, 0.0, 1.0) if abs(direction[2]) < 0.9 else (1.0, 0.0, 0.0)
    u = [direction[(k + 1) % 3] * helper[(k + 2) % 3] - direction[(k + 2) % 3] * helper[(k + 1) % 3] for k in range(3)]
    size = math.sqrt(sum(c * c for c in u))
    u = [c / size for c in u]
    v = [direction[(k + 1) % 3] * u[(k + 2) % 3] - direction[(k + 2) % 3] * u[(k + 1) % 3] for k in range(3)]
    points = []
    for k in range(33):
        angle = math.radians(40 + 270 * k / 32)
        p = project([17 * (math.cos(angle) * a + math.sin(angle) * b) for a, b in zip(u, v)])
        points.append((x + p[0], y + p[1]))
    path = " ".join(f"{p[0]:.1f},{p[1]:.1f}" for p in points[:-2])
    end, before = points[-1], points[-3]
    head = arrow(before[0], before[1], 1.6 * (end[0] - before[0]), 1.6 * (end[1] - before[1]), ROTARY, 2.4)
    return f'<polyline points="{path}" fill="none" stroke="{ROTARY}" stroke-width="2.4"/>' + head


def chain_row(machine, links, y, end_letter, end_words):
    """One way from the floor to the work or the tool, as boxes joined by joints."""
    parts, slots = [], len(links) + 1
    pitch = (WIDTH - 40) / slots
    box = min(118, pitch - 66)
    for k, link in enumerate(links):
        x = 26 + pitch * k
        if k > 0:
            middle = x - 0.5 * (pitch - box)
            parts.append(f'<line x1="{x - pitch + box:.1f}" y1="{y}" x2="{x:.1f}" y2="{y}" stroke="{INK}" stroke-width="1.4"/>')
            if "axis" in link:
                parts.append(joint(middle, y, machine.axes[link["axis"]]))
        parts.append(f'<rect x="{x:.1f}" y="{y - 20}" width="{box:.1f}" height="40" rx="5" fill="#eef1f3" stroke="{INK}" '
                     f'stroke-width="1.4"/>')
        words = link["name"].split("_") if len(link["name"]) > 9 else [link["name"].replace("_", " ")]
        for n, word in enumerate(words):
            parts.append(text(x + box / 2, y + 4.5 + 14 * (n - 0.5 * (len(words) - 1)), word, 13))
    x = 26 + pitch * (len(links) - 1) + box
    parts.append(f'<line x1="{x:.1f}" y1="{y}" x2="{x + 50:.1f}" y2="{y}" stroke="{INK}" stroke-width="1.4"/>')
    parts.append(frame(x + 62, y, end_letter))
    parts.append(text(x + 108, y + 34, end_words, 12, SOFT, "middle"))
    return "".join(parts)


def svg(machine):
    tool = machine.toml["tool"]
    kept = "gauge_mm" in tool
    rows = [chain_row(machine, machine.table, TOP + 0.55 * ROW, "W", "work at " + vector(machine.toml["work"]["origin_mm"])),
            chain_row(machine, machine.head, TOP + 1.6 * ROW, "S" if kept else "T",
                      ("gauge line at " if kept else "tip at ") + vector(tool["gauge_mm" if kept else "tip_mm"]))]
    height = int(TOP + 2.25 * ROW)
    body = [text(20, 30, machine.toml["name"], 20, INK, "start", "bold"),
            text(20, 50, "from the floor to the work (above) and to the tool (below); directions and places in the machine frame "
                 "M, all axes at zero", 12, SOFT, "start"),
            frame(WIDTH - 84, 48, "M"), *rows]
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
            f'font-family="Helvetica, Arial, sans-serif"><rect width="{WIDTH}" height="{height}" fill="white"/>'
            + "\n".join(body) + "</svg>\n")


# ---------------------------------------------------------------- the page

def axis_row(machine, axis):
    unit = "deg" if axis["type"] == "rotary" else "mm"
    speed_unit = "deg/s" if unit == "deg" else "mm/min"
    speed = axis["speed_max_deg_s" if unit == "deg" else "speed_max_mm_min"]
    rapid = axis.get("rapid_max_deg_s" if unit == "deg" else "rapid_max_mm_min", speed)
    sense = "table positive" if axis.get("reversed") else "ISO 841"
    origin = vector(axis.get("origin_mm", (0, 0, 0))) if unit == "deg" else "-"
    change = machine.toml.get("tool_change", {}).get(f'{axis["name"]}_{unit}', axis.get(f"home_{unit}", 0))
    return (f'| {axis["name"]} | {machine.side(axis["name"])} | {vector(axis["direction"])} | {origin} | {sense} '
            f'| {number(axis[f"min_{unit}"])} .. {number(axis[f"max_{unit}"])} {unit} | {number(axis.get(f"home_{unit}", 0))} '
            f'| {number(change)} | {number(speed)} {speed_unit} | {number(rapid)} {speed_unit} '
            f'| {number(axis[f"acceleration_max_{unit}_s2"])} {unit}/s2 | {number(axis[f"jerk_max_{unit}_s3"])} {unit}/s3 |')


def section(machine):
    tool = machine.toml["tool"]
    place = (f'gauge line at {vector(tool["gauge_mm"])}: Z counts to the gauge line, the tip is lower by the tool' if "gauge_mm" in tool
             else f'tip at {vector(tool["tip_mm"])} whatever the tool: Z counts to the tip')
    rapid = {"linear": "all axes arrive together", "dog_leg": "each axis at its own speed (dog-leg)"}
    return "\n".join([
        f'## {machine.toml["name"]}', "", f'`{machine.folder}/machine.toml`, {machine.kind()}', "",
        f'![kinematic chain]({machine.folder}/chain.svg)', "", machine.comment, "",
        "| axis | side | direction in M | point on the axis, mm | positive sense | travel | home | tool change | speed | rapid "
        "| acceleration | jerk |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
        *[axis_row(machine, axis) for axis in machine.toml["axis"]], "",
        f'At zero axes: work frame at {vector(machine.toml["work"]["origin_mm"])}, {place}. '
        f'Rapid moves: {rapid[machine.toml.get("rapid", "linear")]}.', ""])


def page(machines):
    head = """# Machines

Written by `reference_page.py` from the `machine.toml` files beside it; `reference_page.py --check` (part of the lint) says
when this page or a drawing is not what they give. The keys of `machine.toml` are in `engine/machine/README.md`.

Reading the drawings: a box is a link, a sliding block (blue) a linear axis, a hinge (orange) a rotary axis; the arrow is the
direction, the round arrow the right-handed turn about it. **M** is the machine frame, **W** the work, **S** the spindle's
gauge line, **T** a tool tip that stays where it is whatever the tool. ISO 841 is the rule for senses: a positive value moves
the tool positively *relative to the work*, so an axis on the table side moves its link the other way; "table positive"
names the other habit.

The meshes are our own shapes: `make_meshes.py` in each folder writes them with `solid_kit.py` and `machine_kit.py`. No part
stands inside another at home (`unit_machine`, `NoPartStandsInsideAnotherAtHome`). Licence: Apache-2.0, as the rest of Swarf.

| machine | kind | linear axes | rotary axes |
|---|---|---|---|
"""
    rows = []
    for machine in machines:
        letters = {kind: [f'{a["name"]} ({machine.side(a["name"])})' for a in machine.toml["axis"] if a["type"] == kind]
                   for kind in ("linear", "rotary")}
        rows.append(f'| {machine.toml["name"]} | {machine.kind()} | {", ".join(letters["linear"])} '
                    f'| {", ".join(letters["rotary"]) or "-"} |')
    return head + "\n".join(rows) + "\n\n" + "\n".join(section(machine) for machine in machines)


def main():
    folders = sorted(f for f in os.listdir(HERE) if os.path.exists(os.path.join(HERE, f, "machine.toml")))
    machines = [Machine(folder) for folder in folders]
    files = {os.path.join(HERE, "README.md"): page(machines)}
    files |= {os.path.join(HERE, machine.folder, "chain.svg"): svg(machine) for machine in machines}
    stale = []
    for path, content in files.items():
        old = open(path, encoding="utf-8").read() if os.path.exists(path) else None
        if old == content:
            continue
        stale.append(os.path.relpath(path, HERE))
        if "--check" not in sys.argv[1:]:
            with open(path, "w", encoding="utf-8") as file:
                file.write(content)
    if stale and "--check" in sys.argv[1:]:
        sys.exit("assets/machines/reference_page.py: not what the machine.toml files give: " + ", ".join(stale))
    print(f"{len(machines)} machines, {len(stale)} files " + ("stale" if "--check" in sys.argv[1:] else "written"))


if __name__ == "__main__":
    main()
