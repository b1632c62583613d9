"""Jobs on three axes with one special feature each: undercuts, drafts, grooves, engraving, bull nose, ball."""
import math

from . import solids
from .job import Fault, Job, Tool
from .nc import NEAR, SAFE, Program, circle_inside, contour_inside, face, holes, levels, pocket, rows, zigzag
from .plates import drill, end_mill, face_mill
from .solids import V, box, cone, cut, cylinder, fuse, polygon, rounded


# -- 6 ------------------------------------------------------------------------------------------------------------
def face_boss():
    t1, t2 = face_mill(), end_mill(2, 20, 30)

    def part():
        return fuse(box(-40, -40, -30, 40, 40, -12), cylinder(0, 0, -12, 0, 20))

    def program(fault):
        p = Program("boss with rings", 1006)
        face(p, t1, -40, -40, 40, 40, 0.013 if fault else 0)
        p.change(t2, 54, 0, 3500)
        p.rapid(z=NEAR)
        for z in levels(0, -12, 4):
            p.rapid(54, 0)
            p.line(z=z, f=500)
            for ring in (54, 42, 30.4):
                p.line(ring, 0, f=700)
                p.circle(0, 0, ring, False, f=700)
            p.line(32, 0)
            p.rapid(z=z + NEAR)
        p.rapid(34, 4)
        p.line(z=-12, f=300)
        p.line(30, 0, f=400)
        p.mark("ring")
        p.circle(0, 0, 30, False)
        p.line(34, -4)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("face_boss", "Face, rings round a boss, finishing ring", part, ((-40, -40, -30), (40, 40, 1)), [t1, t2],
        program, Fault("excess", 13, (0, 0, 0), "face", "the top is faced 13 um too high"))


# -- 13 -----------------------------------------------------------------------------------------------------------
def open_pocket_draft():
    t1 = face_mill()
    t2 = Tool(2, "TAPER MILL D8 3 DEG", 8, 16, shape="taper", taper_deg=3, length=50)
    slope = math.tan(math.radians(3))

    def part():
        top, rise = 1.0, 11.0 * slope
        along = polygon([(-19, -18, -10), (-19, 18, -10), (-19, 18 + rise, top), (-19, -18 - rise, top)], (65, 0, 0))
        across = polygon([(-25, -12, -10), (0, -12, -10), (0, -12, top), (-25 - rise, -12, top)], (0, 24, 0))
        corners = [cone(-19, y, -10, 6, top, 6 + rise) for y in (-12, 12)]
        return cut(box(-40, -30, -22, 40, 30, 0), fuse(along, across, *corners))

    def program(fault):
        p = Program("open pocket with draft", 1013)
        face(p, t1, -40, -30, 40, 30, 0)
        p.change(t2, 48, 13.5, 5000)
        p.rapid(z=NEAR)
        for z in levels(0, -10, 5):
            for k, y in enumerate(rows(-13.4, 13.4, 5.5)):
                if k == 0:
                    p.rapid(48, y)
                    p.line(z=z, f=300)
                p.line(y=y, f=600)
                p.line(-20.4 if k % 2 == 0 else 48)
            p.rapid(z=NEAR)
        corner = 2.05 if fault else 2.0
        p.rapid(48, 14)
        p.line(z=-10, f=300)
        p.line(-21 + corner, 14, f=400)
        p.mark("corner")
        p.arc(True, -21, 14 - corner, 0, -corner)
        p.line(-21, -12)
        p.arc(True, -19, -14, 2, 0)
        p.line(48, -14)
        p.rapid(z=SAFE)
        p.end()
        return p

    left = (math.sqrt(2) - 1) * 50 * math.cos(math.radians(3))
    reach = (6 + 5 * slope) * math.sqrt(0.5)
    Job("open_pocket_draft", "Open pocket with walls of 3 degrees draft, taper", part, ((-40, -30, -22), (40, 30, 1)),
        [t1, t2], program,
        Fault("excess", left, (-19 - reach, 12 + reach, -5), "corner", "one corner is programmed 50 um too round"))


