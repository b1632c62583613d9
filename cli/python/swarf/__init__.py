"""Swarf from Python: 5-axis NC simulation that measures what it cuts.

    import swarf
    result = swarf.run("scenes/exact_gouges/scene.toml")
    result.verdict, result.findings[0].line, result.rays["deviation_um"].min()
"""
import os
import shlex

from . import _swarf
from ._swarf import __version__
from .result import Finding, Picture, Result
from .scene_text import override_texts, toml_text

__all__ = ["Error", "Finding", "Picture", "Result", "run", "toml_text", "__version__"]


class Error(Exception):
    """The input is wrong: "file:line:column: error: ..." and the remedy for each mistake.

    diagnostics   the same as dictionaries with code, severity, file, line, column, text, fix
    """

    def __init__(self, text, diagnostics=()):
        super().__init__(text)
        self.diagnostics = list(diagnostics)


def run(scene, out=None, progress=None, *, render=True, threads=0, **overrides):
    """Simulates a scene and measures the part.

    scene      path of a scene.toml, or a dictionary with its keys; paths in a dictionary are those of the current
               folder, and messages name the lines of toml_text(scene)
    out        folder for the files that `swarf run` writes; None: nothing is written
    progress   called as progress(stage, done, total, unit) about ten times a second; what it raises stops the run
    render     with out: pictures, page and glTF too
    threads    0: all cores; results do not depend on it
    overrides  keys that replace those of the scene: stock={"voxel_mm": 0.1} or **{"stock.voxel_mm": 0.1}

    Returns a Result. Raises Error for input that is wrong, KeyboardInterrupt after Ctrl-C: a run that is stopped
    before its results are written leaves nothing, and an earlier result stands as it was.
    """
    request = _swarf.RunRequest()
    if isinstance(scene, dict):
        request.toml = toml_text(scene)
    else:
        scene = request.file = os.fspath(scene)
    request.overrides = list(override_texts(overrides))
    request.output = "" if out is None else os.fspath(out)
    request.render, request.threads = bool(render), threads
    request.command = _command(scene, request.output, overrides)
    return Result(_swarf.run(request, progress))


def _command(scene, output, overrides):
    """The same run from a shell; the report shows it."""
    more = f", **{overrides!r}" if overrides else ""
    return shlex.join(["python3", "-c", f"import swarf; swarf.run({scene!r}, {output!r}{more})"])
