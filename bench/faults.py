#!/usr/bin/env python3
"""What becomes of a run in whose middle something goes wrong: faults.py [options] PROGRAM SEQUENCE... [-- options of `ldso run`]

Makes damaged copies of each sequence (which needs ground truth for every frame, in TUM-mono's layout as `ldso simulate`
writes it), runs them and compares each pose with the truth, aligned on what lies before the fault. A pose is wrong if it
is off by more than 3 % of the scene's depth or by 3 degrees. One line a run (also DIR/runs.tsv), then a table by kind.

  wrong     frames with a wrong pose
  missing   frames without a pose though the images show the scene (all but the fault's own, where it hides it)
  resumes   frames from the end of the fault to the first pose in the map of before; - if there is none
  ate       of the frames of the main map, as a multiple of the undisturbed run's
  parts     maps in the end: 1 if the one of after was joined to the one of before"""

import argparse
import collections
import json
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from PIL import Image, ImageFilter
except ImportError as error:
    sys.exit(f"faults.py: {error}; install python3-numpy and python3-pil")

WRONG_SHARE = 0.03  # of the depth of the scene
WRONG_DEGREES = 3.0
WORST_RATIO = 2.0  # of the ATE to the undisturbed run's, or
EXACT_SHARE = 0.001  # of the path: so little is no harm


def rows(path):
    return [line.split() for line in open(path) if line.strip() and not line.startswith("#")]


class Sequence:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()
        self.name = self.folder.name
        self.times = rows(self.folder / "times.txt")
        self.truth = rows(self.folder / "groundtruth.txt")
        self.images = sorted((self.folder / "images").iterdir())
        if not len(self.times) == len(self.truth) == len(self.images):
            sys.exit(f"faults.py: {folder}: images, times and ground truth differ in number")
        self.interval = float(self.times[1][1]) - float(self.times[0][1])
        response = self.folder / "pcalib.txt"
        self.irradiance = np.array(rows(response)[0] if response.exists() else range(256), float)

    def lit(self, image, factor):
        """With so many times the light: what the camera's response makes of it."""
        return np.interp(factor * self.irradiance[image.astype(np.uint8)], self.irradiance, range(256))


