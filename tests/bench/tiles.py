#!/usr/bin/env python3
"""How well `swarf run --tiles` shares a run: the wave by one process of one thread and by P ranks of one thread.

tiles.py SWARF [--blocks N] [--voxel MM] [--ranks 2 4] [--repeats R] [--weak | --scene FILE] [--set KEY=VALUE ...]
  strong (default): the same wave for all; --weak: N blocks and a stock of the same area for each rank; --scene: another job.
In turn, R times each; medians. Of each run: seconds by the clock, processor time of all processes and of the busiest one.
  efficiency by the clock    t(1) / (P t(P))   (weak: t(1) / t(P)); says something where nobody else uses the cores
  efficiency by processors   the same of the busiest rank's processor time: what the clock would say on P cores of its own,
                             but for the time in which ranks wait for each other
  overhead                   processor time of all ranks / that of one process (weak: of P such processes)
The hashes of one wave must be equal; the script fails where they are not.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

here = os.path.dirname(os.path.abspath(__file__))


def write_wave(folder, blocks, voxel, width):
    subprocess.run([sys.executable, os.path.join(here, "wave.py"), str(blocks), folder, str(voxel), str(width), "62", "12"],
                   check=True)


def seconds_of(text):
    """The second line of sh's `times`: user and system time of its children."""
    total = 0.0
    for part in text.split("\n")[1].split():
        minutes, rest = part.rstrip("s").split("m")
        total += 60.0 * float(minutes) + float(rest)
    return total


def run(swarf, folder, ranks, scene, keys):
    out = os.path.join(folder, "out")
    command = f'"{swarf}" run "{scene or folder + "/scene.toml"}" {keys} --no-render --threads 1 --keep-every 0 -q -o "{out}"'
    start = time.monotonic()
    if ranks == 1:
        own = f'{command}; code=$?; times > "{folder}/times.0"; exit $code'
        done = subprocess.run(["sh", "-c", own], capture_output=True, text=True)
    else:
        own = f'{command} --tiles; code=$?; times > "{folder}/times.$OMPI_COMM_WORLD_RANK"; exit $code'
        root = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        done = subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), "sh", "-c", own],
                              capture_output=True, text=True, env=root)
    wall = time.monotonic() - start
    if done.returncode not in (0, 1):
        sys.exit(f"{ranks} ranks: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    cpu = [seconds_of(open(os.path.join(folder, f"times.{n}")).read()) for n in range(ranks)]
    metrics = json.load(open(os.path.join(out, "metrics.json")))
    return {"wall": wall, "all": sum(cpu), "busiest": max(cpu), "hash": metrics["stock"]["hash"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("swarf")
    parser.add_argument("--blocks", type=int, default=20000)
    parser.add_argument("--voxel", type=float, default=0.1)
    parser.add_argument("--ranks", type=int, nargs="+", default=[2])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--weak", action="store_true")
    parser.add_argument("--scene")
    parser.add_argument("--set", nargs="+", default=[])
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as home:
        counts = [1] + options.ranks
        folders, found = {}, {count: [] for count in counts}
        for count in counts:
            folders[count] = os.path.join(home, str(count))
            grown = count if options.weak else 1
            os.makedirs(folders[count])
            if options.scene is None:
                write_wave(folders[count], options.blocks * grown, options.voxel, 12 + 100 * grown)
        keys = " ".join(f"--set '{key}'" for key in options.set)
        for _ in range(options.repeats):
            for count in counts:
                found[count].append(run(options.swarf, folders[count], count, options.scene, keys))
        median = {count: {key: statistics.median(one[key] for one in found[count]) for key in ("wall", "all", "busiest")}
                  for count in counts}
        print("ranks  clock s  processors s  busiest s  efficiency: clock  processors  overhead")
        for count in counts:
            mine, alone = median[count], median[1]
            share = 1 if options.weak else count
            whole = count if options.weak else 1
            print(f"{count:5d}  {mine['wall']:7.2f}  {mine['all']:12.2f}  {mine['busiest']:9.2f}"
                  f"  {100 * alone['wall'] / (share * mine['wall']):17.1f}%  {100 * alone['busiest'] / (share * mine['busiest']):9.1f}%"
                  f"  {mine['all'] / (whole * alone['all']):8.3f}")
        hashes = {one["hash"] for count in counts for one in found[count]}
        if not options.weak and len(hashes) != 1:
            sys.exit(f"the hashes differ: {hashes}")


main()
