#!/usr/bin/env python3
"""Writes the cases of Tables 1 and 2 of Kruth et al.: a scene and a CL file each, both committed.

Run it after a change. A case is a Maho 600C, one tool, a raw block that stands on the table, a path of a few moves, and one
thing that is wrong. W lies in the block's lower face; all lengths in mm.
"""
from math import cos, radians, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
UP = (0.0, 0.0, 1.0)


def leaned(tilt_deg, azimuth_deg=0.0):
    t, a = radians(tilt_deg), radians(azimuth_deg)
    return (sin(t) * cos(a), sin(t) * sin(a), cos(t))


def go(p, axis):
    return "GOTO/" + ",".join(f"{k + 0.0:.6f}" for k in p) + "," + ",".join(f"{k + 0.0:.12f}" for k in axis)


def path(points, axis=UP, lift=40.0, tool=1):
    """Down to the first of the points along the axis, through them, and up again."""
    above = [tuple(k + lift * n for k, n in zip(p, axis)) for p in (points[0], points[-1])]
    lines = [f"LOADTL/{tool}", "SPINDL/4000,CLW", "RAPID", go(above[0], axis), "FEDRAT/400,MMPM"]
    return lines + [go(p, axis) for p in points] + ["RAPID", go(above[1], axis)]


def tool(length, holder, holder_length, diameter=10, flutes=20, shank=None, number=None):
    text = f"[[tool]]\nnumber = {number}\n" if number else "[cutter]\nnumber = 1\n"
    text += f"diameter_mm = {diameter}\nflute_length_mm = {flutes}\n"
    text += f"shank_diameter_mm = {shank}\n" if shank else ""
    return text + f"length_mm = {length}\nholder_diameter_mm = {holder}\nholder_length_mm = {holder_length}\n"


def fixture(name, low, high):
    return f'[[fixture]]\nname = "{name}"\nbox_mm = [{list(low)}, {list(high)}]\n'


def grid(step, count):
    return f"\n[post.clamping]\nstep_mm = {list(step)}\ncount = {list(count)}\n"


def reach(most=0, least=0, step=5):
    text = "\n[post.tool_reach]\n" + f"step_mm = {step}\n" + (f"most_mm = {most}\n" if most else "")
    return text + (f"least_mm = {least}\n" if least else "")


def case(name, title, about, origin, tools, box, moves, more="", voxel=1, post=""):
    cl = [f"PARTNO/{title.upper()}", "UNITS/MM", "MULTAX/ON"] + moves + ["SPINDL/OFF", "FINI"]
    (HERE / f"{name}.cl").write_text("\n".join(cl) + "\n")
    text = "".join(f"# {line}\n" for line in about)
    text += f'title = "Kruth, {title}"\nmachine = "maho_600c"\ncl = "{name}.cl"\n\n'
    text += f"[setup]\nwork_origin_mm = {list(origin)}\n\n" + tools + ("\n" + more if more else "")
    text += f"\n[stock]\nbox_mm = [{list(box[0])}, {list(box[1])}]\nvoxel_mm = {voxel}\n"
    text += "\n[accept]\ncollisions = 0\n" + ("gouge_max_um = 10\n" if "[design]" in more else "")
    text += '\n[post]\nwords = "linuxcnc"\ntcp = false\n' + post
    (HERE / f"{name}.toml").write_text(text + "\n[movie]\nseconds = 0\n")


def head_and_holder():
    case("row_01_head_workpiece", "Table 1: milling head and unmachined workpiece",
         ["The side of a block 120 high is milled at a height of 30; tool and holder are 80 long, so the spindle's nose (D 68)",
          "stands 10 mm below the block's upper face. Action B: 91 and more."],
         (0, 0, 0), tool(50, 10, 30, diameter=12, shank=10), ((-30, -30, 0), (30, 30, 120)),
         path([(35.5, -45, 30), (35.5, 45, 30)], lift=100), post=reach(most=40))
    case("row_02_head_fixture", "Table 1: milling head and clamping tools",
         ["A clamp's post 120 high stands beside the block; the gauge line is at 110 over the cut. Action B: 82 and more."],
         (0, 0, 0), tool(40, 10, 30), ((-45, -25, 0), (25, 25, 40)), path([(-30, 0, 39), (10, 0, 39)]),
         fixture("post", (30, -15, 0), (60, 15, 120)), post=reach(most=40))
    low = ((-30, -30, 0), (30, 30, 60))
    case("row_03_head_table", "Table 1: milling head and table",
         ["A side face is milled with the tool level, 30 over the table: the spindle's nose (radius 34 to 57) reaches it.",
          "Action A: 27 higher; or B: 100 of tool and holder, past the table's rim."],
         (0, 0, 0), tool(30, 30, 30), low, path([(29, -20, 30), (29, 20, 30)], leaned(90)), post=grid((10, 10, 10), (1, 1, 7)) + reach(most=40))
    case("row_04_holder_workpiece", "Table 1: tool holder and unmachined workpiece",
         ["A shoulder 22 deep, the tool stands 18 out of a holder D 40. Action B: 23."],
         (0, 0, 0), tool(18, 40, 70, flutes=18), ((-40, -30, 0), (40, 30, 60)),
         path([(38, -45, 50), (38, 45, 50), (38, 45, 38), (38, -45, 38)]), post=reach(most=40))
    case("row_05_holder_fixture", "Table 1: tool holder and clamping tools",
         ["A clamp's post 75 high stands beside the block; the holder (D 40) comes down to 69. Action B: 37 out of",
          "the holder."],
         (0, 0, 0), tool(30, 40, 50), ((-35, -25, 0), (15, 25, 40)), path([(-25, 0, 39), (5, 0, 39)]),
         fixture("post", (20, -15, 0), (40, 15, 75)), post=reach(most=40))
    case("row_06_holder_table", "Table 1: tool holder and table",
         ["A side face is milled with the tool level, 15 over the table: the holder (D 40) reaches it, the spindle's nose stands",
          "outside of the table. Action A: 6 higher; or B: 100 out of the holder, past the table's rim."],
         (0, 0, 0), tool(30, 40, 80), ((-30, -30, 0), (30, 30, 40)), path([(29, -20, 15), (29, 20, 15)], leaned(90)), post=grid((10, 10, 10), (1, 1, 5)) + reach(most=40))


