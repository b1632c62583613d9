#!/usr/bin/env python3
"""Writes casting.stl, the raw stock, and part.stl, what is to come of it: a housing with drafted walls of 3 mm
that are 2 mm at their tops, a rib and a boss. The casting is 1 mm too high; its other faces stay as cast.

Prints the volumes in closed form: every horizontal section is a set of rectangles whose sides are linear in z."""
import struct
from pathlib import Path

HERE = Path(__file__).resolve().parent
BOTTOM, FLOOR, FACED, TOP = -24.0, -20.0, 0.0, 1.0
# Lines of the grid at the bottom, and how far each has moved at the top of the casting.
X = [(0.0, 0.5), (3.0, -0.5), (18.0, 0.25), (28.0, -0.25), (48.0, 0.25), (50.5, -0.25), (77.0, 0.5), (80.0, -0.5)]
Y = [(0.0, 0.5), (3.0, -0.5), (20.0, 0.25), (30.0, -0.25), (47.0, 0.5), (50.0, -0.5)]


def at(line, z):
    return line[0] + line[1] * (z - BOTTOM) / (TOP - BOTTOM)


def stands(i, j):
    """Whether cell (i, j) of the grid reaches up to the top: outer walls, rib, boss."""
    wall = i in (0, len(X) - 2) or j in (0, len(Y) - 2)
    return wall or i == 4 or (i == 2 and j == 2)


def solid(i, j, k):
    return 0 <= i < len(X) - 1 and 0 <= j < len(Y) - 1 and (k == 0 or (k == 1 and stands(i, j)))


def facets(top):
    z = [BOTTOM, FLOOR, top]
    for i in range(len(X) - 1):
        for j in range(len(Y) - 1):
            for k in range(2):
                if not solid(i, j, k):
                    continue

                def p(a, b, c):
                    return at(X[i + a], z[k + c]), at(Y[j + b], z[k + c]), z[k + c]

                sides = [((1, 0, 0), [p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)]),
                         ((-1, 0, 0), [p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)]),
                         ((0, 1, 0), [p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0)]),
                         ((0, -1, 0), [p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)]),
                         ((0, 0, 1), [p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)]),
                         ((0, 0, -1), [p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)])]
                for (a, b, c), quad in sides:
                    if not solid(i + a, j + b, k + c):
                        yield quad[0], quad[1], quad[2]
                        yield quad[0], quad[2], quad[3]


def write(name, top):
    corners = list(facets(top))
    data = bytearray(80) + struct.pack("<I", len(corners))
    for facet in corners:
        data += struct.pack("<12fH", 0, 0, 0, *(x for p in facet for x in p), 0)
    (HERE / name).write_bytes(data)


def area(k, z):
    return sum((at(X[i + 1], z) - at(X[i], z)) * (at(Y[j + 1], z) - at(Y[j], z))
               for i in range(len(X) - 1) for j in range(len(Y) - 1) if solid(i, j, k))


def volume(k, low, high):
    """Simpson's rule, which is exact: the area is a parabola in z."""
    return (high - low) / 6 * (area(k, low) + 4 * area(k, (low + high) / 2) + area(k, high))


if __name__ == "__main__":
    write("casting.stl", TOP)
    write("part.stl", FACED)
    print(f"casting {volume(0, BOTTOM, FLOOR) + volume(1, FLOOR, TOP):.6f} mm3, "
          f"removed {volume(1, FACED, TOP):.6f} mm3")
