#!/usr/bin/env python3
"""What a flat end mill removes from a box, from the coordinates of a CL file alone: the oracle of cl_coremill and cl_plane_1.

usage: scan_lines.py FILE DIAMETER X0,Y0,Z0,X1,Y1,Z1 PITCH        all in mm; prints mm3

It knows GOTO and the CIRCLE before a GOTO in planes of one height, and nothing of swarf. Each height's discs and their ways
cover intervals of the lines y = const; a column is cut down to the lowest height that covers it.
"""
import math
import re
import sys

CHORD = 1e-4  # mm, greatest distance of an arc from its chords


def arc(centre, normal_z, a, b):
    """Chords of the arc from a to b about a centre, clockwise where normal_z is above zero (CL data as these files write it)."""
    radius = math.dist(a, centre)
    start = math.atan2(a[1] - centre[1], a[0] - centre[0])
    turn = math.atan2(b[1] - centre[1], b[0] - centre[0]) - start
    turn = -(-turn % (2 * math.pi)) if normal_z > 0 else turn % (2 * math.pi)
    count = max(1, math.ceil(abs(turn) / (2 * math.acos(1 - CHORD / radius))))
    points = [
        (centre[0] + radius * math.cos(start + turn * i / count), centre[1] + radius * math.sin(start + turn * i / count))
        for i in range(count)
    ]
    return points[1:] + [b] if count > 1 else [b]


def ways(text):
    """{height: [(a, b)]}: where the centre of the disc goes at each height; a plunge ends in a point."""
    found, last, circle = {}, None, None
    for line in text.splitlines():
        word, _, rest = line.partition("/")
        if word not in ("GOTO", "FROM", "CIRCLE"):
            continue
        numbers = [float(n) for n in re.split(r"[,\s]+", rest.strip())]
        if word == "CIRCLE":
            circle = numbers
            continue
        point, height = tuple(numbers[:2]), numbers[2]
        if last is None or last[1] != height:
            # Way above the lower end is covered by it when the move is vertical; no other move changes height here.
            if last is not None and word == "GOTO" and last[0] != point and min(last[1], height) < ways.above:
                sys.exit(f"a slanted move to {line}: this oracle knows planes of one height")
            found.setdefault(height, []).append((point, point))
        else:
            corners = [last[0]] + (arc(circle[:2], circle[5], last[0], point) if circle else [point])
            found.setdefault(height, []).extend(zip(corners, corners[1:]))
        last, circle = (point, height), None
    return found


def interval(a, b, radius, y):
    """Where a disc on its way from a to b covers the line at y."""
    ends = []
    for centre in (a, b):
        rest = radius * radius - (y - centre[1]) ** 2
        if rest > 0:
            ends += [centre[0] - math.sqrt(rest), centre[0] + math.sqrt(rest)]
    length = math.dist(a, b)
    if length > 0:
        nx, ny = -(b[1] - a[1]) / length * radius, (b[0] - a[0]) / length * radius
        for sx, sy in ((nx, ny), (-nx, -ny)):  # the two sides of the strip between the discs
            ya, yb = a[1] + sy, b[1] + sy
            if ya != yb and min(ya, yb) <= y <= max(ya, yb):
                ends.append(a[0] + sx + (b[0] - a[0]) * (y - ya) / (yb - ya))
    return (min(ends), max(ends)) if ends else None


def union(intervals):
    joined = []
    for begin, end in sorted(intervals):
        if joined and begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(joined[-1][1], end))
        else:
            joined.append((begin, end))
    return joined


def length_within(intervals, x0, x1):
    return sum(max(0.0, min(end, x1) - max(begin, x0)) for begin, end in intervals)


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    box = [float(n) for n in sys.argv[3].split(",")]
    radius, pitch = float(sys.argv[2]) / 2, float(sys.argv[4])
    ways.above = box[5]
    with open(sys.argv[1], encoding="utf-8") as file:
        levels = {height: way for height, way in ways(file.read()).items() if height < box[5]}
    heights = sorted(levels)
    tops = heights[1:] + [box[5]]
    lines = round((box[4] - box[1]) / pitch)
    rows = [[] for _ in range(lines)]
    volume = 0.0
    for height, top in zip(heights, tops):
        for a, b in levels[height]:
            first = math.floor((min(a[1], b[1]) - radius - box[1]) / pitch - 0.5)
            last = math.ceil((max(a[1], b[1]) + radius - box[1]) / pitch - 0.5)
            for n in range(max(0, first), min(lines, last + 1)):
                part = interval(a, b, radius, box[1] + (n + 0.5) * pitch)
                if part:
                    rows[n].append(part)
        rows = [union(row) for row in rows]
        volume += (top - height) * pitch * sum(length_within(row, box[0], box[3]) for row in rows)
    print(f"{volume:.1f}")


if __name__ == "__main__":
    main()
