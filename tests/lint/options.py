#!/usr/bin/env python3
"""Every option of the command line is run by a test: its name stands in a test, beside the command or behind it."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

OPTION = re.compile(r'add_(?:option|flag|flag_callback|flag_function)\(\s*"([^"]+)"|set_version_flag\("([^"]+)"')


def options():
    """(file, line, name) of each option that begins with --."""
    for path in sorted((ROOT / "cli").glob("*.cpp")):
        text = path.read_text()
        for found in OPTION.finditer(text):
            for name in (found.group(1) or found.group(2)).split(","):
                if name.startswith("--"):
                    yield path.relative_to(ROOT).as_posix(), text.count("\n", 0, found.start()) + 1, name


def tested():
    """The text of all tests that run the program."""
    return "\n".join(
        path.read_text()
        for path in sorted((ROOT / "tests").rglob("*.cpp"))
        if "run_swarf" in path.read_text() or "SWARF_PROGRAM" in path.read_text()
    )


def problems():
    tests = tested()
    for place, line, name in options():
        if not re.search(re.escape(name) + r"(?![\w-])", tests):
            yield f"{place}:{line}: no test runs {name}: add one to tests/scenes"


found = list(problems())
print("\n".join(found)) if found else None
sys.exit(1 if found else 0)
