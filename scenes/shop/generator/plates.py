"""Ten plain jobs on three axes."""
import math

from .job import Fault, Job, Tool
from .nc import (NEAR, SAFE, Program, circle_inside, contour_inside, contour_outside, face, holes, levels, pocket, rows,
                 zigzag)
from .solids import box, cone, cut, cylinder, cylinder_along, fuse, one_solid, polygon, prism, rounded, V
from . import solids


def face_mill(number=1, d=50):
    return Tool(number, f"FACE MILL D{d:g}", d, 12, length=60, shank=22, holder=50)


def end_mill(number, d, flutes, **keys):
    return Tool(number, f"END MILL D{d:g}", d, flutes, **keys)


def drill(number, d, flutes, angle=118):
    return Tool(number, f"DRILL D{d:g}", d, flutes, shape="drill", length=flutes + 15, holder=32,
                point_angle_deg=angle)


def chamfer_mill(number, d, angle=90, tip=0.0, flutes=None, length=60):
    return Tool(number, f"CHAMFER MILL D{d:g} {angle:g} DEG", d, flutes or d, shape="chamfer", length=length,
                holder=32, point_angle_deg=angle, tip_diameter_mm=tip)


# -- 1 ------------------------------------------------------------------------------------------------------------
def pocket_two_levels():
    t1, t2 = face_mill(), end_mill(2, 8, 22)

    def part():
        return cut(box(-45, -30, -25, 45, 30, 0), rounded(0, 0, 70, 40, 6, -8, 1), rounded(0, 0, 40, 20, 5, -16, 0))

    def program(fault):
        p = Program("pocket in two levels", 1001)
        face(p, t1, -45, -30, 45, 30, 0)
        p.change(t2, 0, 0, 6000)
        pocket(p, t2, 0, 0, 70, 40, 6, 0, -8, 4, name="upper")
        pocket(p, t2, 0, 0, 40, 20, 5, -8, -16, 4, name="lower")
        p.end()
        return p

    Job("pocket_two_levels", "Pocket with corner radii in two levels", part, ((-45, -30, -25), (45, 30, 1)),
        [t1, t2], program,
        Fault("gouge", 10, (35, 0, -4), ("upper", "lower"), "the tool is 20 um thicker than it was measured",
              ["tool[1].diameter_mm=8.02"]))


# -- 2 ------------------------------------------------------------------------------------------------------------
def outer_contour_g41():
    t1, t2 = face_mill(), end_mill(2, 16, 32)

    def part():
        return fuse(box(-48, -33, -25, 48, 33, -15), rounded(0, 0, 80, 50, 8, -15, 0))

    def program(fault):
        p = Program("outer contour with g41", 1002)
        face(p, t1, -48, -33, 48, 33, 0)
        p.change(t2, 66, 0, 4000)
        p.rapid(z=NEAR)
        for z in levels(0, -15, 5):  # roughing in climb, .3 mm left, the centre programmed
            p.rapid(0, -35 - 12)
            p.line(z=z, f=300)
            p.line(0, -33.3, f=700)
            p.rounded_contour(0, 0, 96.6, 66.6, 16.3, False, 700, start=False)
            p.line(0, -47)
        # Finishing: the contour itself, the control compensates.
        wall = 40.015 if fault else 40.0
        p.rapid(14, -49)
        p.line(z=-15, f=300)
        p.raw("G41 D2")
        p.line(14, -39, f=500)
        p.arc(True, 0, -25, -14, 0, f=400)
        p.line(-32, -25)
        p.arc(False, -40, -17, 0, 8)
        p.line(-40, 17)
        p.arc(False, -32, 25, 8, 0)
        p.line(wall - 8, 25)
        p.arc(False, wall, 17, 0, -8)
        p.mark("right wall")
        p.line(wall, -17)
        p.arc(False, wall - 8, -25, -8, 0)
        p.line(0, -25)
        p.arc(True, -14, -39, 0, -14)
        p.raw("G40")
        p.line(-14, -49)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("outer_contour_g41", "Outer contour with G41, lead-in and lead-out arcs", part,
        ((-48, -33, -25), (48, 33, 1)), [t1, t2], program,
        Fault("excess", 15, (40, 0, -7), "right wall", "the right wall is programmed 15 um too far out"))


