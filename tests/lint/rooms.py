#!/usr/bin/env python3
"""Rooms inside a module, and the size of its classes.

  1. No class has more than 30 methods (constructors, operators and deleted functions are not counted). A class of
     TOO_LARGE may keep what it has; the list only shrinks: it fails as well where a class has fewer methods now.
  2. Inside a module that ROOMS lists, an include leads to a room on the same floor or a lower one, and the number of
     arrows (pairs of rooms, one of which includes the other) stays within its limit.
  3. Only engine/sim/job asks what kind of program a scene has (ProgramKind): elsewhere it is data.

--report prints what was counted."""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
METHODS_MAX = 30

# class: methods that it still has
TOO_LARGE = {
}

# module: (arrows at most, floors from the ground up). A room is a folder; files beside the folders are "ground",
# but for those of the entry, which see everything. "*/dialect.h": every folder that holds this file.
ROOMS = {
    "engine/program": (
        35,
        [
            {"ground"},
            {"control", "surface_blocks"},
            {"letters"},
            {"cl", "*/dialect.h"},
            {"entry"},
        ],
    ),
    "engine/motion": (
        20,
        [{"ground"}, {"speed"}, {"passes"}, {"blocks"}, {"cycles"}, {"judged"}, {"entry"}],
    ),
    "engine/stock": (
        11,
        [{"sweep", "raw"}, {"ground"}, {"level_set"}, {"contact", "rays", "mesher"}],
    ),
    "engine/sim": (
        10,
        [{"ground"}, {"job"}, {"run"}, {"judge"}, {"entry"}],
    ),
}
ENTRY = {
    "engine/program": {"dialects.h", "dialects.cpp", "run_nc.cpp"},
    "engine/motion": {"interpolator.h", "interpolator.cpp"},
    "engine/sim": {"simulation.h", "simulation.cpp", "replay.h", "replay.cpp"},
}

# Includes that still run up, each with its reason; the list only shrinks.
RUNS_UP = {
}


def code_of(path):
    """The text without comments, strings and preprocessor lines."""
    text = path.read_text()
    text = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', " ", text, flags=re.S)
    return re.sub(r"^\s*#.*(?:\\\n.*)*$", "", text, flags=re.M)


def body_end(text, opening):
    """Index behind the brace that closes the one at `opening`."""
    depth = 0
    for i in range(opening, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return i + 1
    return len(text)


def declarations(body):
    """What stands in the body of a class: each declaration without the braces behind it."""
    at, start = 0, 0
    while at < len(body):
        if body[at] == "{":
            yield body[start:at]
            at = start = body_end(body, at)
            continue
        if body[at] == ";":
            yield body[start:at]
            start = at + 1
        at += 1


def is_method(declaration, name):
    flat = re.sub(r"\b(public|protected|private)\s*:", " ", declaration).strip()
    while re.search(r"<[^<>()]*(\([^()]*\)[^<>()]*)*>", flat):
        flat = re.sub(r"<[^<>()]*(\([^()]*\)[^<>()]*)*>", " ", flat)
    if re.match(r"(using|friend|typedef|enum|struct|class|union|static_assert|template\s*$)\b", flat):
        return False
    found = re.search(r"(~?\w+)\s*\(", flat)
    if not found or found.group(1) in (name, "~" + name, "operator", "decltype", "alignas", "noexcept"):
        return False
    if re.search(r"\boperator\b|=\s*(delete|default)\s*$", flat):
        return False
    return "=" not in flat[: found.start()]


def classes():
    """Every class with its place and the number of its methods."""
    for top in ("engine", "render", "reports", "cli"):
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            text = code_of(path)
            for found in re.finditer(r"(?<!enum )\b(?:class|struct)\s+(\w+)(?:\s+final)?\s*(?::[^;{()]*)?\{", text):
                body = text[found.end() : body_end(text, found.end() - 1) - 1]
                count = sum(is_method(one, found.group(1)) for one in declarations(body))
                yield f"{path.relative_to(ROOT).as_posix()}:{found.group(1)}", count


def room_of(module, target):
    parts = target.split("/")
    return parts[0] if len(parts) > 1 else "entry" if parts[0] in ENTRY.get(module, ()) else "ground"


def expanded(module, rooms):
    """The rooms, with the folders that a pattern among them names."""
    for room in rooms:
        yield from (path.parent.name for path in (ROOT / module).glob(room)) if "*" in room else [room]


def includes(module):
    """(file, included file, its room, the included room) inside the module."""
    name = module.split("/")[-1]
    for path in sorted((ROOT / module).rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        own = path.relative_to(ROOT / module).as_posix()
        for found in re.finditer(rf'^\s*#include "({name}/([^"]+))"', path.read_text(), re.M):
            yield f"{module}/{own}", found.group(1), room_of(module, own), room_of(module, found.group(2))


def asks_kind():
    """Lines outside sim/job that ask a job's kind."""
    for top in ("engine", "render", "reports", "cli"):
        for path in sorted((ROOT / top).rglob("*")):
            place = path.relative_to(ROOT).as_posix()
            if path.suffix not in (".h", ".cpp") or place.startswith("engine/sim/job/"):
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if re.search(r"\bProgramKind\b|\bscene\.kind\b", line):
                    yield f"{place}:{number}: asks what kind of program the scene has: only engine/sim/job does"


def problems(report):
    yield from asks_kind()
    sizes = dict(classes())
    for place, count in sorted(sizes.items(), key=lambda one: -one[1]):
        if report and count > 20:
            print(f"{count:4} methods  {place}")
        kept = TOO_LARGE.get(place, METHODS_MAX)
        if count > kept:
            yield f"{place} has {count} methods, {kept} at most: make it a struct and functions that name what they read"
    for place, kept in TOO_LARGE.items():
        if sizes.get(place, 0) < kept:
            yield f"{place} has {sizes.get(place, 0)} methods now: write so in TOO_LARGE, or take it out"
    used = set()
    for module, (limit, floors) in ROOMS.items():
        floor = {room: level for level, rooms in enumerate(floors) for room in expanded(module, rooms)}
        arrows = collections.Counter()
        for place, target, here, there in includes(module):
            for room in (here, there):
                if room not in floor:
                    yield f"{place}: '{room}' is no room of {module}, add it to ROOMS"
                    floor[room] = 0
            if here == there:
                continue
            arrows[here, there] += 1
            if floor[there] <= floor[here]:
                continue
            if (place, target) in RUNS_UP:
                used.add((place, target))
            else:
                yield f"{place} includes {target}, which is a floor above it"
        if report:
            for (here, there), count in sorted(arrows.items()):
                print(f"{count:4} includes  {module}: {here} -> {there}")
            print(f"{len(arrows):4} arrows    {module}")
        if len(arrows) > limit:
            yield f"{module} has {len(arrows)} arrows between its rooms, {limit} at most"
    for place, target in set(RUNS_UP) - used:
        yield f"{place} does not include {target} any more: take it out of RUNS_UP"


found = list(problems("--report" in sys.argv))
print("\n".join(found)) if found else None
sys.exit(1 if found else 0)
