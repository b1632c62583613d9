"""Programs as shops write them: modal words, tool changes, canned cycles, and the passes that jobs have in common.

Lengths in mm, angles in degrees. Paths are those of the tool's centre unless G41 says otherwise. A pass clears what its
docstring says, and its last contour is the wall itself: programs are right by construction."""
import math

SAFE = 50.0  # height of retracts between tools
NEAR = 2.0   # height above the work from which a tool is fed


def number(value, digits=4):
    text = f"{value:.{digits}f}".rstrip("0")
    return "0." if text in ("-0.", "0.") else text


class Program:
    """Lines of a program; words that do not change are left out, as posts do."""

    def __init__(self, title, o_number, unit=1.0, words="G17 G21 G40 G49 G80 G90 G94"):
        self.unit, self.digits = unit, 4 if unit == 1.0 else 6
        self.lines = ["%", f"O{o_number} ({title.upper()})", words, "G54"]
        self.at = {"X": None, "Y": None, "Z": None}
        self.feed_now = None
        self.code = None
        self.marks = {}
        self.tool = None

    # -- words --------------------------------------------------------------------------------------------------
    def raw(self, text):
        self.lines.append(text)

    def forget(self):
        """After a cycle or a subprogram: all words are written again."""
        self.at = {"X": None, "Y": None, "Z": None}
        self.code = self.feed_now = None

    def mark(self, name):
        """The line of the next block, as place of a fault: first and last line under a name."""
        line = len(self.lines) + 1
        first, _ = self.marks.get(name, (line, line))
        self.marks[name] = (first, line)

    def mark_end(self, name):
        first, _ = self.marks[name]
        self.marks[name] = (first, len(self.lines))

    def _word(self, letter, value):
        return letter + number(value / self.unit, self.digits)

    def _axes(self, **axes):
        words = []
        for letter, value in axes.items():
            if value is None:
                continue
            word = self._word(letter, value)
            if self.at.get(letter) == word:
                continue
            self.at[letter] = word
            words.append(word)
        return words

    def _block(self, code, words, feed=None):
        if code != self.code:
            words.insert(0, code)
            self.code = code
        if feed is not None and feed != self.feed_now:
            words.append("F" + number(feed / self.unit, 1 if self.unit == 1.0 else 2))
            self.feed_now = feed
        if words and words != [code]:
            self.lines.append(" ".join(words))

    def rapid(self, x=None, y=None, z=None):
        self._block("G0", self._axes(X=x, Y=y, Z=z))

    def line(self, x=None, y=None, z=None, f=None):
        self._block("G1", self._axes(X=x, Y=y, Z=z), f)

    def arc(self, ccw, x, y, i, j, z=None, f=None):
        """In X Y about (start + (i, j)); with z a helix."""
        words = self._axes(X=x, Y=y, Z=z) + [self._word("I", i), self._word("J", j)]
        self._block("G3" if ccw else "G2", words, f)

    def end(self):
        self.raw("M9")
        self.raw("M5")
        self.raw("G91 G28 Z0.")
        self.raw("G90")
        self.raw("M30")
        self.raw("%")

    def change(self, tool, x, y, rpm, note=""):
        """Tool change, spindle on, to (x, y) at the safe height with the tool's length."""
        if self.tool is not None:
            self.raw("M9")
            self.raw("M5")
        self.tool = tool
        self.forget()
        self.raw(f"({note or tool.note})")
        self.raw(f"T{tool.number} M6")
        self.raw(f"S{rpm} M3")
        self.raw(f"G0 {self._word('X', x)} {self._word('Y', y)}")
        self.raw(f"G43 H{tool.number} {self._word('Z', SAFE)} M8")
        self.at = {"X": self._word("X", x), "Y": self._word("Y", y), "Z": self._word("Z", SAFE)}
        self.code = "G0"

    # -- moves of more than one block -----------------------------------------------------------------------------
    def circle(self, cx, cy, radius, ccw=True, z=None, f=None):
        """Whole circle from where the tool stands, (cx + radius, cy); with z a turn of a helix."""
        words = self._axes(Z=z) if z is not None else []
        words += [self._word("I", -radius)]
        self._block("G3" if ccw else "G2", words, f)

    def helix(self, cx, cy, radius, z_from, z_to, pitch, f, ccw=True):
        """Down (or up) from (cx + radius, cy, z_from) in whole turns of at most the pitch."""
        turns = max(1, math.ceil(abs(z_to - z_from) / pitch - 1e-9))
        for k in range(1, turns + 1):
            self.circle(cx, cy, radius, ccw, z=z_from + (z_to - z_from) * k / turns, f=f)

    def rounded_contour(self, cx, cy, w, h, radius, ccw, f, start=True):
        """Around a rectangle with round corners, from the middle of its lower side and back to it."""
        x, y, s = w / 2 - radius, h / 2 - radius, (1 if ccw else -1)
        bottom, top, right, left = cy - h / 2, cy + h / 2, cx + s * w / 2, cx - s * w / 2
        if start:
            self.line(cx, bottom, f=f)
        self.line(cx + s * x, bottom, f=f)
        if radius > 0:
            self.arc(ccw, right, bottom + radius, 0, radius)
        self.line(right, top - radius)
        if radius > 0:
            self.arc(ccw, cx + s * x, top, -s * radius, 0)
        self.line(cx - s * x, top)
        if radius > 0:
            self.arc(ccw, left, top - radius, 0, -radius)
        self.line(left, bottom + radius)
        if radius > 0:
            self.arc(ccw, cx - s * x, bottom, s * radius, 0)
        self.line(cx, bottom)


