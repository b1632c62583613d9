#!/usr/bin/env python3
"""What the contacts of machine, fixtures and tools cost: each scene's run with its machine, and with the same machine
without meshes, of which nothing can touch. Processor time (user and system), the best of some runs in turn, so that
other work on the machine counts little. Writes a table in Markdown.

  contacts_cost.py build/release/cli/swarf scenes [--runs 3] [--only NAME ...] > reports/perf/contacts.md

Scenes with [post] are left out: their program is written with the machine's contacts in view, and without meshes it
is another one.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import tempfile
import tomllib


def processor_time(words):
    before = os.times()
    done = subprocess.run(words, capture_output=True, text=True)
    after = os.times()
    if done.returncode not in (0, 1):
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return after.children_user + after.children_system - before.children_user - before.children_system


def bare_machine(scene, machine, folder):
    """The machine's file without its meshes."""
    shipped = pathlib.Path(__file__).resolve().parents[2] / "assets/machines" / machine / "machine.toml"
    file = shipped if shipped.exists() else scene.parent / machine
    text = re.sub(r"(?m)^mesh\s*=.*\n", "", file.read_text())
    bare = pathlib.Path(folder, "machine.toml")
    bare.write_text(text)
    return bare


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("program", type=pathlib.Path)
    words.add_argument("scenes", type=pathlib.Path)
    words.add_argument("--runs", type=int, default=3)
    words.add_argument("--only", nargs="*", default=[])
    said = words.parse_args()
    print("| scene | without meshes, s | with contacts, s | cost | pairs | contacts |\n|---|---|---|---|---|---|")
    all_bare = all_with = 0.0
    for scene in sorted(said.scenes.resolve().glob("*/scene.toml")):
        name = scene.parent.name
        keys = tomllib.loads(scene.read_text())
        if (said.only and name not in said.only) or "post" in keys or "machine" not in keys:
            continue
        with tempfile.TemporaryDirectory() as folder:
            bare = bare_machine(scene, keys["machine"], folder)
            run = [said.program.resolve(), "run", scene, "--no-render", "-q", "-o", f"{folder}/out"]
            without, having = [], []
            for _ in range(said.runs):
                without.append(processor_time([*run, "--set", f"machine={bare}"]))
                having.append(processor_time(run))
            found = json.loads(pathlib.Path(folder, "out/metrics.json").read_text())["machine_contacts"]
        without, having = min(without), min(having)
        all_bare += without
        all_with += having
        pairs, count = (len(found["pairs"]), found["count"]) if found else (0, "-")
        print(f"| `{name}` | {without:.2f} | {having:.2f} | {having / without - 1:+.0%} | {pairs} | {count} |",
              flush=True)
    print(f"| all | {all_bare:.1f} | {all_with:.1f} | {all_with / all_bare - 1:+.0%} | | |")


if __name__ == "__main__":
    main()