def cutter():
    design = '[design]\nkind = "plane"\norigin_mm = [-25, -4, 18]\nalong_u_mm = [50, 0, 0]\nalong_v_mm = [0, 8, 0]\npitch_mm = 1\n'
    case("row_07_cutter_finished_part", "Table 1: cutter and finished workpiece",
         ["A pass over a plane at 18 goes 0.5 mm below it for 4 mm. No action of a post helps: the CAM system has to change the",
          "path (lines 11 to 13)."],
         (0, 0, 0), tool(50, 40, 50), ((-30, -20, 0), (30, 20, 20)),
         path([(-40, 0, 18), (-4, 0, 18), (-2, 0, 17.5), (2, 0, 17.5), (4, 0, 18), (40, 0, 18)]), design, voxel=0.5, post=reach(most=20))
    case("row_08_cutter_fixture", "Table 1: cutter and clamping device",
         ["A pass ends 5 mm inside a stop beside the block. No action of a post helps: another set-up, or another path."],
         (0, 0, 0), tool(50, 40, 50), ((-40, -20, 0), (10, 20, 40)), path([(-50, 0, 38), (10, 0, 38)]),
         fixture("stop", (10, -10, 0), (30, 10, 45)), post=reach(most=20))
    case("row_09_cutter_table", "Table 1: cutter and table",
         ["A side is milled to 2 mm below the block, which stands on the table. Action A: the work more than 2 higher."],
         (0, 0, 0), tool(70, 40, 50, flutes=40), ((-30, -30, 0), (30, 30, 30)), path([(34, -45, -2), (34, 45, -2)]), post=grid((10, 10, 5), (1, 1, 5)))


def structure_and_limits():
    case("row_10_workpiece_structure", "Table 1: workpiece and machine structure",
         ["A bar of 600 is tilted by 80 degrees; its lower end meets the X slide, in both rotary solutions (the bar is symmetric).",
          "Action A: 8 mm and more towards its upper end."],
         (0, 0, 0), tool(50, 40, 50), ((-300, -30, 0), (300, 30, 40)), path([(300, -40, 35), (300, 40, 35)], leaned(80)),
         voxel=2, post=grid((10, 10, 10), (5, 1, 1)))
    case("row_11_linear_limit", "Table 1: linear axis limit",
         ["A pass along a bar, leaned by 10 degrees, begins at X -310; the travel ends at -300. In the other rotary solution it begins",
          "at X 310. Action A: 11 to 34 along X."],
         (0, 0, 0), tool(50, 40, 50), ((-305, -10, 0), (265, 10, 60)), path([(-315, 0, 58), (270, 0, 58)], leaned(10)), voxel=2,
         post=grid((10, 10, 10), (7, 1, 1)))
    case("row_12_linear_limit_long_tool", "Table 1: linear axis limit by a tool too long",
         ["A block of 300 stands on the table; with 250 of tool and holder the approach 40 over the cut asks for Z 589, the travel",
          "ends at 550. The work cannot go lower. Action B-: 211 and less."],
         (0, 0, 0), tool(170, 40, 80), ((-30, -30, 0), (30, 30, 300)), path([(-45, 0, 299), (45, 0, 299)]), voxel=2,
         post=grid((20, 20, 20), (3, 3, 1)) + reach(least=-60))
    case("row_13_rotary_limit", "Table 1: rotary axis limit",
         ["An undercut asks for B 110 or -110, the travel ends at 100. No action of a post helps: another set-up, or a tool axis",
          "10 degrees less tilted."],
         (0, 0, 150), tool(70, 30, 50), ((-30, -30, 0), (30, 30, 60)), path([(29, -40, 30), (29, 40, 30)], leaned(110)),
         post=grid((20, 20, 20), (3, 3, 1)) + reach(most=20, least=-20))
    first = path([(-15, -25, 29), (-15, 25, 29)])
    long_tools = [tool(150, 40, 150, diameter=20, flutes=40, number=number) for number in (1, 2)]
    case("row_14_tool_load", "Table 1: collision during tool load",
         ["Tools are changed at X 300 Y 250 Z 550, where their tips stand 250 over the table; on the way there from the work at",
          "(-50, -50) stands a post of 280. The CL data itself is free, and a run does not look at changes of the tool. Action A: the",
          "work where the way to the changer passes the post, for example at (50, -50)."],
         (-50, -50, 0), "\n".join(long_tools), ((-20, -20, 0), (20, 20, 30)),
         first + path([(15, -25, 29), (15, 25, 29)], tool=2), fixture("post", (30, 50, 0), (60, 80, 280)),
         post=grid((50, 50, 50), (3, 3, 1)))


