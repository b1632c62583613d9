"""Machine elements made of solid_kit's solids: guide rails and runner blocks, screws, spindles, motors, rotary tables,
trunnions, covers. Standard library only; mm."""

import math
import os

from solid_kit import Part, box, cylinder, lathe, mirror_x, move, outline, place, prism, rectangle, turn_z

# sRGB
PAINT = (216, 218, 216)
PAINT_DARK = (66, 73, 82)
ACCENT = (24, 92, 138)
STEEL = (150, 155, 160)
GROUND = (160, 165, 170)
OXIDE = (52, 54, 58)
RUBBER = (30, 31, 34)
BRASS = (196, 158, 84)
ALUMINIUM = (138, 143, 149)
ORANGE = (236, 122, 34)

_UNIT = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0),
         "-x": (-1.0, 0.0, 0.0), "-y": (0.0, -1.0, 0.0), "-z": (0.0, 0.0, -1.0)}


def put(solid, along, up, origin):
    """A solid drawn along +x with +z up, turned to the directions `along` and `up` (names or unit vectors)."""
    a, c = _UNIT.get(along, along), _UNIT.get(up, up)
    b = (c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2], c[0] * a[1] - c[1] * a[0])
    return place(solid, tuple((a[k], b[k], c[k]) for k in range(3)), origin)


class Placed:
    """A part seen through a placing function: what is added lands turned and moved."""

    def __init__(self, part, placing):
        self.part, self.placing = part, placing

    def add(self, colour, *solids):
        self.part.add(colour, *[self.placing(solid) for solid in solids])


# ---------------------------------------------------------------- screws

def cap_screw(r=4.0, height=4.0):
    """A socket-head screw standing on z = 0; the socket is a recess of the turned section."""
    return lathe([(0, -1.0), (r, -1.0), (r, height, 0.5), (0.55 * r, height), (0.55 * r, 0.35 * height),
                  (0, 0.35 * height)], 10)


def screw_circle(radius, count, z, r=4.0, height=4.0, start=0.0):
    return [turn_z(move(cap_screw(r, height), radius, 0, z), start + 360.0 * k / count) for k in range(count)]


def downward(solids, z):
    """Solids that stand on z = 0, turned to hang below `z`."""
    return [([((p[0], -p[1], z - p[2]), (n[0], -n[1], -n[2])) for p, n in v], t) for v, t in solids]


# ---------------------------------------------------------------- guides

_RAIL = [(-9, 0), (9, 0), (9, 6), (6.5, 9), (6.5, 12), (9, 15), (9, 18, 1.5), (-9, 18, 1.5), (-9, 15), (-6.5, 12),
         (-6.5, 9), (-9, 6)]
_RUNNER = [(-30, 3), (-10.5, 3), (-10.5, 19.5), (10.5, 19.5), (10.5, 3), (30, 3), (30, 46, 3), (-30, 46, 3)]


def guide(part, along, up, origin, length, scale=1.0, pad=0.0):
    """A profiled rail of `length` from `origin` (middle of its foot) on a ground pad that sinks `pad` into the casting."""
    def on(colour, solid):
        part.add(colour, put(solid, along, up, origin))

    shape = outline([(scale * p[0], scale * p[1], *p[2:]) for p in _RAIL])
    on(STEEL, prism(shape, "x", 0, length, 0.6))
    count = max(2, int(length / (90.0 * scale)))
    for k in range(count):
        on(OXIDE, move(cylinder(4.0 * scale, 17.0 * scale, 18.0 * scale + 0.3, 0.2, 8), length * (k + 0.5) / count))
    if pad > 0:
        on(GROUND, box(-4, length + 4, -22 * scale, 22 * scale, -pad, 0.5, 0.4))


def runner(part, along, up, origin, at, length=80.0, scale=1.0):
    """Runner blocks at the distances `at` along the guide of the same origin; their tops are 46 above its foot."""
    shape = outline([(scale * p[0], scale * p[1], *p[2:]) for p in _RUNNER])
    for s in at:
        part.add(STEEL, put(prism(shape, "x", s - length / 2, s + length / 2, 1.5), along, up, origin))
        for end in (-1, 1):
            low, high = sorted((s + end * (length / 2 - 1), s + end * (length / 2 + 6)))
            part.add(RUBBER, *[put(box(low, high, *side, 5 * scale, 40 * scale, 1), along, up, origin)
                               for side in ((-27 * scale, -11 * scale), (11 * scale, 27 * scale))])


