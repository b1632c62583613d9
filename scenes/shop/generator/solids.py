"""Solids of the parts by FreeCAD's Part workbench, and their files: STEP with exact faces, STL within a chord error."""
import math
import random
import re
import struct
import sys

sys.path.append("/usr/lib/freecad/lib")
import FreeCAD  # noqa: E402
import MeshPart  # noqa: E402
import Part  # noqa: E402

V = FreeCAD.Vector
CHORD_UM = 5.0  # greatest distance between the facets of part.stl and the faces of part.step


def box(x0, y0, z0, x1, y1, z1):
    return Part.makeBox(x1 - x0, y1 - y0, z1 - z0, V(x0, y0, z0))


def cylinder(x, y, z0, z1, r):
    return Part.makeCylinder(r, z1 - z0, V(x, y, z0))


def cylinder_along(start, direction, length, r):
    return Part.makeCylinder(r, length, V(*start), V(*direction))


def cone(x, y, z0, r0, z1, r1):
    return Part.makeCone(r0, r1, z1 - z0, V(x, y, z0))


def prism(wire_edges, z0, z1):
    face = Part.Face(Part.Wire(wire_edges))
    face.translate(V(0, 0, z0))
    return face.extrude(V(0, 0, z1 - z0))


def polygon(points, direction):
    """The prism over a plane polygon of points (x, y, z)."""
    wire = Part.makePolygon([V(*p) for p in points] + [V(*points[0])])
    return Part.Face(wire).extrude(V(*direction))


def rounded_edges(cx, cy, w, h, r):
    """Lines and arcs around a rectangle with round corners; lines of no length are left out (slots)."""
    x, y, k = w / 2, h / 2, math.sqrt(0.5) * r
    edges = []

    def line(a, b):
        if math.dist(a, b) > 1e-9:
            edges.append(Part.LineSegment(V(*a, 0), V(*b, 0)).toShape())

    def arc(a, m, b):
        edges.append(Part.Arc(V(*a, 0), V(*m, 0), V(*b, 0)).toShape())

    def corner(sx, sy, turned):
        centre = (cx + sx * (x - r), cy + sy * (y - r))
        ends = [(centre[0] + sx * r, centre[1]), (centre[0], centre[1] + sy * r)]
        if turned:
            ends.reverse()
        arc(ends[0], (centre[0] + sx * k, centre[1] + sy * k), ends[1])

    line((cx - x + r, cy - y), (cx + x - r, cy - y))
    corner(1, -1, True)
    line((cx + x, cy - y + r), (cx + x, cy + y - r))
    corner(1, 1, False)
    line((cx + x - r, cy + y), (cx - x + r, cy + y))
    corner(-1, 1, True)
    line((cx - x, cy + y - r), (cx - x, cy - y + r))
    corner(-1, -1, False)
    return edges


def rounded(cx, cy, w, h, r, z0, z1):
    """A rectangle with round corners, as a prism with planes and cylinders."""
    return prism(rounded_edges(cx, cy, w, h, r), z0, z1)


def cut(shape, *tools):
    for tool in tools:
        shape = shape.cut(tool)
    return tidy(shape)


def fuse(*shapes):
    whole = shapes[0]
    for shape in shapes[1:]:
        whole = whole.fuse(shape)
    return tidy(whole)


def tidy(shape):
    return shape.removeSplitter()


def one_solid(shape):
    solids = shape.Solids
    assert len(solids) == 1 and solids[0].isValid() and solids[0].Volume > 0, f"{len(solids)} solids"
    return solids[0]


def write_step(shape, path, name):
    """AP214, with a head that tells nothing about when and where it was written."""
    shape.exportStep(str(path))
    text = path.read_text(encoding="latin-1")
    head = f"FILE_NAME('{name}','2020-01-01T00:00:00',(''),(''),'','','');"
    text = re.sub(r"FILE_NAME\(.*?\);", head, text, count=1, flags=re.S)
    text = re.sub(r"'Open CASCADE STEP translator [^']*'", f"'{name}'", text)
    path.write_text(text, encoding="latin-1")


def facets_of(shape, chord_mm):
    mesh = MeshPart.meshFromShape(Shape=shape, LinearDeflection=chord_mm, AngularDeflection=1.0, Relative=False)
    assert mesh.isSolid()
    return [tuple(V(*point) for point in facet.Points) for facet in mesh.Facets]


def chord_error(shape, facets, looks=400):
    """Greatest distance of facets' middles and of their edges' middles from the shape, mm, over a sample."""
    draw = random.Random(1)
    shell = shape.Shells[0] if shape.Shells else shape
    worst = 0.0
    for a, b, c in draw.sample(facets, min(looks, len(facets))):
        for place in ((a + b + c) * (1 / 3), (a + b) * 0.5, (b + c) * 0.5, (a + c) * 0.5):
            worst = max(worst, shell.distToShape(Part.Vertex(place))[0])
    return worst


def write_stl(shape, path, name, chord_um=CHORD_UM, facets=None):
    """Binary STL within chord_um of the faces: OCC is asked for the chord, less where its facets miss it."""
    ask = 1.5 * chord_um / 1000
    given, error = facets, math.inf
    while error > chord_um / 1000 and ask > 0.2 * chord_um / 1000:
        facets = given or facets_of(shape.copy(), ask)
        error = chord_error(shape, facets)
        ask *= 0.9
    assert error <= chord_um / 1000, f"{name}: facets err by {error} mm"
    volume = sum(a.dot(b.cross(c)) for a, b, c in facets) / 6
    assert abs(volume / shape.Volume - 1) < 0.01, f"{name}: volume {volume} of the facets, {shape.Volume} of the faces"
    with open(path, "wb") as file:
        file.write(name.encode()[:80].ljust(80, b" "))
        file.write(struct.pack("<I", len(facets)))
        for a, b, c in facets:
            n = (b - a).cross(c - a)
            if n.Length > 0:
                n.normalize()
            file.write(struct.pack("<12fH", n.x, n.y, n.z, *a, *b, *c, 0))
    return len(facets), error * 1000