# -- 3 ------------------------------------------------------------------------------------------------------------
def drilled_plate_countersinks():
    t1, t2, t3, t4 = face_mill(), drill(2, 6.6, 40), drill(3, 8, 45), chamfer_mill(4, 16)
    screws = [(x, y) for x in (-36, 0, 36) for y in (-20, 20)]
    plain = [(x, 0) for x in (-36, -18, 18, 36)]

    def part():
        tools = [cylinder(x, y, -13, 1, 3.3) for x, y in screws] + [cylinder(x, y, -13, 1, 4) for x, y in plain]
        tools += [cone(x, y, -6.3, 0, 1, 7.3) for x, y in screws]
        return cut(box(-50, -32, -12, 50, 32, 0), *tools)

    def program(fault):
        p = Program("drilled plate with countersinks", 1003)
        face(p, t1, -50, -32, 50, 32, 0)
        p.change(t2, *screws[0], 3000)
        moved = [(x + (0.02 if fault and k == 3 else 0), y) for k, (x, y) in enumerate(screws)]
        holes(p, "G83", moved, -15, q=4, f=300)
        marks = dict(p.marks)
        p.change(t3, *plain[0], 2500)
        holes(p, "G83", plain, -15.5, q=4, f=300)
        p.change(t4, *screws[0], 1500)
        holes(p, "G82", screws, -6.3, dwell=200, f=150)
        p.marks = marks
        p.end()
        return p

    Job("drilled_plate_countersinks", "Drilled plate with countersinks", part, ((-50, -32, -12), (50, 32, 1)),
        [t1, t2, t3, t4], program,
        Fault("gouge", 20, (0 + 3.3, 20, -8), "hole 3", "the fourth hole is drilled 20 um beside its place"),
        chord_um=10)


# -- 4 ------------------------------------------------------------------------------------------------------------
def helical_bore():
    t1, t2 = face_mill(), end_mill(2, 16, 40)

    def part():
        return cut(box(-40, -40, -30, 40, 40, 0), cylinder(0, 0, -31, 1, 16), cylinder(0, 0, -10, 1, 22))

    def program(fault):
        p = Program("helical bore and finishing circle", 1004)
        face(p, t1, -40, -40, 40, 40, 0)
        p.change(t2, 7.8, 0, 4000)
        p.rapid(z=NEAR)
        p.line(z=0.5, f=400)
        p.helix(0, 0, 7.8, 0.5, -31, 3, 800)
        p.circle(0, 0, 7.8, f=800)
        p.line(6, 0)
        p.rapid(z=NEAR)
        p.rapid(13.7, 0)
        p.line(z=0.5, f=400)
        p.helix(0, 0, 13.7, 0.5, -10, 3, 800)
        p.circle(0, 0, 13.7, f=800)
        p.line(10, 0)
        p.rapid(z=NEAR)
        circle_inside(p, t2, 0, 0, 22, -10, 0, name="counterbore")
        circle_inside(p, t2, 0, 0, 15.988 if fault else 16, -31, 0, name="bore")
        p.end()
        return p

    Job("helical_bore", "Helical bore, counterbore and finishing circles", part, ((-40, -40, -30), (40, 40, 1)),
        [t1, t2], program,
        Fault("excess", 12, (16, 0, -20), "bore", "the finishing circle is 12 um too small in radius"))


