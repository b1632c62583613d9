#!/usr/bin/env python3
"""Writes the CL paths of the exact_* and so_* scenes: cases of theory 1.1, 2 and 6 whose answer is known.

Run it in this folder after a change; the paths are committed, so that a scene needs nothing but swarf.
"""
from math import acos, asin, cos, pi, radians, sin, sqrt, tan
from pathlib import Path

HERE = Path(__file__).resolve().parent
UP = (0.0, 0.0, 1.0)


class Path_:
    """A CL program; positions in mm, axes are normalised here."""

    def __init__(self, title, cutter, start, axis=UP, feed=1200):
        self.lines = [f"PARTNO/{title}", "UNITS/MM", "LOADTL/1", cutter, "MULTAX/ON", "SPINDL/8000,CLW"]
        self.lines.append("FROM/" + self._pose(start, axis))
        self.feed = None
        self.set_feed(feed)

    @staticmethod
    def _pose(p, a):
        length = sqrt(sum(c * c for c in a))
        return ",".join(f"{c + 0.0:.9f}" for c in p) + "," + ",".join(f"{c / length + 0.0:.12f}" for c in a)

    def note(self, text):
        self.lines.append("$$ " + text)

    def set_feed(self, feed):
        if feed != self.feed:
            self.lines.append(f"FEDRAT/{feed},MMPM")
            self.feed = feed

    def rapid(self, p, a=UP):
        self.lines += ["RAPID", "GOTO/" + self._pose(p, a)]

    def to(self, p, a=UP):
        self.lines.append("GOTO/" + self._pose(p, a))

    def write(self, scene):
        text = "\n".join(self.lines + ["FINI"]) + "\n"
        (HERE / scene / "path.cl").write_text(text)


def slot(scene, title, cutter):
    path = Path_(title, cutter, (0, 0, 30), feed=300)
    path.rapid((0, 0, 2))
    path.to((0, 0, -3))
    path.set_feed(600)
    path.to((30, 0, -3))
    path.to((30, 0, 20))
    path.write(scene)


def passes(scene, title, cutter, rows, top, feed=1200):
    """Zigzag over rows, each a list of (position, axis); rows are joined outside of the part."""
    first = rows[0][0]
    path = Path_(title, cutter, (first[0][0], first[0][1], top + 20), first[1], feed)
    path.rapid((first[0][0], first[0][1], top), first[1])
    for n, row in enumerate(rows):
        for p, a in row if n % 2 == 0 else reversed(row):
            path.to(p, a)
        if n + 1 < len(rows):  # lift, so that the link cuts nothing
            end = row[-1] if n % 2 == 0 else row[0]
            following = rows[n + 1][-1] if n % 2 == 0 else rows[n + 1][0]
            path.rapid((end[0][0], end[0][1], top), end[1])
            path.rapid((following[0][0], following[0][1], top), following[1])
    last = rows[-1][-1] if len(rows) % 2 else rows[-1][0]
    path.rapid((last[0][0], last[0][1], top + 20), last[1])
    path.write(scene)


def along_x(y, z, axis, reach):
    return [((-reach, y, z), axis), ((reach, y, z), axis)]


def scallop_flat_cylinder():
    """Flat end on the normal of a cylinder R = 50: adjacent bottoms meet at R / cos(theta)."""
    R, h = 50.0, 0.01
    theta = acos(R / (R + h))
    rows = []
    for k in range(-3, 4):
        n = (0.0, sin(2 * k * theta), cos(2 * k * theta))
        rows.append(along_x(R * n[1], R * n[2] - R, n, 18))
    passes("exact_scallop_flat_cylinder", "FLAT END ON A CYLINDER: H = R (1 / COS(THETA) - 1)", "CUTTER/10,0", rows, 15)


def scallop_flat_lead():
    """Flat end leaned by 10 degrees along the feed, on a plane: h = r sin(phi) (1 - sqrt(1 - (P / 2r)^2))."""
    r, phi, P = 5.0, radians(10), 4.0
    axis = (sin(phi), 0.0, cos(phi))
    rows = [along_x(P * k, r * sin(phi), axis, 25) for k in range(-2, 3)]
    passes("exact_scallop_flat_lead", "FLAT END WITH A LEAD OF 10 DEGREES ON A PLANE", "CUTTER/10,0", rows, 15)