def levels(top, bottom, step):
    """Heights of the floors from the top down, equal steps of at most step, the last one exactly the bottom."""
    count = max(1, math.ceil((top - bottom) / step - 1e-9))
    return [round(top + (bottom - top) * k / count, 4) for k in range(1, count + 1)]


def rows(low, high, spacing):
    """Rows from low to high, evenly spaced by at most the spacing, both ends included."""
    if high - low < 1e-9:
        return [(low + high) / 2]
    count = max(1, math.ceil((high - low) / spacing - 1e-9))
    return [low + (high - low) * k / count for k in range(count + 1)]


def face(p, tool, x0, y0, x1, y1, z, rpm=1200, f=900, step=0.7):
    """Faces the rectangle to z: rows along X that run on past both sides by more than the cutter's radius."""
    r = tool.d / 2
    across = rows(y0 + 0.3 * r, y1 - 0.3 * r, 2 * r * step)
    left, right = x0 - r - 2, x1 + r + 2
    p.change(tool, left, across[0], rpm)
    p.rapid(z=z + NEAR)
    p.mark("face")
    p.line(z=z, f=f)
    for k, y in enumerate(across):
        p.line(y=y)
        p.line(x=right if k % 2 == 0 else left, f=f)
    p.mark_end("face")
    p.rapid(z=SAFE)


def zigzag(p, x0, y0, x1, y1, z, spacing, f, plunge=200, above=None):
    """Rows along X inside the rectangle of tool centres, at height z."""
    across = rows(y0, y1, spacing)
    p.rapid(x0, across[0])
    if above is not None:
        p.rapid(z=above)
    p.line(z=z, f=plunge)
    for k, y in enumerate(across):
        p.line(y=y, f=f)
        p.line(x=x1 if k % 2 == 0 else x0, f=f)