# -- 5 ------------------------------------------------------------------------------------------------------------
def slot_ramped():
    t1, t2 = face_mill(), end_mill(2, 12, 28)

    def part():
        return cut(box(-50, -25, -20, 50, 25, 0), rounded(0, 0, 76, 16, 8, -12, 1))

    def program(fault):
        p = Program("slot with round ends ramped", 1005)
        face(p, t1, -50, -25, 50, 25, 0)
        deep = -12.011 if fault else -12.0
        p.change(t2, -30, 0, 4500)
        p.rapid(z=NEAR)
        p.line(z=0, f=400)
        for k, z in enumerate(levels(0, -12, 2)):  # down along the slot, one ramp each way
            p.line(30 if k % 2 == 0 else -30, 0, -11.8 if z == -12 else z, f=700)
        p.line(-30 if p.at["X"] == "X30." else 30, 0)
        p.rapid(z=NEAR)
        contour_inside(p, t2, 0, 0, 76, 16, 8, deep, 0, name="wall", clear=False)
        p.rapid(-30, 0)
        p.rapid(z=-9)
        p.line(z=deep, f=200)
        p.mark("floor")
        p.line(30, 0, f=500)
        p.rapid(z=SAFE)
        p.marks["wall"] = (p.marks["wall"][0] - 1, p.marks["wall"][1] + 1)  # arcs in and out reach the floor too
        p.end()
        return p

    Job("slot_ramped", "Slot with round ends, ramped", part, ((-50, -25, -20), (50, 25, 1)), [t1, t2], program,
        Fault("gouge", 11, (0, 0, -12), ("floor", "wall"), "the floor is 11 um too deep"))


# -- 10 -----------------------------------------------------------------------------------------------------------
def counterbores_pecked():
    t1, t2, t3 = face_mill(), drill(2, 6.6, 45), end_mill(3, 11, 20)
    places = [(-33, -18), (33, -18), (33, 18), (-33, 18), (0, 0)]

    def part():
        tools = []
        for x, y in places:
            tools += [cylinder(x, y, -21, 1, 3.3), cylinder(x, y, -6.5, 1, 5.5)]
        return cut(box(-45, -30, -20, 45, 30, 0), *tools)

    def program(fault):
        p = Program("counterbores over pecked holes", 1010)
        face(p, t1, -45, -30, 45, 30, 0)
        p.change(t2, *places[0], 3000)
        holes(p, "G83", places, -23, q=3, f=300)
        p.change(t3, *places[0], 1800)
        deep = [(x, y, -6.515 if fault and k == 2 else -6.5) for k, (x, y) in enumerate(places)]
        p.marks = {}
        holes(p, "G82", deep, -6.5, dwell=300, f=120)
        p.end()
        return p

    Job("counterbores_pecked", "Counterbores over pecked holes", part, ((-45, -30, -20), (45, 30, 1)),
        [t1, t2, t3], program,
        Fault("gouge", 15, (33 + 4.4, 18, -6.5), "hole 2", "the third counterbore is 15 um too deep"))


# -- 9 ------------------------------------------------------------------------------------------------------------
def chamfer_contour():
    t1, t2, t3 = face_mill(), end_mill(2, 16, 30), chamfer_mill(3, 10, tip=1, flutes=8)

    def part():
        solid = fuse(box(-48, -33, -25, 48, 33, -12), rounded(0, 0, 80, 50, 8, -12, 0))
        edges = [e for e in solid.Edges if all(abs(v.Z) < 1e-9 for v in e.Vertexes)]
        return solid.makeChamfer(2.0, edges)

    def program(fault):
        p = Program("chamfer along a contour", 1009)
        face(p, t1, -48, -33, 48, 33, 0)
        p.change(t2, 4, -49, 4000)
        p.rapid(z=NEAR)
        for z in levels(0, -12, 6):
            contour_outside(p, t2, 0, 0, 80.6, 50.6, 8.3, z, 0, 700, name="rough", lead=10)
        contour_outside(p, t2, 0, 0, 80, 50, 8, -12, 0, 400, name="wall", lead=10)
        # The chamfer's lower edge is cut 1 mm above the tool's tip, where its radius is 1.5.
        p.change(t3, 6, -40, 6000)
        p.rapid(z=NEAR)
        z = -2.98 if fault else -3.0
        p.rapid(3, -29.5)
        p.line(z=z, f=400)
        p.arc(True, 0, -26.5, -3, 0, f=800)
        p.mark("chamfer")
        p.rounded_contour(0, 0, 83, 53, 9.5, False, 800, start=False)
        p.mark_end("chamfer")
        p.arc(True, -3, -29.5, 0, -3)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("chamfer_contour", "Chamfer of 45 degrees along a contour", part, ((-48, -33, -25), (48, 33, 1)),
        [t1, t2, t3], program,
        Fault("excess", 20 * math.sqrt(0.5), (39, 0, -1), "chamfer", "the chamfer mill runs 20 um too high"))


