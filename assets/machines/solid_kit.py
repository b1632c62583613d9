"""Bevelled solids with smooth shading normals, and a binary PLY writer. Standard library only.

A solid is (vertices, triangles): vertices are (position, normal) pairs and triangles are index triples that
wind counter-clockwise seen from outside. A bevel is one chamfer facet whose vertices carry the normals of the
two faces it joins: flat shading shows a chamfer, interpolated normals show a rounded edge.

Profiles are closed outlines of the plane, lists of (point, normal_before, normal_after): where the two normals
agree the outline is smooth, where they differ it has a crease.
"""

import math
import struct


# ---------------------------------------------------------------- outlines

def _edge_normal(p, q):
    dx, dy = q[0] - p[0], q[1] - p[1]
    length = math.hypot(dx, dy)
    return (dy / length, -dx / length)


def _area(points):
    return 0.5 * sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(points, points[1:] + points[:1]))


def outline(corners, radius=0.0, segments=4):
    """Outline through `corners` (x, y) or (x, y, radius), each corner rounded by its own or the common radius."""
    points = [(c[0], c[1], c[2] if len(c) > 2 else radius) for c in corners]
    if _area(points) < 0:
        points.reverse()
    result = []
    for i, (x, y, r) in enumerate(points):
        before = _edge_normal(points[i - 1], (x, y))
        after = _edge_normal((x, y), points[(i + 1) % len(points)])
        turn = math.atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1])
        if r <= 0.0 or abs(turn) < 1e-6:
            result.append(((x, y), before, after))
            continue
        # The centre lies inside the corner; on a reflex corner the normals point towards it.
        side = 1.0 if turn > 0 else -1.0
        scale = -side * r / (1.0 + before[0] * after[0] + before[1] * after[1])
        cx, cy = x + scale * (before[0] + after[0]), y + scale * (before[1] + after[1])
        start = math.atan2(before[1], before[0])
        for k in range(segments + 1):
            angle = start + turn * k / segments
            n = (math.cos(angle), math.sin(angle))
            result.append(((cx + side * r * n[0], cy + side * r * n[1]), n, n))
    return result


def rectangle(x0, x1, y0, y1, radius=0.0, segments=4):
    return outline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], radius, segments)


def circle(x, y, r, segments):
    angles = [2 * math.pi * k / segments for k in range(segments)]
    return [((x + r * math.cos(a), y + r * math.sin(a)), (math.cos(a), math.sin(a)), (math.cos(a), math.sin(a)))
            for a in angles]


def _inset(profile, distance):
    result = []
    for (x, y), a, b in profile:
        scale = distance / (1.0 + a[0] * b[0] + a[1] * b[1])
        result.append((x - scale * (a[0] + b[0]), y - scale * (a[1] + b[1])))
    return result