def arm():
    case("table2_1_workpiece_arm", "Table 2: workpiece and rotating arm B",
         ["A bar of 290 lies across a table of 256 and is turned by 80 degrees: one end goes into the arm 136 behind C, in both",
          "rotary solutions (the bar is symmetric). Action A: 20 mm and more along the bar."],
         (0, 0, 0), tool(50, 40, 50), ((-145, -20, 0), (145, 20, 40)), path([(-30, 0, 39), (30, 0, 39)], leaned(10, 80)),
         post=grid((10, 10, 10), (7, 1, 1)))
    lean = leaned(10)
    for name, title, about, tools, far in (
            ("table2_2_head_arm", "Table 2: milling head and rotating arm B",
             ["The spindle's nose goes into the arm behind the work, in both rotary solutions. Action A: 10 mm and more away from it."],
             tool(40, 30, 40), 88),
            ("table2_3_holder_arm", "Table 2: tool holder and rotating arm B",
             ["The holder (D 63) goes into the arm behind the work, in both rotary solutions. Action A: 16 mm and more away from it."],
             tool(60, 63, 120), 112),
            ("table2_4_cutter_arm", "Table 2: cutter and rotating arm B",
             ["The cutter goes into the arm behind the work, in both rotary solutions. Action A: 9 mm and more away from it."],
             tool(170, 16, 30, flutes=40), 131)):
        end = min(far - 8, 120)
        case(name, title, about, (0, 0, 0), tools, ((-20, -end, 0), (20, end, 40)),
             path([(0, -far, 38), (0, far, 38)], lean), post=grid((10, 10, 10), (1, 5, 1)))


def wall_mesh(name, foot, lean_deg, height, thickness, half):
    """A wall along Y whose face towards -X has its foot at x = foot and leans away by lean_deg: text STL."""
    far = foot + thickness + height * sin(radians(lean_deg)) / cos(radians(lean_deg))
    top = foot + height * sin(radians(lean_deg)) / cos(radians(lean_deg))
    ring = [(foot, 0.0), (far, 0.0), (far, height), (top, height)]
    near, back = [(x, -half, z) for x, z in ring], [(x, half, z) for x, z in ring]
    faces = [(near[0], near[1], near[2]), (near[0], near[2], near[3]), (back[0], back[2], back[1]), (back[0], back[3], back[2])]
    for i in range(4):
        j = (i + 1) % 4
        faces += [(near[j], near[i], back[i]), (near[j], back[i], back[j])]
    text = "solid wall\n"
    for face in faces:
        text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex %.9f %.9f %.9f\n" % p for p in face) + "endloop\nendfacet\n"
    (HERE / name).write_text(text + "endsolid wall\n")


def path_advice():
    """Only the path helps: swarf post --fix. The ball's centre runs at a height of 45, d = 10 square to the wall's face from it;
    the holder's rim (R 20) is L = 25 above the centre: R cos(psi) - L sin(psi) = d, psi = 20.459 degrees from the face."""
    lean, height, gap, ball = 10.0, 45.0, 10.0, 5.0
    foot = gap / cos(radians(lean)) - height * sin(radians(lean)) / cos(radians(lean))
    wall_mesh("path_1_wall.stl", foot, lean, 130.0, 15.0, 60.0)
    case("path_1_holder_wall", "method D: tool holder and a leaning wall",
         ["A ball end cuts beside a wall that leans 10 degrees away; the holder meets it, and no tool may be pulled out further.",
          "Method D: swarf post --fix leans the tool away from it, by psi - 10 = 10.459 degrees (make_cases.py)."],
         (0, 0, 0), tool(30, 40, 80).replace("diameter_mm", 'shape = "ball"\ndiameter_mm', 1), ((-40, -25, 0), (0, 25, 42)),
         path([(0, -20, height - ball), (0, 20, height - ball)], lift=60.0), '[[fixture]]\nname = "wall"\nmesh = "path_1_wall.stl"\n')


if __name__ == "__main__":
    head_and_holder()
    cutter()
    structure_and_limits()
    arm()
    path_advice()
