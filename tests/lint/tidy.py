#!/usr/bin/env python3
"""clang-tidy over the translation units of build/release: several .cpp compiled as one are also read as one, so that
the headers they share are read once. A unit is read again when one of its .cpp, any header of the project or
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


def units():
    """{translation unit: the project's .cpp that it compiles}, without those of the tests and benchmarks."""
    found = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["file"])
        parts = re.findall(r'#include "([^"]+\.cpp)"', file.read_text()) if file.suffix == ".cxx" else [file]
        parts = [pathlib.Path(one) for one in parts]
        if not any((ROOT / "tests") in one.parents for one in parts):
            found[file] = parts
    return found


def digest(paths):
    total = hashlib.sha256()
    for path in sorted(paths):
        total.update(path.as_posix().encode() + b"\0" + path.read_bytes())
    return total.hexdigest()[:24]


def read(unit):
    return subprocess.run(
        ["clang-tidy", "--quiet", "-p", str(BUILD), str(unit)], capture_output=True, text=True, check=False
    )


def main():
    headers = [ROOT / ".clang-tidy"]
    for top in ("engine", "render", "reports", "cli"):
        headers += (ROOT / top).rglob("*.h")
    common = digest(headers)
    STAMPS.mkdir(parents=True, exist_ok=True)
    stamps = {unit: STAMPS / f"{common}-{digest(parts)}" for unit, parts in units().items()}
    due = [unit for unit, stamp in stamps.items() if not stamp.exists()]
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