class Damage:
    """Frames as they are shown: indices of the sequence's, their times, and what is done to their images."""

    def __init__(self, sequence, rng):
        n = len(sequence.images)
        self.sequence, self.rng = sequence, rng
        self.start = int(n * rng.uniform(0.35, 0.65))
        self.shown = list(range(n))
        self.changes = {}  # position -> function of an image (floats) and the generator, or bytes of the file
        self.hides = False  # the frames that are changed show nothing of the scene
        self.exposure = 1  # factor on the exposure time that is told with the frames that are changed
        self.gaps = {}  # position -> seconds added to the times from there on
        self.length = 0

    def cut(self, seconds):
        k = round(seconds / self.sequence.interval)
        del self.shown[self.start:self.start + k]

    def swap(self):
        n, k = len(self.shown), self.start
        self.shown = [*range(k), *range((k + n) // 2, n), *range(k, (k + n) // 2)]

    def change(self, seconds, function, hides=False, exposure=1):
        self.exposure = exposure
        self.length = max(1, round(seconds / self.sequence.interval))
        self.hides = hides
        for i in range(self.start, self.start + self.length):
            self.changes[i] = function

    def freeze(self, seconds):
        self.length = round(seconds / self.sequence.interval)
        for i in range(self.start, self.start + self.length):
            self.shown[i] = self.start
        self.hides = True

    def write(self, folder):
        (folder / "images").mkdir(parents=True)
        for name in ("camera.txt", "pcalib.txt", "vignette.png"):
            if (self.sequence.folder / name).exists():
                shutil.copy(self.sequence.folder / name, folder)
        late = 0.0
        noise = np.random.default_rng(self.rng.randrange(1 << 30))
        with open(folder / "times.txt", "w") as times, open(folder / "groundtruth.txt", "w") as truth:
            for k, i in enumerate(self.shown):
                late += self.gaps.get(k, 0)
                time = f"{k * self.sequence.interval + late:.9f}"
                exposure = [float(x) * (self.exposure if k in self.changes else 1) for x in self.sequence.times[i][2:]]
                times.write(" ".join([f"{k:06d}", time, *(f"{x:.6f}" for x in exposure)]) + "\n")
                truth.write(" ".join([time, *self.sequence.truth[i][1:]]) + "\n")
                self.write_image(folder / "images" / f"{k:06d}{self.sequence.images[i].suffix}", k, i, noise)

    def write_image(self, path, k, i, noise):
        source = self.sequence.images[i]
        change = self.changes.get(k)
        if change is None:
            os.symlink(source, path)
        elif isinstance(change, bytes):
            path.write_bytes(change)
        else:
            image = np.asarray(Image.open(source).convert("L")).astype(float)
            Image.fromarray(np.clip(np.rint(change(image, noise)), 0, 255).astype(np.uint8)).save(path)


def hand(share):
    def cover(image, noise):
        width = round(share * image.shape[1])
        image = image.copy()
        image[:, :width] = 25 + 4 * noise.standard_normal((image.shape[0], width))
        return image
    return cover


def blur(radius):
    def smear(image, noise):
        return np.asarray(Image.fromarray(image.astype(np.uint8)).filter(ImageFilter.BoxBlur(radius))).astype(float)
    return smear


KINDS = {
    "cut_1s": lambda d: d.cut(1),
    "cut_3s": lambda d: d.cut(3),
    "swapped": lambda d: d.swap(),
    "black_5": lambda d: d.change(5 * d.sequence.interval, lambda a, r: 0 * a + 1, True),
    "black_1s": lambda d: d.change(1, lambda a, r: 0 * a + 1, True),
    "dark_noise_1s": lambda d: d.change(1, lambda a, r: 3 + 2 * r.standard_normal(a.shape), True),
    "white_5": lambda d: d.change(5 * d.sequence.interval, lambda a, r: 0 * a + 255, True),
    "white_1s": lambda d: d.change(1, lambda a, r: 0 * a + 255, True),
    "hand_whole": lambda d: d.change(1.3, hand(1.0), True),
    "hand_most": lambda d: d.change(1.3, hand(0.85), True),
    "hand_half": lambda d: d.change(1.3, hand(0.5)),
    "bright_2.5": lambda d: d.change(1, lambda a, r: d.sequence.lit(a, 2.5)),
    "dim_8": lambda d: d.change(1, lambda a, r: d.sequence.lit(a, 1 / 8)),
    "exposure_8": lambda d: d.change(1, lambda a, r: d.sequence.lit(a, 1 / 8), exposure=1 / 8),
    "exposure_step": lambda d: d.change(1e6, lambda a, r: d.sequence.lit(a, 0.4)),
    "flicker": lambda d: d.change(1, lambda a, r: d.sequence.lit(a, r.uniform(0.5, 1.5))),
    "frozen_3": lambda d: d.freeze(3 * d.sequence.interval),
    "frozen_2s": lambda d: d.freeze(2),
    "blur_4": lambda d: d.change(1, blur(4)),
    "blur_10": lambda d: d.change(1, blur(10)),
    "noise_40": lambda d: d.change(1, lambda a, r: a + 40 * r.standard_normal(a.shape)),
    "upside_down": lambda d: d.change(0.5, lambda a, r: a[::-1, ::-1], True),
    "mirrored": lambda d: d.change(0.5, lambda a, r: a[:, ::-1], True),
    "other_size": lambda d: d.change(5 * d.sequence.interval, lambda a, r: a[:-8, :-8], True),
    "unreadable": lambda d: d.change(5 * d.sequence.interval, b"no image", True),
    "time_gap": lambda d: d.gaps.update({d.start: 5.0}),
    "late_clock": lambda d: d.gaps.update({d.start: 0.9 * d.sequence.interval, d.start + 1: -0.9 * d.sequence.interval}),
}


def rotation(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def similarity(p, q):
    """Umeyama: s, R, t with q = s R p + t."""
    a, b = p - p.mean(0), q - q.mean(0)
    u, d, v = np.linalg.svd(b.T @ a)
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ v))])
    r = u @ sign @ v
    s = (d * np.diag(sign)).sum() / max((a ** 2).sum(), 1e-12)
    return s, r, q.mean(0) - s * r @ p.mean(0)