# -- 11 -----------------------------------------------------------------------------------------------------------
def island_pocket():
    t1, t2 = face_mill(), end_mill(2, 10, 25)

    def part():
        solid = cut(box(-50, -35, -22, 50, 35, 0), rounded(0, 0, 84, 54, 7, -10, 1))
        return fuse(solid, cylinder(0, 0, -11, 0, 9))

    def program(fault):
        p = Program("pocket with an island", 1011)
        face(p, t1, -50, -35, 50, 35, 0)
        p.change(t2, 0, 0, 5000)
        r, clear = 5, 9 + 5 + 0.4
        half_w, half_h = 42 - r - 0.9, 27 - r - 0.9
        for z in levels(0, -10, 5):
            for k, y in enumerate(rows(-half_h, half_h, 1.4 * r)):
                gap = math.sqrt(max(0.0, clear * clear - y * y))
                spans = [(-half_w, half_w)] if gap == 0 else [(-half_w, -gap), (gap, half_w)]
                for a, b in spans:
                    p.rapid(a, y)
                    p.rapid(z=z + 5 + NEAR)
                    p.line(z=z, f=300)
                    p.line(b, y, f=700)
                    p.rapid(z=NEAR)
            p.rapid(18, 6)
            p.line(z=z, f=300)
            p.line(clear, 0, f=500)
            p.circle(0, 0, clear, False, f=700)
            p.line(19, 0)
            p.rapid(z=NEAR)
        contour_inside(p, t2, 0, 0, 84, 54, 7, -10, 0, name="wall")
        ring = 13.994 if fault else 14.0
        p.rapid(ring + 4, -4)
        p.rapid(z=-8)
        p.line(z=-10, f=300)
        p.line(ring, 0, f=400)
        p.mark("island")
        p.circle(0, 0, ring, False, f=400)
        p.line(ring + 4, 4)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("island_pocket", "Pocket with an island", part, ((-50, -35, -22), (50, 35, 1)), [t1, t2], program,
        Fault("gouge", 6, (9, 0, -5), "island", "the ring around the island is 6 um too small in radius"))


# -- 7 ------------------------------------------------------------------------------------------------------------
def chords(radius, low, high, tolerance):
    """Points (angle, distance) of lines around a circle from angle to angle, tangent to it: they never cut into it,
    and their ends, all but the first and the last, stand off by the tolerance."""
    step = 2 * math.acos(radius / (radius + tolerance))
    count = math.ceil((high - low) / step)
    step = (high - low) / count
    ends = [(low, radius)] + [(low + (k + 0.5) * step, radius / math.cos(step / 2)) for k in range(count)]
    return ends + [(high, radius)]


