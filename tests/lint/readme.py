#!/usr/bin/env python3
"""A claim names the test that holds it: each test that README.md and the module pages name exists.

A name is `Suite.Test` or `Suite.*` in backquotes, perhaps behind that of its program. Each row of "How accurate" has
one, or links the expected.json of a scene, which `BoundedScene.MeetsExpectedJson` holds."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMED = re.compile(r"`(?:(?:unit_\w+|scenes|image|property|fuzz) )?(?:\w+/)?([A-Z]\w+)\.(\*|[A-Z]\w+)`")
LINKED = re.compile(r"\]\((scenes/\w+/expected\.json)\)")


def tests():
    """(suite, test) of everything in tests/."""
    for path in (ROOT / "tests").rglob("*.cpp"):
        for found in re.finditer(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)", path.read_text(), re.M):
            yield found.group(1), found.group(2)


def accuracy_rows(text):
    """(line number, row) of the tables below "How accurate"."""
    inside = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("## "):
            inside = line == "## How accurate"
        if inside and line.startswith("|") and not re.match(r"\|(---|.*\| held by)", line):
            yield number, line


def problems():
    known = set(tests())
    suites = {suite for suite, _ in known}
    pages = [ROOT / "README.md", ROOT / "tests/README.md", *sorted((ROOT / "engine").rglob("*.md")), *sorted((ROOT / "scenes").glob("*.md"))]
    for page in pages:
        text, place = page.read_text(), page.relative_to(ROOT).as_posix()
        for found in NAMED.finditer(text):
            suite, test = found.groups()
            line = text.count("\n", 0, found.start()) + 1
            if suite not in suites:
                yield f"{place}:{line}: there is no test suite {suite}"
            elif test != "*" and (suite, test) not in known:
                yield f"{place}:{line}: there is no test {suite}.{test}"
        for link in LINKED.findall(text) if page.parent == ROOT else []:
            if not (ROOT / link).exists():
                yield f"{place}: there is no {link}"
    for number, row in accuracy_rows((ROOT / "README.md").read_text()):
        if not NAMED.search(row) and not LINKED.search(row):
            yield f"README.md:{number}: this row names no test that holds it"


found = list(problems())
print("\n".join(found)) if found else None
sys.exit(1 if found else 0)