def pose_similarity(found, truth):
    """The same from poses, rotations from rotations: the positions of a straight way leave its roll open."""
    u, _, v = np.linalg.svd(sum(rotation(b[3:]) @ rotation(a[3:]).T for a, b in zip(found, truth)))
    r = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ v))]) @ v
    p, q = (np.array([x[:3] for x in poses]) for poses in (found, truth))
    a, b = (p - p.mean(0)) @ r.T, q - q.mean(0)
    s = (a * b).sum() / max((a ** 2).sum(), 1e-12)
    return s, r, q.mean(0) - s * r @ p.mean(0)


def poses(path):
    return {float(f[0]): np.array(f[1:], float) for f in rows(path)} if path.exists() else {}


def judge(folder, out, damage, depth):
    """Figures of one run: see the description of the program."""
    truth = [np.array(f[1:], float) for f in rows(folder / "groundtruth.txt")]
    times = np.array([float(f[0]) for f in rows(folder / "groundtruth.txt")])
    found = {}
    for time, pose in poses(out / "trajectory.txt").items():
        found[int(np.argmin(abs(times - time)))] = pose
    end = damage.start + damage.length
    anchors = [k for k in found if k < damage.start]
    if len(anchors) < 30:  # The map of after the fault is the larger one.
        anchors = [k for k in found if k >= end]
    if len(anchors) < 10:
        return {"wrong": len(found), "missing": len(truth), "resumes": None, "ate": float("inf"), "path": 0.0}
    s, r, t = pose_similarity([found[k] for k in anchors], [truth[k] for k in anchors])
    wrong = 0
    for k, pose in found.items():
        off = np.linalg.norm(s * r @ pose[:3] + t - truth[k][:3])
        relative = (r @ rotation(pose[3:])).T @ rotation(truth[k][3:])
        angle = np.degrees(np.arccos(np.clip((np.trace(relative) - 1) / 2, -1, 1)))
        wrong += off > WRONG_SHARE * depth or angle > WRONG_DEGREES
    first = min(found)
    shows = [k for k in range(first, len(truth)) if not (damage.hides and damage.start <= k < end)]
    after = [k for k in found if k >= end]
    p, q = (np.array([x[k][:3] for k in sorted(found)]) for x in (found, truth))
    s, r, t = similarity(p, q)
    path = float(np.linalg.norm(np.diff(q, axis=0), axis=1).sum())
    ate = float(np.sqrt(((s * p @ r.T + t - q) ** 2).sum(1).mean()))
    return {"wrong": wrong, "missing": sum(k not in found for k in shows),
            "resumes": min(after) - end if after else None, "ate": ate, "path": path}


def run(program, folder, out, options):
    done = subprocess.run([program, "run", folder, "-o", out, "--no-report", *options], capture_output=True, text=True)
    (out / "run.log").write_text(done.stdout + done.stderr)
    parts = 0
    if (out / "run.json").exists():
        parts = 1 + len(json.loads((out / "run.json").read_text())["segments"])
    broken = any("nan" in line or "inf" in line for line in
                 ((out / "trajectory.txt").read_text().split("\n") if (out / "trajectory.txt").exists() else []))
    return done.returncode, parts, broken


def campaign(a):
    out = pathlib.Path(a.o or tempfile.mkdtemp(prefix="ldso_faults."))
    out.mkdir(parents=True, exist_ok=True)
    results = collections.defaultdict(list)
    with open(out / "runs.tsv", "w") as table:
        def say(*fields):
            line = "\t".join(str(f) for f in fields)
            print(line, flush=True)
            table.write(line + "\n")
        say("kind", "sequence", "seed", "frames", "wrong", "missing", "resumes", "ate_m", "ratio", "parts", "exit")
        for folder in a.sequences:
            sequence = Sequence(folder)
            reference = judge_kind(a, out, sequence, "undisturbed", 0, lambda d: None)
            say("undisturbed", sequence.name, 0, len(sequence.images), *fields_of(reference, reference))
            for kind, fault in KINDS.items():
                if a.kinds and kind not in a.kinds.split(","):
                    continue
                for seed in range(1, a.seeds + 1):
                    figures = judge_kind(a, out, sequence, kind, seed, fault)
                    say(kind, sequence.name, seed, len(sequence.images), *fields_of(figures, reference))
                    results[kind].append((figures, figures["ate"] / reference["ate"]))
    print(summary(results))
    print(f"results in {out}")


