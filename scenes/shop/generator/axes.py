"""Jobs with rotary axes (CL data) and the one with two set-ups."""
import math

from . import solids
from .job import Fault, Job, Tool
from .nc import NEAR, SAFE, Program, face, holes, pocket, rows
from .plates import drill, end_mill, face_mill
from .solids import V, box, cone, cut, cylinder, cylinder_along, fuse, polygon


class ClData:
    """CL data: tip and tool axis in the work frame."""

    def __init__(self, title):
        self.lines = [f"PARTNO/{title.upper()}", "UNITS/MM", "MULTAX/ON"]
        self.marks = {}

    def raw(self, text):
        self.lines.append(text)

    def mark(self, name):
        line = len(self.lines) + 1
        first, _ = self.marks.get(name, (line, line))
        self.marks[name] = (first, line)

    def mark_end(self, name):
        self.marks[name] = (self.marks[name][0], len(self.lines))

    def tool(self, number, rpm):
        self.lines += [f"LOADTL/{number}", f"SPINDL/{rpm},CLW"]

    def feed(self, f):
        self.lines.append(f"FEDRAT/{f},MMPM")

    def goto(self, tip, axis, rapid=False):
        if rapid:
            self.lines.append("RAPID")
        length = math.sqrt(sum(c * c for c in axis))
        words = [f"{c:.6f}" for c in tip] + [f"{c / length:.12f}" for c in axis]
        self.lines.append("GOTO/" + ",".join(words))

    def end(self):
        self.lines += ["SPINDL/OFF", "FINI"]


def along(point, axis, length):
    return tuple(p + length * a for p, a in zip(point, axis))


# -- 8 ------------------------------------------------------------------------------------------------------------
def ruled_wall_flank():
    t1 = Tool(1, "END MILL D25", 25, 50, length=95, holder=40)
    draft = math.radians(15)
    foot, high, half = 20.0, 20.0, 20.0
    slope = math.tan(draft)
    top = foot - high * slope

    def part():
        bar = polygon([(-half, -foot, -high), (-half, foot, -high), (-half, top, 0), (-half, -top, 0)],
                      (2 * half, 0, 0))
        return fuse(bar, *[cone(x, 0, -high, foot, 0, top) for x in (-half, half)])

    def program(fault):
        p = ClData("ruled wall by the flank")
        p.tool(1, 4000)

        def at(x, angle, out=0.0):
            c, s = math.cos(angle), math.sin(angle)
            axis = (-math.sin(draft) * c, -math.sin(draft) * s, math.cos(draft))
            normal = (math.cos(draft) * c, math.cos(draft) * s, math.sin(draft))
            tip = along((x + foot * c, foot * s, -high), axis, -3.0)
            return along(tip, normal, t1.d / 2 + out), axis

        start, axis = at(0, -math.pi / 2, 30)
        p.goto(along(start, axis, 60), axis)
        p.goto(start, axis, rapid=True)
        p.feed(1000)
        p.mark("wall")
        p.goto(*at(0, -math.pi / 2))
        steps = 360
        for x, first in ((-half, -math.pi / 2), (half, -3 * math.pi / 2)):  # clockwise: climb
            for k in range(steps + 1):
                p.goto(*at(x, first - math.pi * k / steps))
        p.goto(*at(0, -math.pi / 2))
        p.mark_end("wall")
        p.goto(start, axis)
        p.goto(along(start, axis, 60), axis, rapid=True)
        p.end()
        return p

    Job("ruled_wall_flank", "Ruled wall of 15 degrees by the flank, five axes", part,
        ((-46, -26, -20), (46, 26, 0)), [t1], program,
        Fault("excess", 12, (0, -17.32, -10), "wall", "the tool is 24 um thinner than it was measured",
              ["tool[0].diameter_mm=24.976"]), machine="lin_koren_xyzab", kind="cl",
        setup="work_origin_mm = [8, 96, 160] # 40 mm above the table")


