#!/usr/bin/env python3
"""clang-tidy over the sources of build/release. Most of its time goes into the headers of libraries, which its checks
walk for every unit: so the .cpp of a target that are compiled several at a time are read as one unit (unity.py has
seen to it that their names do not meet). A unit is read again when one of its .cpp, any header of the project or
.clang-tidy has changed since it was found clean."""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"
STAMPS = ROOT / "build/lint-stamps"
UNITS = ROOT / "build/lint"


def units():
    """{unit: the project's .cpp that it reads}, without those of the tests and benchmarks; units of several .cpp are
    written to build/lint, with the compilation database of all."""
    groups = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["file"])
        parts = re.findall(r'#include "([^"]+\.cpp)"', file.read_text()) if file.suffix == ".cxx" else [entry["file"]]
        if not any(part.startswith(f"{ROOT}/tests/") for part in parts):
            command, target = re.fullmatch(r"(.*) -o (\S+?\.dir)/.*", entry["command"], re.S).groups()
            command = re.sub(r" -mtune-ctrl=\S+", "", command)  # known to gcc alone
            alone = "" if file.suffix == ".cxx" else file.stem
            groups.setdefault((target, alone, command, entry["directory"]), []).extend(parts)
    UNITS.mkdir(parents=True, exist_ok=True)
    found, commands = {}, []
    for number, ((target, alone, command, directory), parts) in enumerate(sorted(groups.items())):
        unit = UNITS / f"{number}_{alone or pathlib.Path(target).stem}.cxx"
        unit.write_text("".join(f'#include "{part}"\n' for part in sorted(parts)))
        commands.append({"directory": directory, "file": str(unit), "command": f"{command} -c {unit}"})
        found[unit] = [pathlib.Path(part) for part in parts]
    (UNITS / "compile_commands.json").write_text(json.dumps(commands))
    return found


def digest(paths):
    total = hashlib.sha256()
    for path in sorted(paths):
        total.update(path.as_posix().encode() + b"\0" + path.read_bytes())
    return total.hexdigest()[:24]


def read(unit):
    return subprocess.run(
        ["clang-tidy", "--quiet", "-p", str(UNITS), str(unit)], capture_output=True, text=True, check=False
    )


def main():
    headers = [ROOT / ".clang-tidy"]
    for top in ("engine", "render", "reports", "cli"):
        headers += (ROOT / top).rglob("*.h")
    common = digest(headers)
    STAMPS.mkdir(parents=True, exist_ok=True)
    stamps = {unit: STAMPS / f"{common}-{digest(parts)}" for unit, parts in units().items()}
    due = [unit for unit, stamp in stamps.items() if not stamp.exists()]
    due.sort(key=lambda unit: -unit.read_text().count("#include"))  # the longest first: no core waits for it at the end
    print(f"lint: clang-tidy: {len(due)} of {len(stamps)} units", flush=True)
    failed = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for unit, result in zip(due, pool.map(read, due)):
            if result.returncode == 0:
                stamps[unit].touch()
                continue
            failed = True
            print(result.stdout.strip() or result.stderr.strip(), flush=True)
    return failed


sys.exit(1 if main() else 0)