def fields_of(figures, reference):
    resumes = "-" if figures["resumes"] is None else figures["resumes"]
    return (figures["wrong"], figures["missing"], resumes, f"{figures['ate']:.5f}",
            f"{figures['ate'] / reference['ate']:.2f}", figures["parts"],
            f"{figures['exit']}{' NAN' if figures['broken'] else ''}")


def judge_kind(a, out, sequence, kind, seed, fault):
    damage = Damage(sequence, random.Random(f"{sequence.name} {kind} {seed}"))
    fault(damage)
    damage.changes = {k: f for k, f in damage.changes.items() if k < len(damage.shown)}
    damage.length = min(damage.length, len(damage.shown) - damage.start)
    work = out / f"{kind}_{sequence.name}_{seed}"
    shutil.rmtree(work, ignore_errors=True)
    (work / "out").mkdir(parents=True)
    damage.write(work / "sequence")
    code, parts, broken = run(a.program, work / "sequence", work / "out", a.options)
    figures = judge(work / "sequence", work / "out", damage, a.depth)
    if not a.keep:
        shutil.rmtree(work / "sequence")
    return {**figures, "exit": code, "parts": parts, "broken": broken}


def summary(results):
    lines = [f"{'kind':14} {'runs':>4} | {'clean':>5} {'worst wrong':>11} | {'one map':>7} | {'resumes: median':>15} "
             f"{'worst':>6} | {'missing':>7} {'worst':>6} | {'ATE ratio':>9} {'worst':>7} | exit"]
    for kind, runs in results.items():
        f = [figures for figures, _ in runs]
        resumes = [1e9 if x["resumes"] is None else x["resumes"] for x in f]
        show = lambda x: "never" if x >= 1e9 else f"{x:.0f}"
        ratios = [ratio for _, ratio in runs]
        codes = sorted({x["exit"] for x in f})
        lines.append(
            f"{kind:14} {len(f):4} | {sum(x['wrong'] == 0 for x in f):5} {max(x['wrong'] for x in f):11} | "
            f"{sum(x['parts'] == 1 for x in f):7} | {show(statistics.median(resumes)):>15} {show(max(resumes)):>6} | "
            f"{statistics.median(x['missing'] for x in f):7.0f} {max(x['missing'] for x in f):6} | "
            f"{statistics.median(ratios):9.2f} {max(ratios):7.2f} | {','.join(map(str, codes))}"
            f"{' NAN' if any(x['broken'] for x in f) else ''}")
    every = [run for runs in results.values() for run in runs]
    clean = sum(x["wrong"] == 0 for x, _ in every)
    accurate = sum(ratio <= WORST_RATIO or x["ate"] <= EXACT_SHARE * x["path"] for x, ratio in every)
    lines.append(f"{len(every)} runs, {clean} without a wrong pose ({100 * clean / max(1, len(every)):.0f} %), {accurate} with an ATE of "
                 f"at most {WORST_RATIO:g} times the undisturbed one or {100 * EXACT_SHARE:g} % of the path")
    return "\n".join(lines)


def main():
    arguments, options = sys.argv[1:], []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", metavar="DIR", help="results (default: a new folder under TMPDIR)")
    parser.add_argument("--kinds", help="only these, separated by commas: " + ", ".join(KINDS))
    parser.add_argument("--seeds", type=int, default=5, help="places and details of the fault that are tried (default 5)")
    parser.add_argument("--depth", type=float, default=2.5, help="of the scene [m] (default 2.5: a room)")
    parser.add_argument("--keep", action="store_true", help="keep the damaged sequences")
    parser.add_argument("program")
    parser.add_argument("sequences", nargs="+")
    a = parser.parse_args(arguments)
    a.options = options
    campaign(a)


if __name__ == "__main__":
    main()