def pocket(p, tool, cx, cy, w, h, radius, top, bottom, step, f=600, name="wall", grow=0.0, floor=0.0,
           finish_f=400):
    """A rectangular pocket with round corners: rows at every level, then the wall in one cut at full depth.

    grow: the wall's contour lies outside of the design by this (fault); floor: the last floor is higher by this."""
    r = tool.d / 2
    assert radius >= r and min(w, h) > 2 * r
    spare = max(0.3, 0.3 * (radius - r) + 0.05)
    half_w, half_h = w / 2 - r - spare, h / 2 - r - spare
    heights = levels(top, bottom, step)
    heights[-1] += floor
    for k, z in enumerate(heights):
        if z == heights[-1]:
            p.mark(name + " floor")
        zigzag(p, cx - half_w, cy - half_h, cx + half_w, cy + half_h, z, 1.4 * r, f,
               above=top + NEAR if k == 0 else None)
        p.mark_end(name + " floor") if z == heights[-1] else None
        p.rapid(z=top + NEAR)
    contour_inside(p, tool, cx, cy, w + 2 * grow, h + 2 * grow, radius + grow, heights[-1], top, finish_f, name)


def contour_inside(p, tool, cx, cy, w, h, radius, z, top, f=400, name="wall", clear=True):
    """The wall of a pocket, climb, with arcs in and out; clear: where it begins is cut down to z already."""
    r = tool.d / 2
    lead = min(2.0, (h / 2 - r) * 0.8)
    y = cy - h / 2 + r
    p.rapid(cx - lead, y + lead)
    p.rapid(z=z + NEAR if clear and z + NEAR < top else top + NEAR)
    p.line(z=z, f=200)
    p.arc(True, cx, y, lead, 0, f=f)
    p.mark(name)
    p.rounded_contour(cx, cy, w - 2 * r, h - 2 * r, radius - r, True, f, start=False)
    p.mark_end(name)
    p.arc(True, cx + lead, y + lead, 0, lead)
    p.rapid(z=top + NEAR)


def contour_outside(p, tool, cx, cy, w, h, radius, z, top, f=400, name="wall", lead=4.0):
    """The wall of a boss, climb, with arcs in and out; the tool's centre runs r outside."""
    r = tool.d / 2
    y = cy - h / 2 - r
    p.rapid(cx + lead, y - lead)
    p.rapid(z=z + NEAR if z + NEAR < top else top + NEAR)
    p.line(z=z, f=200)
    p.arc(True, cx, y, -lead, 0, f=f)
    p.mark(name)
    p.rounded_contour(cx, cy, w + 2 * r, h + 2 * r, radius + r, False, f, start=False)
    p.mark_end(name)
    p.arc(True, cx - lead, y - lead, 0, -lead)
    p.rapid(z=top + NEAR)


def circle_inside(p, tool, cx, cy, radius, z, top, f=400, name="circle"):
    """Finishing circle of a bore at height z, from its middle by half circles; p starts anywhere above."""
    r = tool.d / 2
    run = radius - r
    p.rapid(cx, cy)
    p.rapid(z=z + NEAR if z + NEAR < top else top + NEAR)
    p.line(z=z, f=200)
    p.arc(True, cx + run, cy, run / 2, 0, f=f)
    p.mark(name)
    p.circle(cx, cy, run, True, f=f)
    p.mark_end(name)
    p.arc(True, cx, cy, -run / 2, 0)
    p.rapid(z=top + NEAR)


def holes(p, code, places, depth, r_plane=2.0, q=None, dwell=None, f=200):
    """A canned cycle at places [(x, y)] or [(x, y, depth)], G99 between them."""
    words = [code, "G99"]
    for k, place in enumerate(places):
        x, y = place[0], place[1]
        z = place[2] if len(place) > 2 else depth
        p.mark(f"hole {k}")
        block = [p._word("X", x), p._word("Y", y)]
        if k == 0 or (len(place) > 2) or len(places[k - 1]) > 2:
            block.append(p._word("Z", z))
        if k == 0:
            block.append(p._word("R", r_plane))
            if q is not None:
                block.append(p._word("Q", q))
            if dwell is not None:
                block.append(f"P{dwell}")
            block.append("F" + number(f / p.unit, 1 if p.unit == 1.0 else 2))
            block = words + block
        p.raw(" ".join(block))
    p.raw("G80")
    p.forget()
    p.rapid(z=SAFE)
