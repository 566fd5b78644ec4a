#!/usr/bin/env python3
"""make_experiment.py OUT [options]: a made-up experiment in the folders of `ldso experiment run`, for tests of what is
drawn from one. Trajectories are ground truth with known drift; the drift of a run depends on its id alone."""

import argparse
import json
import math
import pathlib
import random

parser = argparse.ArgumentParser()
parser.add_argument("out", type=pathlib.Path)
parser.add_argument("--dataset", default="euroc")
parser.add_argument("--metric", default="ate", choices=["ate", "tum_mono"])
parser.add_argument("--sequences", default="MH_01,MH_02,V1_01", help="names, or how many")
parser.add_argument("--variants", default="corners,gradient,random")
parser.add_argument("--repetitions", type=int, default=2)
parser.add_argument("--directions", default="forward,backward")
parser.add_argument("--poses", type=int, default=200)
parser.add_argument("--scale", type=float, default=1.0, help="factor of all errors")
parser.add_argument("--lost", type=float, default=0.0, help="share of runs that lose the camera")
parser.add_argument("--pending", type=float, default=0.0, help="share of runs that have not ended")
options = parser.parse_args()

STEP = 0.1  # [s]


def position(i, n, size):
    """A way that comes back to its start."""
    s = 2 * math.pi * i / (n - 1)
    return [size * math.sin(s), 0.1 * size * math.sin(3 * s), size * (1 - math.cos(s)) * 0.7 + 0.2 * size * math.sin(2 * s)]


def quaternion(i, n):
    half = math.pi * i / (n - 1)
    return [0.0, math.sin(half), 0.0, math.cos(half)]


def line(i, p, q):
    return "%.9f %s %s\n" % (100 + STEP * i, " ".join("%.12g" % v for v in p), " ".join("%.12g" % v for v in q))


def write_truth(path, n, size):
    both_ends = options.metric == "tum_mono"
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w") as file:
        for i in range(n):
            if both_ends and n // 6 <= i < n - n // 6:
                file.write("%.9f nan nan nan nan nan nan nan\n" % (100 + STEP * i))
            else:
                file.write(line(i, position(i, n, size), quaternion(i, n)))


def drifted(n, size, drift, noise, reverse, rng):
    """The positions with a scale and a heading that change on the way, in a world of other scale."""
    order = range(n - 1, -1, -1) if reverse else range(n)
    result = []
    where, last = [0.0, 0.0, 0.0], None
    for k, i in enumerate(order):
        p = position(i, n, size)
        if last is not None:
            turn, scale = drift * k / n, 1 + drift * k / n
            d = [p[j] - last[j] for j in range(3)]
            where = [where[0] + scale * (d[0] * math.cos(turn) + d[2] * math.sin(turn)), where[1] + scale * d[1],
                     where[2] + scale * (d[2] * math.cos(turn) - d[0] * math.sin(turn))]
        last = p
        result.append((i, [0.25 * (w + rng.gauss(0, noise)) for w in where]))
    return result


def write_trajectory(path, poses, n):
    with open(path, "w") as file:
        file.write("# timestamp tx ty tz qx qy qz qw\n")
        for i, p in poses:
            file.write(line(i, p, quaternion(i, n)))


def stage(calls, mean):
    return {"calls": calls, "total_ms": calls * mean, "mean_ms": mean, "worst_ms": 3 * mean}


def run_json(n, posed, lost_at, strategy, loops, rng):
    speed = rng.uniform(0.9, 1.1)
    select = {"corners": 9.0, "gradient": 5.0, "random": 1.5}.get(strategy, 5.0) * speed
    untracked = [{"first": lost_at, "last": n - 1, "reason": "too few points are in view"}] if lost_at is not None else []
    run = {"sequence": {"path": "made up", "frames": n}, "interrupted": False, "error": None,
           "counts": {"frames": n, "frames_with_pose": posed, "keyframes": n // 6, "points": 80 * n, "restarts": 0,
                      "skipped_frames": 0, "loops_closed": 1 if loops else 0, "loop_candidates": 4},
           "timing": {"wall_s": n / 30 * speed, "frames_per_s": 30 / speed,
                      "stages": {"keyframe": stage(n // 6, 90 * speed), "keyframe/select": stage(n // 6, select),
                                 "track": stage(n, 5 * speed)}},
           "peak_memory_mb": 250 + rng.uniform(0, 40), "untracked": untracked, "evaluation": {"problem": "made up"}}
    if loops:
        run["evaluation_odometry"] = {"problem": "made up"}
    return run


def make_job(sequence, number, variant, reverse, repetition):
    direction = "backward" if reverse else "forward"
    job_id = f"{sequence}/{variant}/{direction}_{repetition}"
    folder = options.out / "jobs" / job_id
    folder.mkdir(parents=True, exist_ok=True)
    strategy, loops = variant.split("_")[0], not variant.endswith("no_loops")
    truth = (options.out / "truth" / f"{options.dataset}_{sequence}.txt").resolve()
    job = {"id": job_id, "sequence": sequence, "dataset": options.dataset, "path": "made_up/" + sequence,
           "variant": variant, "strategy": strategy, "loops": loops, "reverse": reverse, "repetition": repetition,
           "metric": options.metric, "ground_truth": str(truth), "arguments": ["run", "made_up/" + sequence]}
    (folder / "job.json").write_text(json.dumps(job))
    rng = random.Random(job_id)
    chance = rng.random()
    if chance < options.pending:
        return
    n, size = options.poses, 5.0 * (1 + number % 4)
    drift = options.scale * 0.02 * math.exp(rng.gauss(0, 0.5)) * (1 + number % 5)
    drift *= {"corners": 1.0, "gradient": 1.2, "random": 1.8}.get(strategy, 1.0)
    poses = drifted(n, size, drift, options.scale * 0.003 * size, reverse, rng)
    lost_at = None
    if chance < options.pending + options.lost:
        lost_at = n // 3
        poses = poses[:lost_at]
    if loops:
        write_trajectory(folder / "trajectory_odometry.txt", poses, n)
        closed = drifted(n, size, 0.25 * drift, options.scale * 0.003 * size, reverse, rng)
        poses = closed[:len(poses)]
    write_trajectory(folder / "trajectory.txt", poses, n)
    (folder / "run.json").write_text(json.dumps(run_json(n, len(poses), lost_at, strategy, loops, rng), indent=2))


names = options.sequences.split(",")
if options.sequences.isdigit():
    names = ["%s_%02d" % ("sequence" if options.dataset != "kitti" else "kitti", i + 1) for i in range(int(options.sequences))]
for number, sequence in enumerate(names):
    write_truth(options.out / "truth" / f"{options.dataset}_{sequence}.txt", options.poses, 5.0 * (1 + number % 4))
    for variant in options.variants.split(","):
        for direction in options.directions.split(","):
            for repetition in range(options.repetitions):
                make_job(sequence, number, variant, direction == "backward", repetition)
