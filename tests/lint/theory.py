#!/usr/bin/env python3
"""Each "theory n" leads to a heading of engine/theory.md, each erratum "En" to a row of engine/errata.md."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADINGS = set(re.findall(r"^#+ (\d+(?:\.\d+)?) ", (ROOT / "engine/theory.md").read_text(), re.M))
ERRATA = set(re.findall(r"^\| (E\d+) \|", (ROOT / "engine/errata.md").read_text(), re.M))
# An erratum is told from an exponent or a word of a program by what stands around it.
ERRATUM = re.compile(r"(?:errat(?:um|a) |[(\"]|, |to |– ?|of )(E[1-9]\d?)(?=[)\",:.\s–])")

failed = False
listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "engine", "render", "reports", "cli", "tests", "scenes"],
                        cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
for name in listed:
    path = ROOT / name
    if path.suffix not in (".h", ".cpp", ".toml", ".json", ".md", ".py") or not path.exists() or "lint" in path.parts:
        continue
    for number, line in enumerate(path.read_text().splitlines(), 1):
        for found in re.findall(r"\b[Tt]heory (\d+(?:\.\d+)?)\b(?! µm)(?!\.)", line):
            if found not in HEADINGS:
                failed = True
                print(f"{name}:{number}: engine/theory.md has no heading {found}")
        if "toolchain" in line:
            failed = True
            print(f"{name}:{number}: 'toolchain' is no page of the project")
        comment = path.suffix in (".h", ".cpp") and ("//" in line or "reports/" in name)
        for found in ERRATUM.findall(line) if comment and "program" not in path.parts else ():
            if found not in ERRATA:
                failed = True
                print(f"{name}:{number}: engine/errata.md has no {found}")
sys.exit(1 if failed else 0)