# -- 20 -----------------------------------------------------------------------------------------------------------
def stepped_shaft():
    t1 = Tool(1, "END MILL D16", 16, 30, length=60)

    def part():
        return fuse(cylinder(0, 0, 0, 45, 20), cylinder(0, 0, 45, 65, 15), cylinder(0, 0, 65, 80, 10))

    def program(fault):
        p = ClData("stepped shaft by a rotary axis")
        p.tool(1, 3000)
        turn = 0

        def at(rho, z, quarter):
            c, s = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarter % 4]
            return (rho * c, rho * s, z), (c, s, 0)

        p.goto(*at(40, 90, 0))
        p.feed(800)
        for rho, heights in ((15.0, (83, 73, 63, 53)), (10.0, (83, 73))):
            if fault and rho == 15:
                rho = 15.012
            p.goto(*at(40, heights[0] + 10, turn), rapid=True)
            p.goto(*at(rho, heights[0] + 10, turn))
            for z in heights:
                p.mark(f"step {rho:.0f}")
                p.goto(*at(rho, z, turn))
                for _ in range(4):
                    turn += 1
                    p.goto(*at(rho, z, turn))
            p.mark_end(f"step {rho:.0f}")
            p.goto(*at(40, heights[-1], turn))
        p.end()
        return p

    Job("stepped_shaft_4axis", "Stepped shaft by a rotary axis", part, None, [t1], program,
        Fault("excess", 12, (15, 0, 55), "step 15", "the middle step is 12 um too thick in radius"),
        machine="head_table_bc", kind="cl", setup="work_origin_mm = [0, 0, 200]",
        stock_text="cylinder = { diameter_mm = 40, length_mm = 80 }", extra='[interpolator]\nmode = "joint"',
        notes=["B stands at 90 degrees and C turns the shaft under the end of the tool: blocks of a quarter turn are",
               "exact in joint mode."])


# -- 21 -----------------------------------------------------------------------------------------------------------
def five_sided_block():
    t1 = Tool(1, "END MILL D20", 20, 30, length=75)
    t2 = Tool(2, "END MILL D10", 10, 25, length=70, holder=32)
    sides = [(0, -1), (1, 0), (0, 1), (-1, 0)]  # A tilts the first one up without a turn of B

    def part():
        tools = [cylinder_along((26 * c, 26 * s, -20), (-c, -s, 0), 9, 5) for c, s in sides]
        return cut(box(-25, -25, -40, 25, 25, 0), cylinder(0, 0, -8, 1, 5), *tools)

    def program(fault):
        p = ClData("five sided block")
        up = (0, 0, 1)
        p.tool(1, 3000)
        p.goto((-40, -19, 60), up)
        p.goto((-40, -19, 3), up, rapid=True)
        p.feed(800)
        p.goto((-40, -19, 0), up)
        for k, y in enumerate((-19, -6, 6, 19)):
            p.goto((-40 if k % 2 == 0 else 40, y, 0), up)
            p.goto((40 if k % 2 == 0 else -40, y, 0), up)
        p.goto((-40, 19, 80), up, rapid=True)
        for k, (c, s) in enumerate(sides):
            def at(out, u, z, c=c, s=s):
                return out * c - u * s, out * s + u * c, z
            axis, out = (c, s, 0), 25 - (0.008 if fault and k == 2 else 0)
            p.goto(at(120, -40, 80), axis, rapid=True)
            p.goto(at(30, -40, -36), axis, rapid=True)
            p.mark(f"side {k}")
            p.goto(at(out, -40, -36), axis)
            for row, z in enumerate((-36, -22, -8)):
                p.goto(at(out, -40 if row % 2 == 0 else 40, z), axis)
                p.goto(at(out, 40 if row % 2 == 0 else -40, z), axis)
            p.mark_end(f"side {k}")
            p.goto(at(120, 40, 80), axis, rapid=True)
        p.tool(2, 4000)
        p.goto((0, 0, 80), up, rapid=True)
        p.goto((0, 0, 3), up, rapid=True)
        p.feed(200)
        p.goto((0, 0, -8), up)
        p.goto((0, 0, 80), up, rapid=True)
        for c, s in reversed(sides):
            axis = (c, s, 0)
            p.goto((120 * c, 120 * s, 80), axis, rapid=True)
            p.goto((28 * c, 28 * s, -20), axis, rapid=True)
            p.goto((17 * c, 17 * s, -20), axis)
            p.goto((120 * c, 120 * s, -20), axis, rapid=True)
            p.goto((120 * c, 120 * s, 80), axis, rapid=True)
        p.end()
        return p

    Job("five_sided_block", "Block machined from five sides", part, ((-26, -26, -40), (26, 26, 1)), [t1, t2], program,
        Fault("gouge", 8, (10, 25, -10), "side 2", "one side is faced 8 um too deep"),
        machine="mikron_ucp710", kind="cl")