# -- 14 -----------------------------------------------------------------------------------------------------------
def t_slot():
    t1, t2 = face_mill(), end_mill(2, 10, 28)
    t3 = Tool(3, "T SLOT CUTTER D18 X 8", 18, 8, shape="woodruff", width_mm=8, neck_diameter_mm=8,
              neck_length_mm=20, shank=16, length=60)

    def part():
        return cut(box(-40, -25, -30, 40, 25, 0), box(-41, -6, -22, 41, 6, 1), box(-41, -10, -22, 41, 10, -14))

    def program(fault):
        p = Program("t slot", 1012)
        face(p, t1, -40, -25, 40, 25, 0)
        p.change(t2, -48, -1, 4500)
        p.rapid(z=NEAR)
        for k, z in enumerate(levels(0, -22, 5.5)):
            p.rapid(-48, -0.8)
            p.line(z=z, f=800)
            p.line(48, -0.8, f=500)
            p.line(48, 0.8)
            p.line(-48, 0.8)
        p.line(-48, -1)
        p.mark("slot")
        p.line(48, -1, f=400)
        p.line(48, 1)
        p.line(-48, 1)
        p.mark_end("slot")
        p.rapid(z=NEAR)
        p.change(t3, -52, 0, 1500)
        p.rapid(z=-20)
        p.line(z=-22, f=300)
        p.mark("t slot")
        p.line(52, 0, f=150)
        p.line(52, 1)
        p.line(-52, 1)
        p.line(-52, -1)
        p.line(52, -1)
        p.mark_end("t slot")
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("t_slot", "T-slot", part, ((-40, -25, -30), (40, 25, 1)), [t1, t2, t3], program,
        Fault("gouge", 14, (0, 8, -14), "t slot", "the T-slot cutter is 14 um thicker than it was measured",
              ["tool[2].width_mm=8.014"]))


# -- 15 -----------------------------------------------------------------------------------------------------------
def thread_milled_bore():
    t1, t2 = face_mill(), end_mill(2, 12, 25)
    t3 = Tool(3, "THREAD MILL D12 P1.5", 12, 22)

    def part():
        return cut(box(-30, -30, -15, 30, 30, 0), cylinder(0, 0, -16, 1, 10))

    def program(fault):
        p = Program("thread milled bore", 1015)
        face(p, t1, -30, -30, 30, 30, 0)
        p.change(t2, 2.75, 0, 4500)
        p.rapid(z=NEAR)
        p.line(z=0.5, f=400)
        p.helix(0, 0, 2.75, 0.5, -16, 1.5, 500)
        p.circle(0, 0, 2.75, f=500)
        p.line(0, 0)
        p.rapid(z=NEAR)
        x = 0.007 if fault else 0.0
        p.change(t3, x, 0, 3000)
        p.rapid(z=NEAR)
        p.rapid(z=-17)
        p.arc(True, 4 + x, 0, 2, 0, f=300)
        p.mark("thread")
        p.circle(x, 0, 4, True, z=-15.5)
        p.arc(True, x, 0, -2, 0)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("thread_milled_bore", "Thread-milled bore, as a cylinder", part, ((-30, -30, -15), (30, 30, 1)), [t1, t2, t3],
        program, Fault("gouge", 7, (10, 0, -7), "thread", "the thread's axis is 7 um beside its place"),
        notes=["The thread mill is a cylinder of its outer diameter: one turn of a helix at full depth."])