def covers(part, along, up, origin, width, height, steps, reach, side=1):
    """Telescopic way covers: nested roofs that begin at `origin` and reach out by `reach` per step."""
    for k in range(steps):
        w, top = width / 2 - 7 * k, height - 7 * k
        roof = outline([(-w, 0), (-w + 5, 0), (-w + 5, top - 16), (w - 5, top - 16), (w - 5, 0), (w, 0), (w, top - 10, 2),
                        (0.45 * w, top, 6), (-0.45 * w, top, 6), (-w, top - 10, 2)])
        low, high = sorted((side * (reach * k - (8 if k else 0)), side * reach * (k + 1)))
        part.add(ALUMINIUM, put(prism(roof, "x", low, high, 1.0), along, up, origin))


def ball_screw(part, along, up, origin, length, r=10.0):
    part.add(STEEL, put(move(_along_x(cylinder(r, 0, length, 1, 18))), along, up, origin))


def _along_x(solid):
    return place(solid, ((0, 0, 1), (1, 0, 0), (0, 1, 0)))


# ---------------------------------------------------------------- turned units

def disc(r, low, high, bevel=2.0, segments=48):
    return cylinder(r, low, high, bevel, segments)


def motor(part, along, up, origin, r, length):
    """A ribbed motor whose flange stands on `origin` and which points along `along`."""
    fins = [(0, 0), (0.86 * r, 0), (0.86 * r, 10)]
    step = (length - 26) / max(2, int(length / 16))
    for k in range(max(2, int(length / 16))):
        z = 10 + step * k
        fins += [(r, z, 1), (r, z + 0.55 * step, 1), (0.9 * r, z + 0.55 * step), (0.9 * r, z + step)]
    fins += [(r, length - 14, 1), (r, length - 4, 4), (0, length - 4)]
    part.add(OXIDE, put(_along_x(lathe(fins, 28)), along, up, origin))
    part.add(ACCENT, put(_along_x(lathe([(0, length - 5), (0.7 * r, length - 5), (0.7 * r, length + 8, 4), (0, length + 8)],
                                        32)), along, up, origin))
    part.add(PAINT_DARK, put(box(0.3 * length, 0.75 * length, -0.45 * r, 0.45 * r, 0.8 * r, 1.35 * r, 4), along, up, origin))


def spindle(part, top, r=80.0):
    """A spindle cartridge about z from its gauge line at z = 0 up to `top`: nose, flange with screws, labyrinth, body."""
    k = r / 80.0
    part.add(STEEL, lathe([(0, 0), (34 * k, 0, 1), (34 * k, 4), (46 * k, 4, 1.5), (46 * k, 20), (0, 20)], 48))
    part.add(OXIDE, lathe([(0, -0.5), (20 * k, -0.5, 1), (20 * k, 3), (0, 3)], 32))
    part.add(GROUND, lathe([(0, 19), (54 * k, 19, 2), (62 * k, 50, 2), (62 * k, 66), (0, 66)], 40))
    part.add(ORANGE, lathe([(60 * k, 55), (63 * k, 55), (63 * k, 59), (60 * k, 59)], 40))
    part.add(OXIDE, lathe([(0, 65), (72 * k, 65, 2), (72 * k, 78, 2), (0, 78)], 40))
    part.add(STEEL, *downward(screw_circle(66 * k, 8, 0, 3.4, 3.0, 15), 65))
    part.add(PAINT, lathe([(0, 77), (0.92 * r, 77, 3), (r, 92), (r, top, 3), (0, top)], 40))


def nozzles(part, r=52.0, z=70.0):
    for degrees in (35, 155, 275):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        part.add(BRASS, move(lathe([(0, -22), (3, -22), (6, -8, 1), (6, 2), (0, 2)], 12), r * c, r * s, z - 4))