# -- 22 -----------------------------------------------------------------------------------------------------------
def inclined_holes():
    t1 = drill(1, 8, 60)
    lean, side = math.radians(30), math.radians(20)
    one, other = (math.sin(lean), 0, math.cos(lean)), (0, math.sin(side), math.cos(side))
    places = [((-10, -12), one), ((-10, 12), one), ((15, -12), one), ((15, 12), one), ((32, 0), other)]

    def part():
        tools = [cylinder_along(along((x, y, 0), axis, 10), tuple(-c for c in axis), 60, 4)
                 for (x, y), axis in places]
        return cut(box(-40, -25, -25, 40, 25, 0), *tools)

    def program(fault):
        p = ClData("inclined holes")
        p.tool(1, 2500)
        p.goto((0, 0, 60), (0, 0, 1))
        p.feed(300)
        for k, ((x, y), axis) in enumerate(places):
            y += 0.015 if fault and k == 2 else 0
            p.goto(along((x, y, 0), axis, 40), axis, rapid=True)
            p.goto(along((x, y, 0), axis, 6), axis, rapid=True)
            p.mark(f"hole {k}")
            p.goto(along((x, y, 0), axis, -36), axis)
            p.goto(along((x, y, 0), axis, 40), axis, rapid=True)
        p.end()
        return p

    Job("inclined_holes", "Inclined holes", part, ((-40, -25, -25), (40, 25, 0)), [t1], program,
        Fault("gouge", 15, along((15, -8, 0), one, -14), "hole 2", "the third hole stands 15 um beside its place"),
        machine="lin_koren_xyzab", kind="cl")


# -- 23 -----------------------------------------------------------------------------------------------------------
def impeller_pocket():
    t1 = Tool(1, "BALL MILL D8", 8, 40, shape="ball", length=80, holder=32)
    lean, hub, r, wide = math.radians(15), 40.0, 4.0, 12.0
    w, n = (-math.sin(lean), math.cos(lean)), (math.cos(lean), math.sin(lean))  # up along the walls; to the right

    def fillet(side, spare=0.0, gap=0.0):
        """Middle of the fillet beside the right (1) or left (-1) wall: r from the wall, hub + r from the hub's axis,
        which lies at (0, -60); spare farther from the hub and gap farther from the wall for roughing."""
        y, z = side * wide - side * (r + gap) * n[0], -20 - side * (r + gap) * n[1]
        b = y * w[0] + (z + 60) * w[1]
        c = y * y + (z + 60) ** 2 - (hub + r + spare) ** 2
        t = -b + math.sqrt(b * b - c)
        return y + t * w[0], z + t * w[1]

    right, left = fillet(1), fillet(-1)
    angles = [math.atan2(c[0], c[1] + 60) for c in (left, right)]  # from the vertical through the hub's axis

    def part():
        def at(y, z):
            return V(-40, y, z)

        def edge(kind, *points):
            return getattr(solids.Part, kind)(*[at(*p) for p in points]).toShape()

        def rim(side):
            t = (1 + 20) / w[1]
            return side * wide + t * w[0], -20 + t * w[1]

        def ends(c, side):
            on_wall = (c[0] + side * r * n[0], c[1] + side * r * n[1])
            k = hub / (hub + r)
            on_hub = (c[0] * k, (c[1] + 60) * k - 60)
            my, mz = on_wall[0] + on_hub[0] - 2 * c[0], on_wall[1] + on_hub[1] - 2 * c[1]
            k = r / math.hypot(my, mz)
            return on_wall, (c[0] + my * k, c[1] + mz * k), on_hub

        a, b = ends(left, -1), ends(right, 1)
        middle = sum(angles) / 2
        crest = (hub * math.sin(middle), hub * math.cos(middle) - 60)
        edges = [edge("LineSegment", rim(-1), a[0]), edge("Arc", *a), edge("Arc", a[2], crest, b[2]),
                 edge("Arc", b[2], b[1], b[0]), edge("LineSegment", b[0], rim(1)),
                 edge("LineSegment", rim(1), rim(-1))]
        channel = solids.Part.Face(solids.Part.Wire(edges)).extrude(V(80, 0, 0))
        return cut(box(-30, -40, -40, 30, 40, 0), channel)

    def program(fault):
        p = ClData("channel between two blades")
        axis = (0, w[0], w[1])
        p.tool(1, 8000)

        def at(x, c):
            return along((x, c[0], c[1]), axis, -r)

        def on_hub(angle, spare=0.0):
            reach = hub + r + spare
            return reach * math.sin(angle), reach * math.cos(angle) - 60

        p.goto((-45, 0, 60), axis)
        p.feed(1200)
        # Down in three layers, then the floor in rows 0.4 mm apart, the outermost ones along the walls.
        for spare in (15.0, 8.0, 0.6):
            ends = [math.atan2(c[0], c[1] + 60) for c in (fillet(-1, spare, 0.5), fillet(1, spare, 0.5))]
            across = rows(*ends, 0.08)
            p.goto(along(at(-45, on_hub(across[0], spare)), axis, 40), axis, rapid=True)
            for k, angle in enumerate(across):
                p.goto(at(-45 if k % 2 == 0 else 45, on_hub(angle, spare)), axis)
                p.goto(at(45 if k % 2 == 0 else -45, on_hub(angle, spare)), axis)
            p.goto(along(at(45 if len(across) % 2 else -45, on_hub(across[-1], spare)), axis, 40), axis, rapid=True)
        across = rows(angles[0], angles[1], 0.4 / hub)
        p.goto(along(at(-45, left), axis, 40), axis, rapid=True)
        for k, angle in enumerate(across):
            c = on_hub(angle)
            if k == len(across) - 1:
                p.mark("right wall")
                c = (c[0] + 0.01 * n[0], c[1] + 0.01 * n[1]) if fault else c
            p.goto(at(-45 if k % 2 == 0 else 45, c), axis)
            p.goto(at(45 if k % 2 == 0 else -45, c), axis)
        p.mark_end("right wall")
        p.goto(along(at(45 if len(across) % 2 else -45, right), axis, 40), axis, rapid=True)
        p.end()
        return p

    t = 12 / w[1]
    Job("impeller_pocket", "Channel between two leaning blades on a hub", part, ((-30, -40, -40), (30, 40, 0)), [t1],
        program,
        Fault("gouge", 10, (0, wide + t * w[0], -20 + t * w[1]), "right wall",
              "the row along one wall is 10 um too far out"),
        machine="lin_koren_xyzab", kind="cl",
        notes=["Rows 0.4 mm apart on the hub leave 5.5 um."])


