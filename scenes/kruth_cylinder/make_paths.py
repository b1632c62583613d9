#!/usr/bin/env python3
"""Writes CL data and raw stock of Figures 4 to 6 of Kruth et al.: a cylinder's section milled by a flat end on its normal.

Run it after a change; path.cl, inclined.cl, segment.stl and inclined.stl are committed, so that the scenes need nothing
but swarf. The paper gives the figures' angles (+20, 0, -20 degrees) and no other size: those below are ours.
"""
from math import cos, radians, sin, tan
from pathlib import Path

HERE = Path(__file__).resolve().parent
RADIUS, TOP = 80.0, 40.0           # finished cylinder; its highest line stands 40 mm above the work's origin
ALLOWANCE = 1.0                    # of the raw segment
HALF_WIDTH, HALF_LENGTH = 35.0, 16.0
ROWS = (-10.0, -5.0, 0.0, 5.0, 10.0)     # along the cylinder, mm
TURN = (24, -20)                   # degrees; the paper's points 1, 2, 3 are +20, 0, -20
LIFT = 50.0                        # along the tool's axis, between the passes


class Section:
    """A cylinder about an axis in the plane y z, `incline` from y; `normal` and `point` by angle and place along it."""

    def __init__(self, incline_deg):
        self.c, self.s = cos(radians(incline_deg)), sin(radians(incline_deg))
        self.slope = tan(radians(incline_deg))

    def normal(self, angle):
        return (sin(angle), -self.s * cos(angle), self.c * cos(angle))

    def point(self, radius, angle, along):
        n, centre = self.normal(angle), (0.0, along * self.c, TOP - RADIUS + along * self.s)
        return tuple(o + radius * k for o, k in zip(centre, n))

    def height(self, radius, x, y):
        """Of the surface above the plane z = 0, over a place of it."""
        rise = (radius * radius - x * x) ** 0.5
        return TOP - RADIUS + y * self.slope + rise / self.c


def pose(tip, axis):
    return "GOTO/" + ",".join(f"{k + 0.0:.9f}" for k in tip) + "," + ",".join(f"{k + 0.0:.12f}" for k in axis)


def write_path(name, title, section):
    lines = [f"PARTNO/{title}", "UNITS/MM", "LOADTL/1", "CUTTER/16,0", "MULTAX/ON", "SPINDL/4000,CLW"]
    angles = [radians(k) for k in range(TURN[0], TURN[1] - 1, -1)]
    for number, along in enumerate(ROWS, 1):
        tips = [section.point(RADIUS, a, along) for a in angles]
        axes = [section.normal(a) for a in angles]
        above = [pose(section.point(RADIUS + LIFT, radians(a), along), section.normal(radians(a))) for a in (*TURN, 0)]
        lines += [f"$$ PASS {number}", "RAPID", above[0], "FEDRAT/600,MMPM", pose(tips[0], axes[0])]
        lines += ["FEDRAT/1200,MMPM"] + [pose(p, n) for p, n in zip(tips[1:], axes[1:])]
        lines += ["RAPID", above[1], "RAPID", above[2]]
    (HERE / name).write_text("\n".join(lines + ["SPINDL/OFF", "FINI"]) + "\n")


def write_segment(name, section):
    """A slab below the raw cylinder between two planes y and two planes x, standing on z = 0."""
    steps, radius = 48, RADIUS + ALLOWANCE
    xs = [HALF_WIDTH * (2 * k / steps - 1) for k in range(steps + 1)]
    ends = []
    for y in (-HALF_LENGTH, HALF_LENGTH):
        ends.append([(x, y, 0.0) for x in xs] + [(x, y, section.height(radius, x, y)) for x in reversed(xs)])
    count, triangles = len(ends[0]), []
    for k in range(count):
        a, b, c, d = ends[0][k], ends[0][(k + 1) % count], ends[1][(k + 1) % count], ends[1][k]
        triangles += [(a, c, b), (a, d, c)]
    for k in range(steps):
        for end, turned in zip(ends, (False, True)):
            a, b, c, d = end[k], end[k + 1], end[count - 2 - k], end[count - 1 - k]
            triangles += [(a, c, b), (a, d, c)] if turned else [(a, b, c), (a, c, d)]
    text = "solid segment\n"
    for triangle in triangles:
        text += "facet normal 0 0 0\nouter loop\n"
        text += "".join("vertex %.6f %.6f %.6f\n" % p for p in triangle) + "endloop\nendfacet\n"
    (HERE / name).write_text(text + "endsolid segment\n")


if __name__ == "__main__":
    straight, inclined = Section(0.0), Section(3.0)
    write_path("path.cl", "SECTION OF A CYLINDER ALONG THE B AXIS: B +20 TO -20 OVER THE POLE", straight)
    write_path("inclined.cl", "SECTION OF A CYLINDER INCLINED BY 3 DEGREES: B AND C TOGETHER", inclined)
    write_segment("segment.stl", straight)
    write_segment("inclined.stl", inclined)