def sector(outer, inner, half_gap, middle, low, high, bevel, share=60.0):
    """A sector of a disc whose straight sides stay `half_gap` off the slot centre lines `share` degrees apart."""
    def limit(r):
        return math.radians(0.5 * share) - math.asin(half_gap / r)
    inner = max(inner, 1.02 * half_gap / math.sin(math.radians(0.49 * share)))
    angles = [-limit(outer) + 2 * limit(outer) * k / 8 for k in range(9)]
    b = limit(inner)
    points = [(outer * math.cos(a), outer * math.sin(a)) for a in angles]
    points += [(inner * math.cos(b), inner * math.sin(b)), (inner * math.cos(b), -inner * math.sin(b))]
    shape = outline(points)
    for k in range(9):
        n = (math.cos(angles[k]), math.sin(angles[k]))
        p, before, after = shape[k]
        shape[k] = (p, n if k > 0 else before, n if k < 8 else after)
    return turn_z(prism(shape, "z", low, high, bevel), middle)


def rotary_table(part, r, top, thickness=46.0, slots=6, bore=25.0):
    """A T-slotted rotary table about z with its face at `top` and a graduation on its rim."""
    bottom, share = top - thickness, 360.0 / slots
    part.add(GROUND, lathe([(0, bottom), (r, bottom, 1), (r, top - 18, 0.8), (0, top - 18)], 72))
    for k in range(slots):
        middle = share * (k + 0.5)
        for low, high, gap, bevel in ((top - 18.5, top - 9, 11.0, 0.3), (top - 9.5, top, 7.0, 1.0)):
            part.add(GROUND, sector(r, bore * 1.3, gap, middle, low, high, bevel, share))
    part.add(STEEL, lathe([(0, top - 19), (bore, top - 19), (bore, top - 0.5, 1), (0.6 * bore, top - 0.5),
                           (0.6 * bore, top - 6), (0, top - 6)], 36))
    for k in range(36):
        tall = k % 3 == 0
        part.add(OXIDE, turn_z(box(r - 0.6, r + 0.3, -0.6, 0.6, bottom + 4, bottom + (16 if tall else 10), 0), 10.0 * k))


# ---------------------------------------------------------------- trunnions about x

def trunnion_cradle(part, half_span, pivot, floor, depth, y_centre, half_y):
    """A yoke that swings about the x axis through `pivot` (y, z): arms inside +-half_span down to a floor plate.

    The plate's top is at z = floor, `depth` thick, from y_centre - half_y to y_centre + half_y.
    """
    py, pz = pivot
    inner = half_span - 48
    hub = [(py + 78 * math.cos(math.radians(d)), pz + 78 * math.sin(math.radians(d))) for d in range(-20, 201, 20)]
    low = floor - depth
    arm = prism(outline([(y_centre - half_y, low, 14), (y_centre + half_y, low, 14), (y_centre + half_y, floor + 26, 20)] +
                        hub + [(y_centre - half_y, floor + 26, 20)]), "x", inner, half_span, 4)
    part.add(ACCENT, arm, mirror_x(arm))
    pocket = prism(outline([(y_centre - 0.62 * half_y, low + 26), (y_centre + 0.62 * half_y, low + 26),
                            (y_centre + 0.62 * half_y, floor + 10), (py + 34, pz - 66), (py - 34, pz - 66),
                            (y_centre - 0.62 * half_y, floor + 10)], 10), "x", half_span - 2, half_span + 2.5, 2)
    part.add(PAINT_DARK, pocket, mirror_x(pocket))
    part.add(ACCENT, prism(rectangle(-inner - 4, inner + 4, y_centre - half_y + 4, y_centre + half_y - 4, 16), "z", low + 4,
                           floor, 4))
    journal = put(_along_x(lathe([(0, 0), (56, 0), (56, 14, 1.5), (46, 14), (46, 17), (0, 17)], 44)), "x", "z",
                  (half_span - 4, py, pz))
    part.add(STEEL, journal, mirror_x(journal))
    cover = put(_along_x(lathe([(0, -10), (36, -10, 3), (42, -4, 1), (42, 2), (0, 2)], 36)), "x", "z", (inner, py, pz))
    part.add(PAINT_DARK, cover, mirror_x(cover))