def cap_ball():
    t1 = end_mill(1, 16, 30)
    t2 = Tool(2, "BALL MILL D10", 10, 25, shape="ball", length=60)
    radius, half, overrun = 40.0, 15.0, 2.2

    def part():
        sphere = solids.Part.makeSphere(radius, V(0, 0, -radius))
        return solids.tidy(box(-half, -half, -25, half, half, 1).common(sphere))

    def row(p, y, reach, side, f):
        """A row over the cap in lines, the ball's centre outside of the circle that it follows."""
        a = math.sqrt(reach * reach - y * y)
        wide = math.asin((half + 4) / a)
        for angle, distance in chords(a, -wide, wide, 0.002):
            p.line(side * distance * math.sin(angle), y, distance * math.cos(angle) - radius - 5, f=f)

    def program(fault):
        p = Program("spherical cap by a ball", 1007)
        p.change(t1, -30, -17, 3500)
        # Terraces: rows along X, each at the height that the cap has where the row is nearest to its middle.
        for y in rows(-17, 17, 4):
            near = max(0.0, abs(y) - 8)
            p.rapid(-26, y)
            p.rapid(z=NEAR)
            p.line(z=round(math.sqrt(radius ** 2 - near ** 2) - radius + 0.3, 3), f=400)
            p.line(26, y, f=800)
            p.rapid(z=NEAR)
        p.change(t2, -24, -half, 9000)
        for allowance, spacing in ((0.4, 2.4), (0.0, 0.4)):
            count = round(2 * (half + overrun) / spacing)
            for k in range(count + 1):
                y = round(-(half + overrun) + k * spacing, 4)
                reach = radius + 5 + allowance
                middle = allowance == 0 and abs(y) < 0.3
                if k == 0:
                    p.rapid(-24, y)
                    p.rapid(z=NEAR)
                if middle and "middle row" not in p.marks:
                    p.mark("middle row")
                row(p, y, reach - (0.008 if fault and middle else 0), 1 if k % 2 == 0 else -1, 1500)
                if middle:
                    p.mark_end("middle row")
            p.rapid(z=SAFE)
        p.end()
        return p

    def facets():
        """A grid of squares on the cap, its walls, and the bottom: OCC needs four times as many facets."""
        n, bottom = 34, -25.0
        at = [-half + 2 * half * k / n for k in range(n + 1)]

        def top(i, j):
            return V(at[i], at[j], math.sqrt(radius ** 2 - at[i] ** 2 - at[j] ** 2) - radius)

        def wall(a, b):
            low_a, low_b = V(a.x, a.y, bottom), V(b.x, b.y, bottom)
            return [(low_a, low_b, b), (low_a, b, a), (V(0, 0, bottom), low_b, low_a)]

        found = []
        for i in range(n):
            for j in range(n):
                a, b, c, d = top(i, j), top(i + 1, j), top(i + 1, j + 1), top(i, j + 1)
                found += [(a, b, c), (a, c, d)]
            found += wall(top(i, 0), top(i + 1, 0)) + wall(top(i + 1, n), top(i, n))
            found += wall(top(n, i), top(n, i + 1)) + wall(top(0, i + 1), top(0, i))
        return found

    # The scallop of rows s apart on a sphere is s^2 / 8 (1/r + 1/R), where s grows with the slope across the rows.
    Job("cap_ball", "Spherical cap by a ball, rows .4", part, ((-half, -half, -25), (half, half, 0.5)), [t1, t2],
        program,
        Fault("gouge", 8, (0, 0, 0), "middle row", "the middle row is 8 um too deep"),
        notes=["Rows 0.4 mm apart leave 4.5 um in the middle and 5.2 um at the corners, their chords 2 um more."],
        facets=facets, chord_um=8)


# -- 14 -----------------------------------------------------------------------------------------------------------
def keyway():
    t1 = end_mill(1, 10, 20)

    def part():
        shaft = cylinder_along((-40, 0, -20), (1, 0, 0), 80, 20)
        return cut(shaft, rounded(0, 0, 48, 12, 6, -5, 2))

    def program(fault):
        p = Program("keyway", 1014)
        p.change(t1, -18, 0, 3500)
        p.rapid(z=NEAR)
        for z in levels(0, -5, 2.5):
            p.line(-18, 0, f=200)
            p.line(z=z, f=150)
            p.line(18, 0, f=400)
            p.rapid(z=NEAR)
            p.rapid(-18, 0)
        r, top = 5, (1.009 if fault else 1.0)  # half width 6 less the tool's radius
        p.rapid(0, 0)
        p.line(z=-5, f=150)
        p.line(0, -1, f=300)
        p.line(18, -1)
        p.arc(True, 18, top, 0, (top + 1) / 2)
        p.mark("upper wall")
        p.line(-18, top)
        p.arc(True, -18, -1, 0, -(top + 1) / 2)
        p.line(0, -1)
        p.line(0, 0)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("keyway", "Keyway in a shaft", part, None, [t1], program,
        Fault("gouge", 9, (0, 6, -3), "upper wall", "one wall of the keyway is 9 um off"),
        stock_text="cylinder = { diameter_mm = 40, length_mm = 80, base_mm = [-40, 0, -20], axis = [1, 0, 0] }")


for make in (pocket_two_levels, outer_contour_g41, drilled_plate_countersinks, helical_bore, slot_ramped,
             counterbores_pecked, chamfer_contour, island_pocket, cap_ball, keyway):
    make()