# -- 16 -----------------------------------------------------------------------------------------------------------
def oring_groove():
    t1, t2 = face_mill(), end_mill(2, 3, 8, shank=6, length=45, neck_diameter_mm=2.9, neck_length_mm=4)

    def part():
        return cut(box(-35, -35, -20, 35, 35, 0), cylinder(0, 0, -2.7, 1, 23.6).cut(cylinder(0, 0, -3, 2, 20)))

    def program(fault):
        p = Program("o-ring groove", 1016)
        face(p, t1, -35, -35, 35, 35, 0)
        p.change(t2, 21.8, 0, 9000)
        p.rapid(z=NEAR)
        p.line(z=0.2, f=300)
        p.helix(0, 0, 21.8, 0.2, -2.6, 0.7, 400)
        deep = -2.688 if fault else -2.7
        p.line(z=deep, f=100)
        p.mark("floor")
        p.line(21.5, 0, f=250)
        p.circle(0, 0, 21.5, False)
        p.line(22.1, 0)
        p.circle(0, 0, 22.1, True)
        p.mark_end("floor")
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("oring_groove", "Groove of an O-ring", part, ((-35, -35, -20), (35, 35, 1)), [t1, t2], program,
        Fault("excess", 12, (21.8, 0, -2.7), "floor", "the groove is 12 um too shallow"))


# -- 17 -----------------------------------------------------------------------------------------------------------
def engraved_v():
    t1 = face_mill()
    t2 = Tool(2, "ENGRAVER 60 DEG", 6, 6, shape="chamfer", length=50, holder=30, point_angle_deg=60,
              tip_diameter_mm=0)
    depth, wide = 0.4, 0.4 * math.tan(math.radians(30))
    letters = [[(-30, 10), (-24, -10), (-18, 10)], [(-8, 10), (-8, -10), (4, -10)], [(12, 10), (28, 10)],
               [(20, 10), (20, -10)]]

    def stroke(a, b):
        k = (depth + 0.2) / depth  # up to .2 mm above the plate
        length = math.dist(a, b)
        nx, ny = -(b[1] - a[1]) / length * wide * k, (b[0] - a[0]) / length * wide * k
        bar = polygon([(a[0], a[1], -depth), (a[0] + nx, a[1] + ny, 0.2), (a[0] - nx, a[1] - ny, 0.2)],
                      (b[0] - a[0], b[1] - a[1], 0))
        ends = [solids.Part.makeCone(0, wide * k, depth + 0.2, V(x, y, -depth)) for x, y in (a, b)]
        return [bar, *ends]

    def part():
        pieces = [piece for letter in letters for a, b in zip(letter, letter[1:]) for piece in stroke(a, b)]
        return cut(box(-40, -20, -10, 40, 20, 0), *pieces)

    def program(fault):
        p = Program("engraved lines", 1017)
        face(p, t1, -40, -20, 40, 20, 0)
        p.change(t2, *letters[0][0], 12000)
        for k, letter in enumerate(letters):
            p.rapid(*letter[0])
            p.rapid(z=NEAR)
            p.line(z=-0.424 if fault and k == 2 else -depth, f=100)
            p.mark(f"letter {k}")
            for x, y in letter[1:]:
                p.line(x, y, f=400)
            p.mark_end(f"letter {k}")
            p.rapid(z=NEAR)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("engraved_v", "Engraved V lines", part, ((-40, -20, -10), (40, 20, 1)), [t1, t2], program,
        Fault("gouge", 12, (24, 10, -0.4), "letter 2", "one line is 24 um too deep, 12 um square to its walls"))