def trunnion_bracket(part, half_span, pivot, foot, width=92.0, drive=True):
    """The two bearing brackets that carry a cradle of the same half_span; they stand on z = foot."""
    py, pz = pivot
    low, high = half_span + 14, half_span + 14 + width
    top = [(py + 96 * math.cos(math.radians(d)), pz + 96 * math.sin(math.radians(d))) for d in range(-10, 191, 20)]
    body = prism(outline([(py - 150, foot, 0), (py + 150, foot, 0)] + top), "x", low, high, 5)
    plate = prism(rectangle(low - 6, high + 26, py - 176, py + 176, 10), "z", foot, foot + 26, 3)
    part.add(PAINT, body, mirror_x(body), plate, mirror_x(plate))
    for y in (-158, -60, 60, 158):
        screw = move(cap_screw(8, 8), high + 12, py + y, foot + 26)
        part.add(OXIDE, screw, mirror_x(screw))
    cap = put(_along_x(cylinder(78, 0, 12, 2, 44)), "x", "z", (high - 2, py, pz))
    seal = put(_along_x(lathe([(60, -7), (76, -7, 1.5), (76, 2), (60, 2)], 44)), "x", "z", (low, py, pz))
    part.add(PAINT_DARK, cap, mirror_x(cap), seal, mirror_x(seal))
    if drive:
        motor(part, "x", "z", (high + 10, py, pz), 62, 120)
    end = put(_along_x(lathe([(0, 0), (52, 0), (52, 26, 6), (34, 34, 3), (0, 34)], 40)), "x", "z", (high + 10, py, pz))
    part.add(ACCENT, mirror_x(end))


# ---------------------------------------------------------------- castings

def ribbed(part, x, y, z, pitch=120.0, colour=PAINT, bevel=6.0, depth=9.0, faces="x- x+ y- y+"):
    """A block casting with vertical ribs on the named side faces (not on those that carry guides)."""
    part.add(colour, box(*x, *y, *z, bevel))
    for face in faces.split():
        sides, across = (x, y) if face[0] == "x" else (y, x)
        wall = sorted((sides[0] - depth, sides[0] + 4) if face[1] == "-" else (sides[1] - 4, sides[1] + depth))
        count = max(2, round((across[1] - across[0]) / pitch))
        for k in range(1, count):
            at = across[0] + (across[1] - across[0]) * k / count
            spans = (*wall, at - 8, at + 8) if face[0] == "x" else (at - 8, at + 8, *wall)
            part.add(colour, box(*spans, z[0] + 18, z[1] - 18, 3))


def feet(part, spots, z, height=60.0):
    for x, y in spots:
        part.add(OXIDE, move(lathe([(0, 0), (44, 0, 2), (44, 12, 3), (20, 24), (20, height), (0, height)], 20), x, y,
                             z - height))


def plinth(part, x, y, z, height=34.0):
    part.add(PAINT_DARK, box(x[0] - 14, x[1] + 14, y[0] - 14, y[1] + 14, z - height, z, 5))


def band(part, x, y, z, height=22.0):
    """A stripe around a casting."""
    part.add(ACCENT, box(x[0] - 2, x[1] + 2, y[0] - 2, y[1] + 2, z, z + height, 2))


def t_slots(part, x, y, top, count, along="x", colour=GROUND):
    """A rectangular T-slotted table face: strips over a dark floor, `top` - 40 to `top`."""
    part.add(GROUND, box(*x, *y, top - 70, top - 22, 3))
    part.add(OXIDE, box(x[0] + 6, x[1] - 6, y[0] + 6, y[1] - 6, top - 23, top - 20, 0.5))
    low, high = (y if along == "x" else x)
    pitch = (high - low) / (count + 0.0)
    for k in range(count):
        a, b = low + pitch * k + (7 if k else 0), low + pitch * (k + 1) - (7 if k < count - 1 else 0)
        part.add(colour, box(*(x if along == "x" else (a, b)), *((a, b) if along == "x" else y), top - 22.5, top, 1.2))


def write(folder, makers):
    """Makes each part and writes <name>.ply beside the script; the maker of `name` is called name or name_mesh."""
    triangles = size = 0
    for make in makers:
        part = make()
        name = make.__name__.removesuffix("_mesh")
        path = os.path.join(folder, name + ".ply")
        part.write_ply(path)
        triangles += len(part.triangles)
        size += os.path.getsize(path)
        print(f"{name:14s} {len(part.triangles):6d} triangles")
    print(f"{'together':14s} {triangles:6d} triangles, {size / 1e6:.2f} MB")


__all__ = [name for name in dir() if not name.startswith("_") and name not in ("math", "os")]
