#!/usr/bin/env python3
"""Random RS274/NGC programs for record.py: random_NN.ngc in this folder, the same for the same seeds.

They keep to what a control can execute (arcs that close, holes below R), and to one unit: LinuxCNC 2.9 does not
convert the tool length when the units change.
"""
import math
import pathlib
import random
import sys

PLANES = {"G17": "XYZIJ", "G18": "ZXYKI", "G19": "YZXJK"}  # first, second, normal, centre of both


class Program:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.head, self.lines, self.names = [], [], 0

    def add(self, text):
        self.lines.append(text)

    def number(self, low=-50.0, high=50.0):
        return f"{self.random.uniform(low, high):.3f}"

    def formula(self, value, depth=0):
        """Text that is worth `value`, a sum of it and something small, or a parameter that holds it."""
        r = self.random
        if depth > 2 or r.random() < 0.5:
            return f"{value:.4f}"
        kind = r.randrange(7)
        if kind == 0:
            part = round(r.uniform(-10, 10), 2)
            return f"[{part} + {self.formula(value - part, depth + 1)}]"
        if kind == 1:
            part = round(r.uniform(1, 9), 2)
            return f"[{part} * {self.formula(value / part, depth + 1)}]"
        if kind == 2:
            self.add(f"#{r.randint(1, 20)} = {self.formula(value, depth + 1)}")
            return self.lines[-1].split(" =")[0]
        if kind == 3:
            self.add(f"#<value{r.randint(1, 5)}> = {value:.4f}")
            return self.lines[-1].split(" =")[0]
        if kind == 4:
            function = r.choice(["abs", "sqrt", "sin", "cos", "round", "fix", "fup", "exp", "ln"])
            return f"[{value:.3f} + {function}[{r.uniform(0.1, 3):.3f}]]"
        if kind == 5:
            return f"[{value:.3f} + atan[{r.uniform(-3, 3):.3f}]/[{r.uniform(0.1, 3):.3f}] / 10]"
        operator = r.choice(["mod", "**", "gt", "lt", "eq", "ne", "ge", "le", "and", "or", "xor", "*", "/"])
        return f"[{value:.3f} + {r.randint(1, 3)} - {r.randint(1, 9)} {operator} {r.randint(1, 3)}]"

    def straight(self):
        axes = self.random.sample("XYZ", self.random.randint(1, 3))
        words = " ".join(axis + self.formula(self.random.uniform(-30, 30)) for axis in axes)
        self.add(self.random.choice(["G0 ", "G1 "]) + words)

    def to_arc(self):
        plane = self.random.choice(list(PLANES))
        first, second = PLANES[plane][:2]
        start = [self.random.uniform(-20, 20) for _ in range(2)]
        self.add(f"G90 {plane}")
        self.add(f"G1 {first}{start[0]:.5f} {second}{start[1]:.5f}")
        return plane, start

    def more_turns(self):
        return f" P{self.random.randint(1, 3)}" if self.random.random() < 0.25 else ""

    def arc_by_centre(self):
        r = self.random
        plane, start = self.to_arc()
        first, second, normal, i, j = PLANES[plane]
        radius, a, b = r.uniform(2, 15), r.uniform(0, 2 * math.pi), r.uniform(0, 2 * math.pi)
        centre = start[0] - radius * math.cos(a), start[1] - radius * math.sin(a)
        end = centre[0] + radius * math.cos(b), centre[1] + radius * math.sin(b)
        helix = f" {normal}{self.number(-5, 5)}" if r.random() < 0.4 else ""
        code, rest = r.choice(["G2", "G3"]), helix + self.more_turns()
        to_centre = f"{i}{centre[0] - start[0]:.5f} {j}{centre[1] - start[1]:.5f}"
        kind = r.randrange(4)
        if kind == 0:
            self.add(f"G90.1 {code} {first}{end[0]:.5f} {second}{end[1]:.5f} "
                     f"{i}{centre[0]:.5f} {j}{centre[1]:.5f}{rest}")
            self.add("G91.1")
        elif kind == 1:
            self.add(f"G91 {code} {first}{end[0] - start[0]:.5f} {second}{end[1] - start[1]:.5f} {to_centre}{rest}")
            self.add("G90")
        elif kind == 2:
            self.add(f"{code} {to_centre}{rest}")
        else:
            self.add(f"{code} {first}{end[0]:.5f} {second}{end[1]:.5f} {to_centre}{rest}")

    def arc_by_radius(self):
        r = self.random
        plane, start = self.to_arc()
        first, second, normal = PLANES[plane][:3]
        chord, angle = r.uniform(1, 20), r.uniform(0, 2 * math.pi)
        radius = chord / 2 * r.uniform(1.0005, 3) * r.choice([1, 1, -1])
        helix = f" {normal}{self.number(-5, 5)}" if r.random() < 0.3 else ""
        self.add(f"{r.choice(['G2', 'G3'])} {first}{start[0] + chord * math.cos(angle):.4f} "
                 f"{second}{start[1] + chord * math.sin(angle):.4f} R{radius:.4f}{helix}{self.more_turns()}")

    def offsets(self):
        r = self.random
        choice = r.choice([
            f"G10 L2 P{r.randint(0, 9)} X{self.number()} Y{self.number()}",
            f"G10 L2 P1 R{self.number(-90, 90)}",
            f"G10 L2 P{r.randint(1, 9)} Z{self.number()} R{self.number(-40, 40)}",
            "G10 L2 P0 R0", f"G10 L2 P0 R0\nG10 L20 P0 Z{self.number()}",
            f"G10 L1 P{r.randint(1, 3)} Z{self.number(1, 50)} R{self.number(1, 5)}",
            f"G10 L10 P{r.randint(1, 3)} Z{self.number(1, 50)}",
            f"G10 L11 P{r.randint(1, 3)} Z{self.number(1, 50)}",
            f"G92 X{self.number()}", f"G92 X{self.number()} Y{self.number()} Z{self.number()}",
            f"G92 Z{self.number()}", "G92.1", "G92.2", "G92.3",
            f"G52 X{self.number()} Y{self.number()}", "G52 X0 Y0 Z0",
            r.choice(["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"])])
        if "R" in choice:  # LinuxCNC 2.9 loses the position where a turn changes under G52 or G92
            self.add("G92.1")
        self.add(choice)

    def state(self):
        r = self.random
        choice = r.randrange(9)
        if choice == 0:
            self.add("G93")
            for _ in range(2):
                self.add(f"G1 X{self.number()} Y{self.number()} F{r.uniform(1, 20):.2f}")
            self.add("G94")
            self.add("F200")
        elif choice == 1:
            self.add("M70")
            self.add(r.choice(["G91 G18", "F77 S500", "G55", "G61"]))
            self.straight()
            self.add("M72")
        elif choice == 2:
            self.add("G90 G49 G80")  # rs274 reads back the last place after M6, with the length that held there
            self.add(f"G0 X{self.number()} Y{self.number()} Z{self.number()}")
            self.add(f"T{r.randint(1, 3)} M6")
            self.add(f"M{r.choice([3, 4])} S{r.randint(100, 5000)}")
        else:
            self.add(r.choice([
                "G17", "G18", "G19", "G90", "G91", f"F{r.randint(20, 900)}", "M5", "M3", "M4", "M8", "G61", "G64 P0.1",
                "G64", f"G4 P{r.uniform(0, 2):.2f}", "G49", "G43", "G43 H2", "G43.1 Z2", "G43.2 H1", "G43 H0",
                f"G90 G53 G0 Z{self.number()}", "G28", "G28.1", "G30.1", f"G28 Z{self.number()}", "(note) G1 X#5420",
                "N100 G1 X5", "g1x1y2z3f100", "X[#5420 + 1]", "/ G1 X1 Y1", "#5=3 #6=#5", "G1 X#5"]))

    def cycle(self):
        r = self.random
        code = r.choice([73, 81, 81, 82, 83, 84, 85, 86, 89])
        plane = "G17" if code == 84 else r.choice(list(PLANES))  # LinuxCNC 2.9 exchanges axes of G84 in G18, G19
        first, second, normal = PLANES[plane][:3]
        self.add(f"{r.choice(['G90', 'G90', 'G91'])} {plane} {r.choice(['G98', 'G99'])}")
        self.add(f"G0 {normal}{self.number(5, 15)}")
        if code in (84, 86):
            self.add("M3 S300")
        words = f" {first}{self.number()} {second}{self.number()} {normal}{self.number(-15, -1)} R{self.number(0.5, 4)}"
        words += f" Q{self.number(0.8, 6)}" if code in (73, 83) else ""
        words += f" P{self.number(0, 1)}" if code in (82, 86, 89) else ""
        self.add(f"G{code}{words}" + (f" L{r.randint(1, 3)}" if r.random() < 0.2 else ""))
        for _ in range(r.randrange(4)):
            self.add(r.choice([f"{first}{self.number()}", f"{first}{self.number()} {second}{self.number()}",
                               f"{second}{self.number()} {normal}{self.number(-15, -1)}",
                               f"{first}{self.number()} R{self.number(0.5, 3)}", f"{first}{self.number()} L2"]))
        self.add("G80")
        self.add("G90 G17")

    def contour(self):
        r = self.random
        self.add("G17 G90 G40")
        self.add(f"G0 X{self.number(-60, -50)} Y{self.number(-60, -50)}")
        self.add(r.choice(["G41", "G42"]) + (f".1 D{r.uniform(1, 3):.2f}" if r.random() < 0.4 else " D3"))
        count, sense = r.randint(3, 6), r.choice([1, -1])
        at = None
        for k in range(count):
            angle, radius = sense * 2 * math.pi * k / count + r.uniform(-0.2, 0.2), r.uniform(20, 40)
            to = radius * math.cos(angle), radius * math.sin(angle)
            if k > 1 and r.random() < 0.3:  # a lead-in may turn back into an arc, which the two take differently
                chord = math.dist(at, to)
                self.add(f"{r.choice(['G2', 'G3'])} X{to[0]:.4f} Y{to[1]:.4f} R{chord * r.uniform(0.55, 1.5):.4f}")
            else:
                self.add(f"G1 X{to[0]:.4f} Y{to[1]:.4f}" + (f" Z{self.number(-3, 3)}" if r.random() < 0.15 else ""))
            at = to
        self.add("G40")
        self.add(f"G1 X{self.number(50, 70)} Y{self.number(50, 70)}")

    def loop(self):
        r = self.random
        self.names += 1
        name = f"o{100 + self.names}" if r.random() < 0.6 else f"o<loop{self.names}>"
        inner, index = f"o{500 + self.names}", f"#{r.randint(21, 29)}"
        move, step = f"G1 X[{index} * 2.5] Y[{index} - 1]", f"{index} = [{index} + 1]"
        blocks = r.choice([
            [f"{name} while [{index} LT {r.randint(1, 4)}]", move, step, f"{name} endwhile"],
            [f"{name} repeat [{r.randint(0, 3)}]", move, step, f"{name} endrepeat"],
            [f"{name} if [{index} EQ {r.randint(0, 1)}]", "G1 X1", f"{name} elseif [1]", "G1 X2", f"{name} else",
             "G1 X3", f"{name} endif"],
            [f"{name} while [1]", move, step, f"{inner} if [{index} GT 2]", f"{name} break", f"{inner} endif",
             f"{name} endwhile"],
            [f"{name} while [{index} LT 3]", step, f"{inner} if [{index} EQ 2]", f"{name} continue",
             f"{inner} endif", move, f"{name} endwhile"]])
        self.add(f"{index} = 0")
        self.lines += blocks

    def call(self):
        r = self.random
        self.names += 1
        name = f"o{200 + self.names}" if r.random() < 0.6 else f"o<part{self.names}>"
        self.head += [f"{name} sub", "G1 X[#1 + 1] Y#2", "#3 = [#1 * 2]", "G0 Z[#3 + 5]", "#<own> = #1", "G1 X#<own>",
                      "#<_shared> = [#2 + 1]", f"{name} endsub [#1 + 0.5]"]
        self.add(f"{name} call " + " ".join(f"[{r.uniform(-9, 9):.2f}]" for _ in range(r.randrange(4))))
        self.add(r.choice(["G1 X#<_value>", "G1 Y#<_shared>", "G1 X#1"]))

    def text(self):
        r = self.random
        self.add(f"G21 G17 G90 G94 G54 G98 {r.choice(['G64 P0.02', 'G61', 'G64 P0.05 Q0.01'])}")
        for k in range(1, 31):
            self.add(f"#{k} = {self.number(-9, 9)}")
        self.add(f"T{r.randint(1, 3)} M6")
        self.add(r.choice(["G43", "G43 H2", "G43.1 Z3.5", "G49"]))
        self.add(f"M{r.choice([3, 4])} S{r.randint(100, 5000)} F{r.randint(50, 900)}")
        self.add(f"G0 X{self.number()} Y{self.number()} Z{self.number(5, 20)}")
        self.add("G28.1 ")
        self.add("G30.1")
        steps = [self.straight] * 5 + [self.arc_by_centre, self.arc_by_radius, self.offsets, self.state] * 2 + [
            self.cycle, self.contour, self.loop, self.call]
        for _ in range(r.randint(15, 30)):
            r.choice(steps)()
        return "\n".join(self.head + self.lines + ["M2", ""])


if __name__ == "__main__":
    folder, first, last = pathlib.Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    for seed in range(first, last):
        (folder / f"random_{seed:02}.ngc").write_text(Program(seed).text())