def scallop_ball_plane():
    rows = [along_x(1.0 * k, 0.0, UP, 16) for k in range(-4, 5)]
    passes("exact_scallop_ball_plane", "BALL D10 ON A PLANE, INTERVAL 1 MM", "CUTTER/10,5", rows, 15)


def scallop_mesh():
    """The plane of scallop_ball_plane as the top of a block given as an STL mesh."""
    rows = [along_x(1.0 * k, 0.0, UP, 16) for k in range(-9, 10)]
    passes("exact_scallop_mesh", "BALL D10 ON THE TOP OF A MESH, INTERVAL 1 MM", "CUTTER/10,5", rows, 15)
    low, high = (-10, -8, -5), (10, 8, 0)
    corner = [tuple((high if n >> a & 1 else low)[a] for a in range(3)) for n in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    text = "solid block\n"
    for a, b, c, d in quads:
        for triangle in ((a, b, c), (a, c, d)):
            text += "facet normal 0 0 0\nouter loop\n"
            text += "".join("vertex %g %g %g\n" % corner[n] for n in triangle) + "endloop\nendfacet\n"
    (HERE / "exact_scallop_mesh" / "block.stl").write_text(text + "endsolid block\n")


def scallop_ball_circle(scene, title, R):
    """Ball on a convex (R > 0) or concave (R < 0) cylinder; contact points P = 1 mm apart by chord."""
    theta = asin(1.0 / (2 * abs(R)))
    rows = []
    for k in range(-4, 5):
        a = 2 * k * theta
        n = (0.0, sin(a) if R > 0 else -sin(a), cos(a))
        z = R * cos(a) - R
        rows.append(along_x(abs(R) * sin(a), z, n, 16))
    passes(scene, title, "CUTTER/10,5", rows, 15)


def scallop_flat_oblique():
    """Disc on the normal of z = -(x^2/40 + y^2/120)/2, feed at 45 degrees, passes 2 mm on each side of the ridge."""
    rows = []
    for offset in (-6, -2, 2, 6):
        row = []
        for i in range(-120, 121):
            s = 0.1 * i
            x, y = (s - offset) / sqrt(2), (s + offset) / sqrt(2)
            row.append(((x, y, -(x * x / 40 + y * y / 120) / 2), (x / 40, y / 120, 1.0)))
        rows.append(row)
    passes("exact_scallop_flat_oblique", "DISC ON AN ELLIPTIC PATCH, FEED AT 45 DEGREES", "CUTTER/16,0", rows, 15, 60)


def hyperboloid():
    """Fixed cylinder r = 5, skew by 20 degrees, while the table turns about X-8 Y0: 9 mm outside, then the core."""
    skew, low = radians(20), -25.0

    def pose(distance, turn):
        c, s = cos(turn), sin(turn)
        x, y = distance, low * sin(skew)
        axis = (-s * sin(skew), c * sin(skew), cos(skew))
        return (c * x - s * y - 8.0, s * x + c * y, low * cos(skew)), axis

    path = Path_("HYPERBOLOID: THE TABLE TURNS UNDER A FIXED SKEW CYLINDER", "CUTTER/10,0", *pose(60.0, 0.0))
    path.note("In joint mode the rotary axis alone moves while the table turns.")
    path.rapid(*pose(49.0, 0.0))
    for turn, distance in enumerate((39.0, 30.0)):
        path.set_feed(600)
        path.to(*pose(distance, 2 * pi * turn))
        path.set_feed(1200)
        for i in range(1, 25):
            path.to(*pose(distance, 2 * pi * (turn + i / 24)))
    path.rapid(*pose(60.0, 4 * pi))
    path.write("exact_hyperboloid")


def cone():
    """Frustum: base radius 40, half angle 15 degrees, axis inclined by 30 degrees about X, milled by the flank."""
    half, tilt, r, low = radians(15), radians(30), 10.0, -6.0
    axis = (0.0, -sin(tilt), cos(tilt))
    across = (0.0, cos(tilt), sin(tilt))

    def pose(phi, outward):
        e = tuple(cos(phi) * (1.0, 0.0, 0.0)[c] + sin(phi) * across[c] for c in range(3))
        ruling = tuple(axis[c] * cos(half) - e[c] * sin(half) for c in range(3))
        normal = tuple(e[c] * cos(half) + axis[c] * sin(half) for c in range(3))
        radius = 40.0 - low * tan(half)
        tip = tuple(radius * e[c] + low * axis[c] + (r + outward) * normal[c] for c in range(3))
        return tip, ruling

    far, ruling = pose(0.0, 80.0)
    path = Path_("CONE FRUSTUM BY THE FLANK, TCP", "CUTTER/20,0", far, ruling, 3000)
    for outward, blocks in ((18.0, 120), (0.0, 1080)):
        path.note(f"{outward:g} mm outside of the finished cone, {blocks} blocks")
        for i in range(blocks + 1):
            path.to(*pose(2 * pi * i / blocks, outward))
    path.to(*pose(0.0, 60.0))
    path.write("exact_cone_flank")


def gouges():
    """A plane finished by a ball D6, then three planted gouges of 20, 5 and 1 um, 3 mm long, on the passes."""
    path = Path_("PLANTED GOUGES OF 20, 5 AND 1 UM", "CUTTER/6,3", (-14, -6, 30))
    path.rapid((-14, -6, 5))
    for n in range(31):
        y = -6 + 0.4 * n
        ends = ((-14, y, 0), (14, y, 0))
        for p in ends if n % 2 == 0 else ends[::-1]:
            path.to(p)
    path.to((14, 6, 5))
    for depth, x, y in ((0.020, -8.0, -3.13), (0.005, -1.5, 0.07), (0.001, 5.0, 3.27)):
        path.rapid((x, y, 5))
        path.note(f"gouge of {1000 * depth:g} um")
        path.to((x, y, -depth))
        path.to((x + 3.0, y, -depth))
        path.to((x + 3.0, y, 5))
    path.write("exact_gouges")


def between_rays():
    """A sharp 60 degree cone engraves three lines into a finished plane; no measuring ray meets them."""
    path = Path_("LINES OF A SHARP CONE BETWEEN THE RAYS: 150, 5 AND 1 UM DEEP", "CUTTER/8", (-12, 0, 30))
    for depth, x, y, length in ((0.150, -8.0, 0.0, 16.0), (0.005, -5.0, 1.95, 3.0), (0.001, 4.0, -2.05, 0.05)):
        path.rapid((x, y, 5))
        path.note(f"line of {1000 * depth:g} um, {length:g} mm long")
        path.to((x, y, -depth))
        path.to((x + length, y, -depth))
        path.to((x + length, y, 5))
    path.write("exact_between_rays")


def walls():
    """Rows of a flat end D10, 10.1 mm apart: two walls .1 mm thick and as high as the stock stay."""
    path = Path_("ROWS OF A FLAT END 10.1 MM APART", "CUTTER/10,0", (-30, -10.1, 30))
    path.rapid((-30, -10.1, 10))
    for n, y in enumerate((-10.1, 0.0, 10.1)):
        ends = [(-30, y, 0), (30, y, 0)][:: 1 if n % 2 == 0 else -1]
        path.to(ends[0])
        path.to(ends[1])
        path.to((ends[1][0], y, 10))
    path.write("exact_walls")


def flank_f1():
    """Oracle F1 of theory 5: the axis through C0 + 8 N0 and C1 + 8 N1 at nine rulings equal in u, eight blocks."""
    def axis_at(u):
        def normal(v):
            n = (600 * v, -1800.0, 1200 * (u - 0.5))
            return [c / sqrt(sum(e * e for e in n)) for c in n]
        n0, n1 = normal(0), normal(1)
        g0 = [60 * u + 8 * n0[0], 8 * n0[1], 8 * n0[2]]
        g1 = [60 * u + 8 * n1[0], 20 * (u - 0.5) + 8 * n1[1], 30 + 8 * n1[2]]
        a = [q - p for p, q in zip(g0, g1)]
        length = sqrt(sum(c * c for c in a))
        a = [c / length for c in a]
        return [p - 3 * c for p, c in zip(g0, a)], a  # the flat end passes 3 mm below the edge of the surface

    def off(pose, y, along):
        return [p + along * c + (-y if i == 1 else 0) for i, (p, c) in enumerate(zip(*pose))], pose[1]

    first, last = axis_at(0), axis_at(1)
    path = Path_("FLANK F1: A TWISTED RULED SURFACE BY A CYLINDER", "CUTTER/16,0", *off(first, 25, 40), 600)
    path.rapid(*off(first, 25, 0))
    path.to(*first)
    for i in range(1, 9):
        path.to(*axis_at(i / 8))
    path.to(*off(last, 25, 0))
    path.rapid(*off(last, 25, 40))
    path.write("exact_flank_f1")


def so_singularity():
    """So et al., Table 2: P0 to P1. The start leans by 40 degrees, which only the branch with A above 0 reaches."""
    p0, a0 = (75.2110, -51.4295, 228.6808), (0.0095944, 0.0159479, 0.9998268)
    p1, a1 = (74.5130, -50.5510, 228.6857), (0.0175393, 0.0107682, 0.9997882)
    lean, flat = radians(40), sqrt(a0[0] ** 2 + a0[1] ** 2)
    start = (sin(lean) * a0[0] / flat, sin(lean) * a0[1] / flat, cos(lean))

    def off(p, a, way):
        return tuple(c + way * d for c, d in zip(p, a))

    path = Path_("SO ET AL., TABLE 2: FROM P0 TO P1 NEAR THE POLE", "CUTTER/2,1", off(p0, start, 60), start, 280)
    path.rapid(off(p0, a0, 60), a0)
    path.rapid(off(p0, a0, 3), a0)
    path.to(p0, a0)
    path.note("the block of Table 2")
    path.to(p1, a1)
    path.to(off(p1, a1, 3), a1)
    path.rapid(off(p1, a1, 60), a1)
    path.write("so_singularity")


def so_c_limit():
    """The block of Table 2 alone, at a feed that nothing can follow."""
    path = Path_("SO ET AL., TABLE 2, AT A FEED THAT NOTHING CAN FOLLOW", "CUTTER/2,1", (75.2110, -51.4295, 228.6808),
                 (0.0095944, 0.0159479, 0.9998268), 60000)
    path.to((74.5130, -50.5510, 228.6857), (0.0175393, 0.0107682, 0.9997882))
    path.write("so_c_limit")


def so_tilted_cone(incline):
    """Theory 2: 72 blocks of equal angle around a cone inclined about X, by the flank of a cylinder r = 10."""
    half, lean = radians(15), radians(incline)

    def turned(p):
        return (p[0], p[1] * cos(lean) - p[2] * sin(lean), p[1] * sin(lean) + p[2] * cos(lean))

    def pose(i):
        c, s = cos(2 * pi * i / 72), sin(2 * pi * i / 72)
        tip = turned(((40 + 10 * cos(half)) * c, (40 + 10 * cos(half)) * s, 10 * sin(half)))
        return (tip[0], tip[1], tip[2] + 50), turned((-sin(half) * c, -sin(half) * s, cos(half)))

    def off(i, way):
        """Away from the cone's surface and up."""
        (p, a), c, s = pose(i), cos(2 * pi * i / 72), sin(2 * pi * i / 72)
        n = turned((cos(half) * c, cos(half) * s, sin(half)))
        return tuple(x + 20 * y + way * z for x, y, z in zip(p, n, a)), a

    path = Path_(f"CIRCLE ROUND A CONE INCLINED BY {incline} DEG, LINEAR AXES", "CUTTER/20,0", *off(0, 100), 1500)
    path.rapid(*off(0, 0))
    for i in range(73):
        path.to(*pose(i))
    path.rapid(*off(72, 0))
    path.rapid(*off(72, 100))
    path.write(f"so_tilted_cone_{incline}")


if __name__ == "__main__":
    slot("exact_slot_flat", "SLOT BY A FLAT END: (2 R L + PI R^2) D", "CUTTER/10,0")
    slot("exact_slot_ball", "SLOT BY A BALL: A L + PI D^2 (3 R - D) / 3", "CUTTER/10,5")
    scallop_flat_cylinder()
    scallop_flat_lead()
    scallop_ball_plane()
    scallop_mesh()
    scallop_ball_circle("exact_scallop_ball_convex", "BALL D10 ON A CONVEX CYLINDER R 50", 50.0)
    scallop_ball_circle("exact_scallop_ball_concave", "BALL D10 ON A CONCAVE CYLINDER R 50", -50.0)
    scallop_flat_oblique()
    hyperboloid()
    cone()
    gouges()
    between_rays()
    walls()
    flank_f1()
    so_singularity()
    so_c_limit()
    so_tilted_cone(10)
    so_tilted_cone(30)
