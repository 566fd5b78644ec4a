#!/usr/bin/env python3
"""How fast a run is, stage by stage: speed.py [options] PROGRAM SEQUENCE [-- options of `ldso run`]

Runs the sequence several times and prints medians: frames per second, processor time a frame, peak memory, and for each
stage how often it ran, its mean and its worst time. With --against another program (an older build, say) both run in
turn, and the ratio is that of each pair: machines that are shared get faster and slower by the minute. Nothing else
should run meanwhile."""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time


def measure(program, sequence, options, folder):
    """Figures of one run."""
    out = pathlib.Path(folder) / "run"
    begin, before = time.monotonic(), os.times()
    done = subprocess.run([program, "run", sequence, "-o", out, "--no-report", "--quiet", *options],
                          capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"speed.py: {program} ended with {done.returncode}:\n{done.stderr}")
    after, report = os.times(), json.load(open(out / "run.json"))
    frames = report["counts"]["frames"]
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return {"fps": frames / (time.monotonic() - begin), "cpu_ms": 1e3 * used / frames,
            "memory_mb": report["peak_memory_mb"], "stages": report["timing"]["stages"]}


def median(runs, key):
    return statistics.median(run[key] for run in runs)


def print_runs(name, runs):
    spread = [run["fps"] for run in runs]
    print(f"{name}\n  frames/s {median(runs, 'fps'):.1f} ({min(spread):.1f}-{max(spread):.1f})   "
          f"processor {median(runs, 'cpu_ms'):.2f} ms a frame   peak memory {median(runs, 'memory_mb'):.0f} MB")
    print(f"  {'stage':<28}{'calls':>7}{'mean ms':>10}{'worst ms':>10}{'total ms':>10}")
    for stage, last in sorted(runs[-1]["stages"].items()):
        means, worsts = zip(*[(run["stages"][stage]["mean_ms"], run["stages"][stage]["worst_ms"]) for run in runs])
        mean = statistics.median(means)
        print(f"  {stage:<28}{last['calls']:>7}{mean:>10.3f}{statistics.median(worsts):>10.1f}"
              f"{mean * last['calls']:>10.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[1], usage=__doc__.split("\n")[0].split(": ")[1])
    parser.add_argument("program")
    parser.add_argument("sequence")
    parser.add_argument("--against", help="a program to compare with")
    parser.add_argument("-n", type=int, default=5, help="runs of each (default 5)")
    own, options = sys.argv[1:], []
    if "--" in own:
        own, options = own[:own.index("--")], own[own.index("--") + 1:]
    a = parser.parse_args(own)
    runs, others = [], []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(a.n):
            if a.against:
                others.append(measure(a.against, a.sequence, options, folder))
            runs.append(measure(a.program, a.sequence, options, folder))
    print_runs(a.program, runs)
    if a.against:
        print_runs(a.against, others)
        ratios = sorted(run["fps"] / other["fps"] for run, other in zip(runs, others))
        print(f"frames/s of the first over the second, pair by pair: median {statistics.median(ratios):.2f} "
              f"({ratios[0]:.2f}-{ratios[-1]:.2f})")


main()