# -- 18 -----------------------------------------------------------------------------------------------------------
def floor_bull_nose():
    t1, t2 = face_mill(), end_mill(2, 16, 25)
    t3 = Tool(3, "BULL NOSE D12 R2", 12, 25, shape="bull_nose", corner_radius_mm=2)
    bow, flat, wall, deep, r = 60.0, 10.0, 30.0, -12.0, 2.0
    middle = deep + bow  # height of the centre of the floor's arc

    def centre(rho):
        """Height of the torus' circle at this distance from the middle where it touches the floor."""
        return middle - math.sqrt((bow - r) ** 2 - max(0.0, rho - flat) ** 2)

    def part():
        def at(rho, z):
            return V(rho, 0, z)

        def on_bow(angle):
            return at(flat + bow * math.sin(angle), middle - bow * math.cos(angle))

        z_c = centre(wall - r)
        touch = math.atan2(wall - r - flat, middle - z_c)
        half = (touch + math.pi / 2) / 2  # of the fillet, from the floor's normal to the wall's

        def on_fillet(angle):
            return at(wall - r + r * math.sin(angle), z_c - r * math.cos(angle))

        P = solids.Part
        edges = [P.LineSegment(at(0, 1), at(0, deep)), P.LineSegment(at(0, deep), at(flat, deep)),
                 P.Arc(at(flat, deep), on_bow(touch / 2), on_bow(touch)),
                 P.Arc(on_bow(touch), on_fillet(half), on_fillet(math.pi / 2)),
                 P.LineSegment(on_fillet(math.pi / 2), at(wall, 1)), P.LineSegment(at(wall, 1), at(0, 1))]
        profile = P.Face(P.Wire([edge.toShape() for edge in edges]))
        return cut(box(-40, -40, -30, 40, 40, 0), profile.revolve(V(0, 0, 0), V(0, 0, 1), 360))

    def program(fault):
        p = Program("pocket floor by bull nose", 1018)
        face(p, t1, -40, -40, 40, 40, 0)
        p.change(t2, 6, 0, 4000)
        p.rapid(z=NEAR)
        start = 0.5
        p.line(z=start, f=400)
        for z, rings in ((-4, (14, 21.5)), (-8, (14, 21.5)), (-11, (11,))):
            p.line(6, 0, f=700)
            p.helix(0, 0, 6, start, z, 2, 700)
            p.circle(0, 0, 6, f=700)
            for ring in rings:
                p.line(ring, 0)
                p.circle(0, 0, ring, f=700)
            start = z
        p.rapid(z=NEAR)
        p.change(t3, 0, 0, 6000)
        p.rapid(z=NEAR)
        p.rapid(z=-10)
        p.line(z=deep, f=200)
        rings = rows(flat - 4, wall - 6, 0.25)
        for ring in rings:
            last = ring == rings[-1]
            z = centre(ring + 4) - r
            p.line(ring + (0.014 if fault and last else 0), 0, z, f=1000)
            if last:
                p.mark("last ring")
            p.circle(0, 0, ring + (0.014 if fault and last else 0))
        p.line(20, 0)
        p.rapid(z=SAFE)
        p.end()
        return p

    def facets():
        """The profile turned in 124 steps, and the block around it: OCC needs seven times as many facets."""
        z_c, n = centre(wall - r), 124
        touch = math.atan2(wall - r - flat, middle - z_c)
        profile = [(flat + bow * math.sin(a), middle - bow * math.cos(a)) for a in rows(0, touch, 0.0175)]
        profile += [(wall - r + r * math.sin(a), z_c - r * math.cos(a)) for a in rows(touch, math.pi / 2, 0.08)][1:]
        profile.append((wall, 0.0))

        def at(k, rho_z):
            angle = 2 * math.pi * (k % n) / n
            return V(rho_z[0] * math.cos(angle), rho_z[0] * math.sin(angle), rho_z[1])

        found = []
        for k in range(n):
            found.append((V(0, 0, deep), at(k, profile[0]), at(k + 1, profile[0])))
            for low, high in zip(profile, profile[1:]):
                found += [(at(k, low), at(k, high), at(k + 1, high)), (at(k, low), at(k + 1, high), at(k + 1, low))]
        side = 40.0
        corners = [(side, side), (-side, side), (-side, -side), (side, -side)]
        for q in range(4):
            a, b = corners[q], corners[(q + 1) % 4]
            high_a, high_b, low_a, low_b = V(*a, 0), V(*b, 0), V(*a, -30), V(*b, -30)
            for k in range(q * n // 4, (q + 1) * n // 4):
                found.append((at(k, profile[-1]), high_a, at(k + 1, profile[-1])))
            found.append((at((q + 1) * n // 4, profile[-1]), high_a, high_b))
            found += [(low_a, low_b, high_b), (low_a, high_b, high_a)]
        under = [V(*c, -30) for c in corners]
        return found + [(under[0], under[2], under[1]), (under[0], under[3], under[2])]

    Job("floor_bull_nose", "Pocket with a bowed floor by a bull nose, vertical wall", part,
        ((-40, -40, -30), (40, 40, 1)), [t1, t2, t3], program,
        Fault("gouge", 14, (30, 0, -3), "last ring", "the last ring is 14 um too large in radius"),
        notes=["Rings 0.25 mm apart leave 3.8 to 4.3 um on the floor."],
        facets=facets, chord_um=12)


# -- 19 -----------------------------------------------------------------------------------------------------------
def fillet_ball():
    t1, t2 = face_mill(), end_mill(2, 16, 30)
    t3 = Tool(3, "BALL MILL D8", 8, 25, shape="ball", length=60)

    def part():
        solid = cut(box(-40, -25, -30, 40, 25, 0), box(-41, -26, -15, 41, 5, 1))

        def along(y, z):
            return [e for e in solid.Edges if all(abs(v.Y - y) + abs(v.Z - z) < 1e-9 for v in e.Vertexes)]

        solid = solid.makeFillet(4, along(5, -15))
        return solid.makeFillet(6, along(25, 0))

    def program(fault):
        p = Program("fillets by a ball", 1019)
        face(p, t1, -40, -25, 40, 25, 0)
        p.change(t2, -50, -30, 4000)
        for z, last in ((-5, -3), (-11, -3), (-15, -7)):
            across = rows(-28, last, 11)
            p.rapid(-50, across[0])
            p.rapid(z=NEAR)
            p.line(z=z, f=800)
            for k, y in enumerate(across):
                p.line(y=y)
                p.line(x=50 if k % 2 == 0 else -50, f=600)
            p.rapid(z=NEAR)
        p.change(t3, -46, 0.6, 8000)
        p.rapid(z=NEAR)
        p.line(z=-14.6, f=800)
        p.line(46, 0.6, f=600)
        off = 0.01 if fault else 0.0
        p.line(46, 1 - off, -15 + off)
        p.mark("inner fillet")
        p.line(-46, f=400)
        p.rapid(z=10)
        # The outer edge: rows at equal angles, 0.3 mm apart on the fillet.
        count = 32
        for k in range(count + 1):
            angle = math.pi / 2 * k / count
            y, z = 19 + 10 * math.sin(angle), -6 + 10 * math.cos(angle) - 4
            if k == 0:
                p.rapid(-46, y)
                p.rapid(z=NEAR)
            p.line(y=y, z=z, f=1500)
            p.line(x=46 if k % 2 == 0 else -46)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("fillet_ball", "Fillets inside and outside by a ball", part, ((-40, -25, -30), (40, 25, 1)), [t1, t2, t3],
        program,
        Fault("excess", 10 * math.sqrt(2), (0, 1 + 4 * math.sqrt(0.5), -11 - 4 * math.sqrt(0.5)), "inner fillet",
              "the inner fillet's row is 10 um too far from both faces"),
        notes=["Rows 0.295 mm apart on the outer fillet leave 4.6 um."])


# -- 26 -----------------------------------------------------------------------------------------------------------
def thin_rib():
    t1, t2 = face_mill(), end_mill(2, 10, 26)

    def part():
        return fuse(box(-40, -20, -30, 40, 20, -20), box(-40, -0.5, -20, 40, 0.5, 0))

    def program(fault):
        p = Program("thin rib", 1026)
        face(p, t1, -40, -20, 40, 20, 0)
        p.change(t2, -48, 20, 6000)
        p.rapid(z=NEAR)
        for z in levels(0, -20, 4):  # both sides of the rib at each level, so that it is held by what is below
            for side in (1, -1):
                p.rapid(-48, side * 19.8)
                p.rapid(z=z + 4 + NEAR)
                p.line(z=z, f=500)
                for k, y in enumerate((19.8, 12.8, 5.8)):
                    p.line(y=side * y, f=800)
                    p.line(x=48 if k % 2 == 0 else -48)
                p.rapid(z=NEAR)
                p.rapid(-48)
        for side in (1, -1):
            p.rapid(-48 * side, side * 5.5 + (0.025 if fault and side > 0 else 0))
            p.rapid(z=-18)
            p.line(z=-20, f=500)
            p.mark(f"wall {side}")
            p.line(x=48 * side, f=400)
            p.rapid(z=NEAR)
        p.rapid(z=SAFE)
        p.end()
        return p

    Job("thin_rib", "Rib of 1 x 20 mm", part, ((-40, -20, -30), (40, 20, 1)), [t1, t2], program,
        Fault("excess", 25, (0, 0.5, -10), "wall 1", "one side of the rib is 25 um too thick"))


# -- 27 -----------------------------------------------------------------------------------------------------------
def sixty_holes():
    t1, t2 = face_mill(), drill(2, 5, 40)
    places = [((k % 10 - 4.5) * 11 * (1 if k // 10 % 2 == 0 else -1), (k // 10 - 2.5) * 12) for k in range(60)]
    point = 2.5 / math.tan(math.radians(59))

    def part():
        tools = []
        for x, y in places:
            tools += [cylinder(x, y, -8, 1, 2.5).fuse(cone(x, y, -8 - point, 0, -8, 2.5))]
        return cut(box(-60, -40, -15, 60, 40, 0), solids.Part.makeCompound(tools))

    def program(fault):
        p = Program("sixty holes", 1027)
        face(p, t1, -60, -40, 60, 40, 0)
        p.change(t2, *places[0], 3500)
        tip = round(-8 - point, 4)
        deep = [(x, y, tip - (0.03 if fault and k == 37 else 0)) for k, (x, y) in enumerate(places)]
        p.marks = {}
        p.raw("G98")
        for k, (x, y, z) in enumerate(deep):
            p.mark(f"hole {k}")
            p.raw(f"G81 {p._word('X', x)} {p._word('Y', y)} {p._word('Z', z)} R2. F300.")
        p.raw("G80")
        p.forget()
        p.rapid(z=SAFE)
        p.end()
        return p

    x, y = places[37]
    Job("sixty_holes", "Plate with 60 holes", part, ((-60, -40, -15), (60, 40, 1)), [t1, t2], program,
        Fault("gouge", 30 * math.sin(math.radians(59)), (x, y, -8 - point), "hole 37",
              "one hole is 30 um too deep, 25.7 um square to its point"), chord_um=40)


# -- 28 -----------------------------------------------------------------------------------------------------------
def inch_program():
    inch = 25.4
    t1, t2 = face_mill(1, 2 * inch), end_mill(2, 0.5 * inch, 1.25 * inch)
    t3 = drill(3, 0.25 * inch, 2 * inch)
    places = [(x * inch, y * inch) for x, y in ((-1.7, -1), (1.7, -1), (1.7, 1), (-1.7, 1))]

    def part():
        tools = [cylinder(x, y, -20, 1, 0.125 * inch) for x, y in places]
        return cut(box(-2 * inch, -1.25 * inch, -0.75 * inch, 2 * inch, 1.25 * inch, 0),
                   rounded(0, 0, 2.5 * inch, 1.25 * inch, 0.3125 * inch, -0.375 * inch, 1), *tools)

    def program(fault):
        p = Program("program in inches", 1028, unit=inch, words="G17 G20 G40 G49 G80 G90 G94")
        p.digits = 5
        face(p, t1, -2 * inch, -1.25 * inch, 2 * inch, 1.25 * inch, 0, f=30 * inch)
        p.change(t2, 0, 0, 4000)
        pocket(p, t2, 0, 0, 2.5 * inch, 1.25 * inch, 0.3125 * inch, 0, -0.375 * inch, 0.125 * inch, f=25 * inch,
               finish_f=15 * inch, grow=-0.0005 * inch if fault else 0)
        p.change(t3, *places[0], 3000)
        holes(p, "G83", places, -0.85 * inch, r_plane=0.1 * inch, q=0.15 * inch, f=10 * inch)
        p.end()
        return p

    Job("inch_program", "Program in inches", part,
        ((-2 * inch, -1.25 * inch, -0.75 * inch), (2 * inch, 1.25 * inch, 0.04 * inch)), [t1, t2, t3], program,
        Fault("excess", 12.7, (1.25 * inch, 0, -4), "wall", "the pocket's contour is 0.0005 in too small"))


# -- 29 -----------------------------------------------------------------------------------------------------------
def mirrored_program():
    t1, t2 = face_mill(), end_mill(2, 10, 22)

    def part():
        tools = []
        for s in (1, -1):
            tools += [rounded(s * 26, -8, 36, 24, 7, -6, 1), rounded(s * 26, 17, 30, 12, 6, -4, 1)]
        return cut(box(-52, -30, -18, 52, 30, 0), *tools)

    def program(fault):
        p = Program("mirrored program", 1029)
        face(p, t1, -52, -30, 52, 30, 0)
        p.change(t2, 26, -8, 5000)
        p.rapid(z=NEAR)
        p.raw("M98 P2029")
        p.raw(f"G51.1 X{'0.006' if fault else '0.'}")
        p.raw("M98 P2029")
        p.raw("G50.1 X0.")
        p.forget()
        p.rapid(z=SAFE)
        p.end()
        last = p.lines.pop()
        p.raw("O2029 (POCKET AND SLOT OF ONE SIDE)")
        p.forget()
        for z in levels(0, -6, 3):
            zigzag(p, 26 - 12.4, -8 - 6.4, 26 + 12.4, -8 + 6.4, z, 6.4, 600, above=NEAR)
            p.rapid(z=NEAR)
        p.rapid(26, -8)
        p.line(z=-6, f=200)
        p.raw("G41 D2")
        p.line(20, -14, f=400)
        p.arc(True, 26, -20, 6, 0)
        p.mark("wall")
        p.line(37, -20)
        p.arc(True, 44, -13, 0, 7)
        p.line(44, -3)
        p.arc(True, 37, 4, -7, 0)
        p.line(15, 4)
        p.arc(True, 8, -3, 0, -7)
        p.line(8, -13)
        p.arc(True, 15, -20, 7, 0)
        p.line(26, -20)
        p.mark_end("wall")
        p.arc(True, 32, -14, 0, 6)
        p.raw("G40")
        p.line(26, -8)
        p.rapid(z=NEAR)
        p.rapid(17, 17)
        p.line(z=-4, f=150)
        p.line(35, 17, f=400)
        p.rapid(z=NEAR)
        contour_inside(p, t2, 26, 17, 30, 12, 6, -4, 0, name="slot", clear=False)
        p.raw("M99")
        p.raw(last)
        return p

    Job("mirrored_program", "Mirrored program", part, ((-52, -30, -18), (52, 30, 1)), [t1, t2], program,
        Fault("gouge", 12, (-8, -8, -3), "wall", "the mirror stands 6 um beside the middle"),
        head='dialect = "fanuc"')


# -- 30 -----------------------------------------------------------------------------------------------------------
def large_plate():
    t1, t2, t3 = face_mill(1, 80), end_mill(2, 20, 40), drill(3, 12, 60)
    pockets = [(x, y) for x in (-190, 190) for y in (-110, 110)]
    places = [(x, y) for x in (-280, -93, 93, 280) for y in (-180, 0, 180)]

    def part():
        tools = [rounded(x, y, 120, 80, 14, -10, 1) for x, y in pockets] + [cylinder(0, 0, -31, 1, 50)]
        tools += [cylinder(x, y, -31, 1, 6) for x, y in places]
        return cut(box(-300, -200, -30, 300, 200, 0), *tools)

    def program(fault):
        p = Program("plate 600 x 400", 1030)
        face(p, t1, -300, -200, 300, 200, 0, rpm=900, f=1500)
        p.change(t2, *pockets[0], 3200)
        for k, (x, y) in enumerate(pockets):
            pocket(p, t2, x, y, 120, 80, 14, 0, -10, 5, f=1200, name=f"pocket {k}",
                   floor=0.02 if fault and k == 2 else 0)
        p.rapid(8, 0)
        p.line(z=0.5, f=400)
        start = 0.5
        for z in levels(0, -31, 8):
            p.line(8, 0, f=1200)
            p.helix(0, 0, 8, start, z, 4, 1200)
            for ring in (8, 22, 39.5):
                p.line(ring, 0)
                p.circle(0, 0, ring, f=1200)
            start = z
        p.rapid(z=NEAR)
        circle_inside(p, t2, 0, 0, 50, -31, 0, name="bore")
        marks = dict(p.marks)
        p.change(t3, *places[0], 1500)
        holes(p, "G83", places, -34.5, q=6, f=250)
        p.marks = marks
        p.end()
        return p

    Job("large_plate_600x400", "Plate of 600 x 400 mm", part, ((-300, -200, -30), (300, 200, 1)), [t1, t2, t3],
        program,
        Fault("excess", 20, (190, -110, -10), ("pocket 2 floor", "pocket 2"), "one pocket is 20 um too shallow"),
        chord_um=10, machine="fork_head")


# -- 25 -----------------------------------------------------------------------------------------------------------
def casting_faced():
    t1, t2 = face_mill(), drill(2, 5, 40)
    places = [(x, y) for x in (-33, 33) for y in (-24, 24)]
    point = 2.5 / math.tan(math.radians(59))

    def frustum(x0, y0, z0, x1, y1, z1):
        """Between two rectangles of these half sides."""
        def ring(x, y, z):
            return [(x, y, z), (-x, y, z), (-x, -y, z), (x, -y, z)]

        low, high = ring(x0, y0, z0), ring(x1, y1, z1)
        sides = [[low[k], low[(k + 1) % 4], high[(k + 1) % 4], high[k]] for k in range(4)]
        faces = [solids.Part.Face(solids.Part.makePolygon([V(*p) for p in [*side, side[0]]]))
                 for side in (low, high, *sides)]
        return solids.Part.Solid(solids.Part.Shell(faces))

    def housing():
        outside = frustum(40, 30, -30, 38.9375, 28.9375, 2)
        inside = frustum(26, 16, -22, 27.5, 17.5, 2)
        return outside.cut(inside)

    def part():
        tools = [solids.Part.makeBox(100, 100, 10, V(-50, -50, 0))]
        tools += [cylinder(x, y, -15, 1, 2.5).fuse(cone(x, y, -15 - point, 0, -15, 2.5)) for x, y in places]
        return cut(housing(), *tools)

    def program(fault):
        p = Program("casting faced", 1025)
        face(p, t1, -39, -29, 39, 29, -0.009 if fault else 0)
        p.change(t2, *places[0], 3500)
        marks = dict(p.marks)
        holes(p, "G83", places, round(-15 - point, 4), q=4, f=300, r_plane=3)
        p.marks = marks
        p.end()
        return p

    def casting(path):
        solids.write_stl(housing(), path, "casting", facets=solids.facets_of(housing(), 0.005))

    Job("casting_faced", "Casting, faced and drilled", part, None, [t1, t2], program,
        Fault("gouge", 9, (0, -24, 0), "face", "the casting is faced 9 um too deep"),
        stock_text='mesh = "casting.stl"', files={"casting.stl": casting},
        notes=["The raw stock is a mesh: walls, floor and bottom stay as cast."])


for make in (face_boss, open_pocket_draft, t_slot, thread_milled_bore, oring_groove, engraved_v, floor_bull_nose,
             fillet_ball, thin_rib, sixty_holes, inch_program, mirrored_program, large_plate, casting_faced):
    make()
