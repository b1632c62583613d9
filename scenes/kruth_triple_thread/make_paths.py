#!/usr/bin/env python3
"""Writes the triple thread of Kruth et al. (section 4): path.cl and the raw casting, casting.stl.

Run it after a change; both are committed, so that the scene needs nothing but swarf. With --check it prints how deep the
cutter goes below the programmed surfaces, which takes some seconds.

A surface S(z, s) = core(z) + s a(z) is ruled by straight lines a that stand LEAN above the horizontal and turn with the
height: core(z) = (INNER cos f, INNER sin f, z), a = (cos LEAN cos f, cos LEAN sin f, sin LEAN), f = z / PITCH + phase.
The cutter's rim lies on a ruling: its axis is a, RIM away along the surface's normal at the middle of the ruling.
"""
import struct
import sys
from math import atan2, cos, pi, radians, sin, sqrt, tan
from pathlib import Path

HERE = Path(__file__).resolve().parent
RIM = 22.75                        # the paper's woodruff cutter: D 45.5
INNER, RULING = 42.0, 16.0         # where a ruling begins, and its length
LEAN = radians(35)
PITCH = 80.0                       # mm of height for a radian
PHASES = [radians(5 + 120 * k) for k in range(3)]
LOW, HIGH, STEP = 45.0, 126.0, 1.5  # heights of the rulings' lower ends, on from the top face until the rim is free
BELOW = 1.0                        # the rim begins this far below the ruling
AWAY, ASIDE, ABOVE = 60.0, 3.0, 200.0
ROOT, TOP, ALLOWANCE = 33.0, 112.0, 1.5
OUTER = INNER + RULING * cos(LEAN)


def add(*terms):
    return tuple(sum(k * v[i] for k, v in terms) for i in range(3))


def frame(f):
    return (cos(f), sin(f), 0.0), (-sin(f), cos(f), 0.0), (0.0, 0.0, 1.0)


def ruling(z, phase):
    """Lower end, direction, and the normal towards the cutter at the middle."""
    out, round_, up = frame(z / PITCH + phase)
    a = add((cos(LEAN), out), (sin(LEAN), up))
    slope = (INNER + 0.5 * RULING * cos(LEAN)) / PITCH
    # a x dS/dz, turned to the cutter's side: down, outward and on along the turn.
    n = add((cos(LEAN), round_), (slope * sin(LEAN), out), (-slope * cos(LEAN), up))
    return add((INNER, out), (z, up)), a, add((1.0 / sqrt(sum(k * k for k in n)), n))


def heights():
    count = round((HIGH - LOW) / STEP)
    return [LOW + STEP * k for k in range(count + 1)]


def tip(z, phase):
    core, a, n = ruling(z, phase)
    return add((1.0, core), (-BELOW, a), (RIM, n)), a, n


def pose(p, a):
    return "GOTO/" + ",".join(f"{k + 0.0:.9f}" for k in p) + "," + ",".join(f"{k + 0.0:.12f}" for k in a)


def thread(number, phase):
    first, last = tip(LOW, phase), tip(HIGH, phase)
    outside = [add((1.0, p), (AWAY, a), (ASIDE, n)) for p, a, n in (first, last)]
    above = [(p[0], p[1], ABOVE) for p in outside]
    lines = [f"$$ HELICAL SURFACE {number}", "RAPID", pose(above[0], first[1]), "RAPID", pose(outside[0], first[1])]
    lines += ["RAPID", pose(add((1.0, first[0]), (ASIDE, first[2])), first[1]), "FEDRAT/200,MMPM"]
    lines += [pose(*first[:2]), "FEDRAT/300,MMPM"] + [pose(*tip(z, phase)[:2]) for z in heights()[1:]]
    return lines + ["RAPID", pose(outside[1], last[1]), "RAPID", pose(above[1], last[1])]


def write_path():
    lines = ["PARTNO/TRIPLE THREAD: THREE RULED HELICAL SURFACES", "UNITS/MM", "LOADTL/1", "MULTAX/ON", "SPINDL/350,CLW"]
    for number, phase in enumerate(PHASES, 1):
        lines += thread(number, phase)
    (HERE / "path.cl").write_text("\n".join(lines + ["SPINDL/OFF", "FINI"]) + "\n")


def section():
    """Corners of the casting's section at z = 0, (radius, angle), once round: a lobe behind each surface."""
    def flank(r):                  # of the finished surface, with the allowance towards the cutter
        return -(r - INNER) * tan(LEAN) / PITCH + ALLOWANCE * 1.15 / r

    corners = []
    for phase in PHASES:
        back = [(OUTER, radians(-32)), (ROOT, radians(-52))]
        lobe = [(OUTER, radians(-32) + (flank(OUTER) + radians(32)) * k / 6) for k in range(7)]
        side = [(r, flank(r)) for r in (50.0, 45.0, 40.0, 36.0, ROOT)]
        end, following = side[-1][1], back[1][1] + 2 * pi / 3
        core = [(ROOT, end + (following - end) * k / 8) for k in range(1, 8)]
        corners += [(r, f + phase) for r, f in [back[1], (44.0, radians(-42))] + lobe + side + core]
    return corners


def write_casting():
    corners, layers = section(), 36
    count, triangles = len(corners), []
    rings = []
    for k in range(layers + 1):
        z = TOP * k / layers
        rings.append([(r * cos(f + z / PITCH), r * sin(f + z / PITCH), z) for r, f in corners])
    for low, high in zip(rings, rings[1:]):
        for k in range(count):
            m = (k + 1) % count
            triangles += [(low[k], low[m], high[m]), (low[k], high[m], high[k])]
    for k in range(count):
        m = (k + 1) % count
        triangles += [((0, 0, 0), rings[0][m], rings[0][k]), ((0, 0, TOP), rings[-1][k], rings[-1][m])]
    data = b"triple thread, raw casting".ljust(80) + struct.pack("<I", len(triangles))
    for triangle in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *(x for p in triangle for x in p), 0)
    (HERE / "casting.stl").write_bytes(data)


def check():
    """How far the rim goes below points of the surface, over all positions, mm."""
    deepest, phase = 0.0, PHASES[0]
    poses = [tip(LOW + 0.25 * k, phase)[:2] for k in range(int((HIGH - LOW) / 0.25) + 1)]
    for s in [RULING * k / 8 for k in range(9)]:
        core, a, _ = ruling(80.0, phase)
        point = add((1.0, core), (s, a))
        for p, axis in poses:
            d = add((1.0, point), (-1.0, p))
            along = sum(x * y for x, y in zip(d, axis))
            if 0.0 <= along <= RULING + 2 * BELOW:
                deepest = max(deepest, RIM - sqrt(max(0.0, sum(x * x for x in d) - along * along)))
    print(f"the rim goes {1000 * deepest:.1f} um below the ruled surfaces at most")
    slopes = [atan2(r / PITCH, cos(LEAN)) for r in (INNER, OUTER)]
    twist = slopes[1] - slopes[0]
    print(f"twist of a ruling {twist * 180 / pi:.2f} deg, R (1 - cos(twist / 2)) = {1000 * RIM * (1 - cos(twist / 2)):.1f} um")


if __name__ == "__main__":
    write_path()
    write_casting()
    if "--check" in sys.argv:
        check()