# -- 24 -----------------------------------------------------------------------------------------------------------
def two_setups_turned():
    t1, t2, t3, t4 = face_mill(), end_mill(2, 10, 25), drill(3, 8, 45), end_mill(4, 14, 20)
    places = [(-34, 0), (34, 0)]

    def part():
        """In the work frame of the second set-up: the pocket looks down."""
        tools = [cylinder(x, y, -21, 1, 4) for x, y in places] + [cylinder(x, y, -5, 1, 7) for x, y in places]
        pocket_solid = solids.rounded(0, 0, 50, 30, 6, -21, -12)
        return cut(box(-45, -25, -20, 45, 25, 0), pocket_solid, *tools)

    def program(fault):
        p = Program("first side", 1024)
        face(p, t1, -45, -25, 45, 25, 0)
        p.change(t2, 0, 0, 5000)
        pocket(p, t2, 0, 0, 50, 30, 6, 0, -8, 4)
        marks = dict(p.marks)
        p.change(t3, *places[0], 2500)
        holes(p, "G83", places, -25, q=4, f=300)
        p.marks = marks
        p.end()
        return p

    def turned_over(path):
        p = Program("turned over", 2024)
        face(p, t1, -45, -25, 45, 25, 0)
        p.change(t4, *places[0], 2000)
        holes(p, "G82", places, -5, dwell=300, f=150)
        p.end()
        path.write_text("\n".join(p.lines) + "\n")

    scene = """# Faced, pocketed and drilled in the first set-up; turned over, faced and counterbored in the second.
# Against the mesh, whose facets err by up to 5 um: --set 'setup[1].design={mesh="part.stl"}' \
--set setup[1].accept.gouge_max_um=7 --set setup[1].accept.excess_max_um=15
title = "Two set-ups, turned over"

[stock] # in the work frame of the first set-up
box_mm = [[-45, -25, -21], [45, 25, 1]]

[movie]
seconds = 0

[[setup]]
name = "first side"
machine = "mill_3axis"
nc = "part.nc"
work_origin_mm = "on_table"

[[setup]]
name = "turned over"
part_pose = { position_mm = [0, 0, -20], rotation_deg = [180, 0, 0] } # the first one's work frame in this one
machine = "mill_3axis"
nc = "turned_over.nc"
work_origin_mm = "on_table"

[setup.design]
step = "part.step"

[setup.accept]
gouge_max_um = 2
excess_max_um = 10

"""
    scene += "\n\n".join(tool.text() for tool in (t1, t2, t3, t4)) + "\n"
    head, tools = scene.split("[[setup]]", 1)[0], scene[scene.index("[[tool]]"):]
    middle = scene[len(head):scene.index("[[tool]]")]
    Job("two_setups_turned", "Two set-ups, turned over", part, None, [], program,
        Fault("excess", 15, (0, 0, -12), ("wall floor", "wall", "face"),
              "the zero of the second set-up is 15 um too high, so that the part lies too low",
              ["setup[1].part_pose={position_mm=[0,0,-20.015],rotation_deg=[180,0,0]}"]),
        scene_text=head + tools + "\n" + middle.rstrip() + "\n", files={"turned_over.nc": turned_over})


for make in (ruled_wall_flank, stepped_shaft, five_sided_block, inclined_holes, impeller_pocket, two_setups_turned):
    make()
