#!/usr/bin/env python3
"""What a late block of a long program costs beside an early one, in processor time of the shipped program.

tests/bench/late_blocks.py [--swarf build/release/cli/swarf] [--lines 1000000] [--windows 10]

The program works over the same area from its first line to its last: rows of a wave over 60 x 40 mm, again and again.
  reading   `swarf check --no-drive` of no line, of half the program and of all of it, in turn: medians of user and
            system time; the second half against the first
  moving    `swarf run`: the processor clock of the process at each line of its progress, between which the windows
  cutting   are interpolated; the last window against the first
Processor time counts what the machine does for this process alone, but what others leave of the caches shows in it.
"""
import argparse
import math
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time


def write_program(path, lines):
    with open(path, "w", encoding="ascii") as out:
        out.write("%\nG21 G90 G17 G54\nT1 M6\nS8000 M3\nG0 X0 Y0 Z20\nG1 Z5 F1000\n")
        x, y, step = 0, 0, 1
        for _ in range(lines):
            x += step
            if not 0 <= x <= 60:
                step = -step
                x += step
                y = (y + 1) % 41
            out.write(f"G1 X{x:.3f} Y{y:.3f} Z{5 - 0.5 * math.sin(x / 9) * math.cos(y / 7):.4f}\n")
        out.write("G0 Z20\nM30\n%\n")


def reading_seconds(swarf, program):
    """User and system time of one check."""
    child = subprocess.Popen([swarf, "check", program, "--no-drive", "--tools", "T1=6"],
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise SystemExit(f"swarf check ended with {child.returncode}")
    return usage.ru_utime + usage.ru_stime


def read_halves(swarf, folder, lines, repeats):
    programs = {}
    for part in (0, lines // 2, lines):
        programs[part] = str(folder / f"read_{part}.nc")
        write_program(programs[part], part)
    times = {part: [] for part in programs}
    for _ in range(repeats):
        for part, program in programs.items():
            times[part].append(reading_seconds(swarf, program))
    none, half, all_ = (statistics.median(times[part]) for part in programs)
    early, late = half - none, all_ - half
    print(f"reading   first half {early:.3f} s, second half {late:.3f} s: {late / early:.3f}")


def process_clock(pid):
    """Id of another process's processor clock: MAKE_PROCESS_CPUCLOCK(pid, CPUCLOCK_SCHED) of Linux."""
    return (~pid << 3) | 2


def progress_marks(swarf, program, folder, voxel):
    """By stage: blocks done, and the processor time of the process until then."""
    child = subprocess.Popen(
        [swarf, "run", program, "--tools", "T1=6", "--no-render", "--trajectory", "none", "--voxel", str(voxel),
         "--threads", "1", "--keep-every", "0", "-o", str(folder / "out")],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    clock, marks, begun = process_clock(child.pid), {}, 0.0
    for line in child.stderr:
        seconds = time.clock_gettime(clock)
        going = re.match(r"(interpolate|cut) +\d+ %  (\d+) of (\d+)", line)
        over = re.match(r"(interpolate|cut) +[\d.]+ s$", line.rstrip())
        if going:
            total = int(going[3])
            marks.setdefault(going[1], [(0, begun)]).append((int(going[2]), seconds))
        elif over and over[1] in marks:
            marks[over[1]].append((total, seconds))
        if not going:
            begun = seconds
    if child.wait() not in (0, 1):
        raise SystemExit(f"swarf run ended with {child.returncode}")
    return marks


def at(marks, done):
    """Processor time when so many were done: on the line through the marks beside it."""
    for (a, ta), (b, tb) in zip(marks, marks[1:]):
        if a <= done <= b and b > a:
            return ta + (tb - ta) * (done - a) / (b - a)
    raise SystemExit(f"no progress around block {done}")


def compare_windows(name, marks, windows):
    if len(marks) < windows:
        print(f"{name:9} not measured: {len(marks)} lines of progress, take more lines or a finer voxel")
        return
    total = marks[-1][0]
    times = [at(marks, k * total // windows) for k in range(windows + 1)]
    costs = [1e6 * windows * (after - before) / total for before, after in zip(times, times[1:])]
    print(f"{name:9} us a block, {windows} windows of {total // windows} blocks: "
          + ", ".join(f"{cost:.2f}" for cost in costs))
    print(f"          last window against first {costs[-1] / costs[0]:.3f}")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--swarf", default="build/release/cli/swarf")
    options.add_argument("--lines", type=int, default=1_000_000)
    options.add_argument("--windows", type=int, default=10)
    options.add_argument("--voxel", type=float, default=0.5)
    options.add_argument("--repeats", type=int, default=9)
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = str(folder / "late.nc")
        read_halves(given.swarf, folder, given.lines, given.repeats)
        write_program(program, given.lines)
        marks = progress_marks(given.swarf, program, folder, given.voxel)
        compare_windows("moving", marks.get("interpolate", []), given.windows)
        compare_windows("cutting", marks.get("cut", []), given.windows)


if __name__ == "__main__":
    main()