def _ears(points):
    """Triangulates a simple counter-clockwise polygon by clipping ears."""
    def cross(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    rest, triangles = list(range(len(points))), []
    while len(rest) > 3:
        best = None
        for i in range(len(rest)):
            ia, ib, ic = rest[i - 1], rest[i], rest[(i + 1) % len(rest)]
            a, b, c = points[ia], points[ib], points[ic]
            turn = cross(a, b, c)
            if min(math.dist(a, b), math.dist(b, c)) < 1e-6:  # a bevel as large as a rounding: its arc is one point
                best = (0.0, i, (ia, ib, ic))
                break
            if turn <= 1e-9 or any(
                    cross(a, b, points[k]) >= 0 and cross(b, c, points[k]) >= 0 and cross(c, a, points[k]) >= 0
                    and min(math.dist(points[k], corner) for corner in (a, b, c)) > 1e-6
                    for k in rest if k not in (ia, ib, ic)):
                continue
            size = math.dist(a, c)  # the shortest diagonal first keeps the triangles compact
            if best is None or size < best[0]:
                best = (size, i, (ia, ib, ic))
        if best is None:
            raise ValueError("outline crosses itself")
        triangles.append(best[2])
        rest.pop(best[1])
    return triangles + [tuple(rest)]


# ---------------------------------------------------------------- solids

_AXES = {  # from (profile x, profile y, height): proper rotations
    "z": lambda p: p,                    # profile in (x, y)
    "x": lambda p: (p[2], p[0], p[1]),   # profile in (y, z)
    "y": lambda p: (p[0], -p[2], p[1]),  # profile in (x, z)
}


def prism(profile, axis, low, high, bevel=1.0):
    """The profile extruded along an axis, both rims bevelled."""
    if axis == "y":
        low, high = -high, -low
    vertices, triangles = [], []
    place = _AXES[axis]

    def put(x, y, z, n):
        vertices.append((place((x, y, z)), place(n)))
        return len(vertices) - 1

    inner = _inset(profile, bevel)
    caps = _ears(inner)
    count = len(profile)
    rings = {}
    for z, nz in ((low, -1.0), (high, 1.0)):
        rings[nz] = [put(x, y, z, (0.0, 0.0, nz)) for x, y in inner]
        triangles += [tuple(rings[nz][k] for k in (t if nz > 0 else t[::-1])) for t in caps]
    for i in range(count):
        (p, _, n0), (q, n1, _) = profile[i], profile[(i + 1) % count]
        j = (i + 1) % count
        a = put(*p, low + bevel, (*n0, 0.0))
        b = put(*q, low + bevel, (*n1, 0.0))
        c = put(*q, high - bevel, (*n1, 0.0))
        d = put(*p, high - bevel, (*n0, 0.0))
        triangles += [(a, b, c), (a, c, d)]
        if bevel > 0:
            triangles += [(rings[-1.0][i], rings[-1.0][j], b), (rings[-1.0][i], b, a)]
            triangles += [(d, c, rings[1.0][j]), (d, rings[1.0][j], rings[1.0][i])]
    # At a crease the bevel of a rim meets the rim of its neighbour in the same points: nothing is left open.
    return vertices, triangles


def box(x0, x1, y0, y1, z0, z1, bevel=1.5):
    """A box with all twelve edges bevelled: six faces, twelve chamfers, eight corners."""
    low, high = (x0, y0, z0), (x1, y1, z1)
    vertices, index = [], {}
    for corner in range(8):
        sign = [1 if corner >> k & 1 else -1 for k in range(3)]
        for face in range(3):
            p = [(high[k] if sign[k] > 0 else low[k]) - (0 if k == face else sign[k] * bevel) for k in range(3)]
            n = [float(sign[k]) if k == face else 0.0 for k in range(3)]
            index[corner, face] = len(vertices)
            vertices.append((tuple(p), tuple(n)))
    triangles = []

    def polygon(ids):
        points = [vertices[i][0] for i in ids]
        middle = [sum(p[k] for p in points) / len(points) - 0.5 * (low[k] + high[k]) for k in range(3)]
        u = [points[1][k] - points[0][k] for k in range(3)]
        v = [points[2][k] - points[0][k] for k in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        if sum(a * b for a, b in zip(normal, middle)) < 0:
            ids = ids[::-1]
        for k in range(1, len(ids) - 1):
            triangles.append((ids[0], ids[k], ids[k + 1]))

    for face in range(3):
        i, j = (face + 1) % 3, (face + 2) % 3
        for side in (0, 1):
            base = side << face
            ring = [base, base | 1 << i, base | 1 << i | 1 << j, base | 1 << j]
            polygon([index[c, face] for c in ring])
        if bevel > 0:
            for corner in (c for c in range(8) if not c >> face & 1):  # the edge along axis `face`
                other = corner | 1 << face
                polygon([index[corner, i], index[other, i], index[other, j], index[corner, j]])
    if bevel > 0:
        for corner in range(8):
            polygon([index[corner, k] for k in range(3)])
    return vertices, triangles


def lathe(corners, segments=48, radius=0.0, bevel_segments=1):
    """Corners (r, z) or (r, z, rounding) of a closed half section at r >= 0, turned about the z axis.

    A section that touches the axis has two corners with r = 0; the edge between them is dropped.
    """
    profile = outline(corners, radius, bevel_segments)
    vertices, triangles = [], []
    turns = [(math.cos(2 * math.pi * k / segments), math.sin(2 * math.pi * k / segments)) for k in range(segments)]

    def ring(p, n):
        first = len(vertices)
        for c, s in turns:
            vertices.append(((p[0] * c, p[0] * s, p[1]), (n[0] * c, n[0] * s, n[1])))
        return first

    for i in range(len(profile)):
        (p, _, n0), (q, n1, _) = profile[i], profile[(i + 1) % len(profile)]
        if max(p[0], q[0]) < 1e-9:
            continue
        a, b = ring(p, n0), ring(q, n1)
        for k in range(segments):
            m = (k + 1) % segments
            if p[0] > 1e-9:
                triangles.append((a + k, a + m, b + (m if q[0] > 1e-9 else k)))
            if q[0] > 1e-9:
                triangles.append((a + k, b + m, b + k))
    return vertices, triangles


def cylinder(r, z0, z1, bevel=1.0, segments=40):
    return lathe([(0, z0), (r, z0, bevel), (r, z1, bevel), (0, z1)], segments)


def tube(points, r, segments=10):
    """A round rod along a polyline, closed by flat ends."""
    vertices, triangles, rings = [], [], []

    def unit(v):
        length = math.sqrt(sum(c * c for c in v))
        return tuple(c / length for c in v)

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    side = None
    for i, p in enumerate(points):
        tangent = unit(tuple(b - a for a, b in zip(points[max(i - 1, 0)], points[min(i + 1, len(points) - 1)])))
        if side is None:
            side = cross(tangent, (1.0, 0.0, 0.0) if abs(tangent[0]) < 0.8 else (0.0, 1.0, 0.0))
        side = unit(cross(cross(tangent, side), tangent))
        up = cross(tangent, side)
        ring = []
        for k in range(segments):
            c, s = math.cos(2 * math.pi * k / segments), math.sin(2 * math.pi * k / segments)
            n = tuple(c * a + s * b for a, b in zip(side, up))
            ring.append((tuple(q + r * m for q, m in zip(p, n)), n))
        rings.append((ring, tangent))
    firsts = []
    for ring, _ in rings:
        firsts.append(len(vertices))
        vertices += ring
    for a, b in zip(firsts, firsts[1:]):
        for k in range(segments):
            m = (k + 1) % segments
            triangles += [(a + k, a + m, b + m), (a + k, b + m, b + k)]
    for (ring, tangent), sign in ((rings[0], -1.0), (rings[-1], 1.0)):
        first = len(vertices)
        vertices += [(p, tuple(sign * t for t in tangent)) for p, _ in ring]
        for k in range(1, segments - 1):
            t = (first, first + k, first + k + 1)
            triangles.append(t if sign > 0 else t[::-1])
    return vertices, triangles


# ---------------------------------------------------------------- placing

def place(solid, rotation=None, offset=(0.0, 0.0, 0.0)):
    """Rotates by a 3x3 row matrix, then moves."""
    vertices, triangles = solid

    def turned(v):
        return v if rotation is None else tuple(sum(row[k] * v[k] for k in range(3)) for row in rotation)

    return [(tuple(a + b for a, b in zip(turned(p), offset)), turned(n)) for p, n in vertices], triangles


def move(solid, x=0.0, y=0.0, z=0.0):
    return place(solid, None, (x, y, z))


def turn_z(solid, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return place(solid, ((c, -s, 0), (s, c, 0), (0, 0, 1)))


def along_x(solid):
    """Turns the z axis onto the x axis."""
    return place(solid, ((0, 0, 1), (1, 0, 0), (0, 1, 0)))


def along_y(solid):
    """Turns the z axis onto the y axis."""
    return place(solid, ((1, 0, 0), (0, 0, 1), (0, -1, 0)))


def mirror_x(solid):
    vertices, triangles = solid
    return [((-p[0], p[1], p[2]), (-n[0], n[1], n[2])) for p, n in vertices], [t[::-1] for t in triangles]


# ---------------------------------------------------------------- parts

class Part:
    """A coloured collection of closed solids: one link of a machine."""

    def __init__(self):
        self.vertices, self.triangles = [], []

    def add(self, colour, *solids):
        for solid in solids:
            check_closed(solid)
            first = len(self.vertices)
            merged, where = {}, []
            for p, n in solid[0]:
                key = struct.pack("<6f", *p, *_unit(n))
                where.append(merged.setdefault(key, len(merged)))
            self.vertices += [key + struct.pack("<4B", *colour, 255) for key in merged]
            self.triangles += [tuple(first + where[k] for k in t) for t in solid[1]]

    def write_ply(self, path):
        header = ["ply", "format binary_little_endian 1.0", "comment generated by make_meshes.py, units mm",
                  f"element vertex {len(self.vertices)}"]
        header += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
        header += [f"property uchar {name}" for name in ("red", "green", "blue", "alpha")]
        header += [f"element face {len(self.triangles)}", "property list uchar int vertex_indices", "end_header"]
        with open(path, "wb") as file:
            file.write(("\n".join(header) + "\n").encode("ascii"))
            file.write(b"".join(self.vertices))
            file.write(b"".join(struct.pack("<B3i", 3, *t) for t in self.triangles))


def _unit(n):
    length = math.sqrt(sum(c * c for c in n))
    return tuple(c / length for c in n)


def check_closed(solid):
    """Every edge must be met once in each direction, and the volume must be positive: closed, outward."""
    vertices, triangles = solid
    key = [tuple(round(c, 5) for c in p) for p, _ in vertices]
    edges, volume = {}, 0.0
    for t in triangles:
        a, b, c = (vertices[k][0] for k in t)
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                   + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
        for i in range(3):
            p, q = key[t[i]], key[t[(i + 1) % 3]]
            if p != q:
                edges[p, q] = edges.get((p, q), 0) + 1
    if any(edges.get((q, p), 0) != n for (p, q), n in edges.items()):
        raise ValueError("a solid is not closed")
    if volume <= 0:
        raise ValueError("a solid is inside out")
