"""What a run has found."""
import dataclasses
import functools
import json
import pathlib
import tempfile
import typing

from . import _swarf


@dataclasses.dataclass(frozen=True)
class Finding:
    """Something that is wrong with the part or the program. findings.json has the same names."""

    code: str  #: stable: "gouge", "collision", ...
    severity: str  #: "error", "warning", "note"
    check: typing.Optional[str]  #: the check of the verdict that it belongs to
    text: str  #: what was found, with units
    fix: str  #: what would help; may be empty
    file: str  #: of the program
    line: int  #: in it; 0: not tied to one
    line_last: int  #: of a row of blocks the last one's, else `line`
    block: str  #: its text
    t_s: typing.Optional[float]  #: program time, s
    earlier: typing.Optional[dict]  #: file and line of an earlier set-up's block that cut the place
    place_mm: typing.Optional[typing.List[float]]  #: on the part, in the work frame, where it is worst
    machine_place_mm: typing.Optional[typing.List[float]]  #: of a contact, in the machine at t_s
    number: int  #: of its fault in the page: report.html#finding-N


class Picture:
    """A PNG; notebooks show it by themselves."""

    def __init__(self, png):
        self.png = png  #: bytes of the file

    def save(self, path):
        """Writes the file."""
        pathlib.Path(path).write_bytes(self.png)

    def _repr_png_(self):
        return self.png

    def __repr__(self):
        return f"<swarf.Picture, {len(self.png)} bytes of PNG>"


class Result:
    """A finished run, all in memory.

    metrics    the numbers of metrics.json, as a dictionary; units stand in the names
    findings   list of Finding, the most severe first
    warnings   what was said of the input, as dictionaries with code, file, line, column, text, fix
    """

    def __init__(self, run):
        self._run = run
        self.metrics = json.loads(run.metrics())
        self.findings = [Finding(**one) for one in json.loads(run.findings())]
        self.warnings = run.told()

    @property
    def verdict(self):
        """"pass": no check fails and none is open; else "findings"."""
        return self.metrics["verdict"]

    @property
    def verdict_text(self):
        """The verdict in a sentence, with what was not judged."""
        return self.metrics["verdict_text"]

    @functools.cached_property
    def blocks(self):
        """One row for each block: the columns of blocks.csv as arrays, by name (tip_x_mm, axis_X_mm, t_s, ...)."""
        return self._run.blocks()

    @functools.cached_property
    def rays(self):
        """The measuring rays as arrays by name: point_mm and normal (n x 3, work frame), deviation_um (above the
        design positive, below it negative), area_mm2, line (of the program; 0: nothing has cut there), face. Without
        a design they are empty."""
        return self._run.rays()

    def picture(self, kind="part", camera="", size=None, samples=0):
        """Draws it now: kind "part", "deviation", "machine" or "fan"; camera "iso", "front", "left", "top", ... or
        "x,y,z" towards the eye; size (width, height) in pixels; samples: rays per pixel."""
        request = _swarf.PictureRequest()
        request.kind, request.camera, request.samples = kind, camera, samples
        if size is not None:
            request.width, request.height = size
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "picture.png")
            self._run.save_picture(request, str(path))
            return Picture(path.read_bytes())

    def __repr__(self):
        return f"<swarf.Result: {self.verdict_text}>"
