#!/usr/bin/env python3
"""Whether self-calibration mends wrong calibrations, leaves right ones alone and finds those that nobody gave:
calibrations.py [-o DIR] [-k PATTERN] [--kinds right,wrong,unknown] PROGRAM

Renders 64 sequences (kept in DIR/worlds for the next time): 20 are run with their true calibration, half of them where
the motion determines little or nothing (sideways before a plane, straight on, turning, standing), 20 with a wrong one
(focal length 2-10 % off, distortion left out, a rolling shutter that nobody told of, and several of these together),
24 without any (fields of view of 45 to 110 degrees, with and without distortion, a rolling shutter in a third of them).
One line a sequence, also in DIR/runs.json:

  verdict   kept, corrected (and proven) or refused
  focal     error of the focal length before and after [%]
  lens      largest distance between where the lens and the true one show a ray, but for a shift of the image, before
            and after [px]
  readout   error of the readout before and after [ms]
  shrinks   by what factor the error of the lens shrank, or that of the readout if the lens was right
  ate       of an unknown camera, as a multiple of what the true calibration gives

Then: how many right calibrations were changed by more than 0.3 %, how many wrong ones became at least five times
better, and how many focal lengths were found within 1.5 and 5 %."""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

try:
    import numpy as np
except ImportError as error:
    sys.exit(f"calibrations.py: {error}; install python3-numpy")

SIZE = "424x320"
FRAMES = 450
LARGEST_HARM = 0.3  # % of the focal length
LEAST_GAIN = 5.0


def world(name, kind, seed, *options):
    return {"name": f"{name}_{seed}", "render": [kind, "--seed", str(seed), *options]}


def right_calibrations():
    rooms = [world("room", "room", 41), world("room", "room", 42), world("weak", "room", 43, "--style", "weak"),
             world("dark", "room", 44, "--style", "dark"), world("wallpaper", "room", 45, "--style", "wallpaper"),
             world("room_unknown_photometry", "room", 46, "--no-calibration")]
    wide = [world("corridor", "corridor", 41), world("corridor", "corridor", 42), world("street", "street", 41),
            world("window", "window_room", 41)]
    walls = [world(f"wall_{motion}", "wall", seed, "--motion", motion)
             for motion, seeds in {"sideways": (41, 42, 43), "forward": (41, 42, 43), "turning": (41, 42),
                                   "standing": (41, 42)}.items() for seed in seeds]
    return rooms + wide + walls


def wrong_calibrations():
    """Each with what is wrong: a factor of the focal length, distortion left out, readout of the shutter [ms]."""
    def wrong(base, focal=1.0, flat=False, readout=0):
        options = ["--rolling-shutter", str(readout)] if readout else []
        what = [f"f{100 * focal - 100:+.0f}" if focal != 1 else "", "flat" if flat else "",
                f"rs{readout}" if readout else ""]
        name = "_".join([base["name"], *filter(None, what)])
        return {"name": name, "render": base["render"] + options, "focal": focal, "flat": flat, "readout": readout}

    room = lambda seed: world("room", "room", seed)
    corridor = lambda seed: world("corridor", "corridor", seed)
    street = lambda seed: world("street", "street", seed)
    return [wrong(room(51), 1.02), wrong(room(52), 0.97), wrong(room(53), 1.05), wrong(room(54), 0.95),
            wrong(room(55), 1.10), wrong(room(56), 0.90), wrong(corridor(51), 1.03), wrong(corridor(52), 0.95),
            wrong(corridor(53), 1.08), wrong(street(51), 1.05), wrong(street(52), 0.96),
            wrong(room(57), flat=True), wrong(room(58), flat=True), wrong(room(59), 0.96, flat=True),
            wrong(room(60), readout=15), wrong(room(61), readout=30), wrong(corridor(54), readout=20),
            wrong(corridor(55), readout=30), wrong(room(62), 1.05, readout=20), wrong(room(63), 0.96, True, 25)]


def unknown_cameras():
    """Each with the field of view along the width [degrees], k1, and the readout [ms]."""
    cases = [("room", 71, 45, 0, 0), ("room", 72, 55, 0, 0), ("room", 73, 60, -0.1, 0), ("room", 74, 65, 0, 25),
             ("room", 75, 70, -0.2, 0), ("room", 76, 75, 0, 0), ("room", 77, 80, -0.2, 20), ("room", 78, 90, 0, 0),
             ("room", 79, 100, -0.15, 0), ("room", 80, 110, 0, 0), ("room", 81, 62, 0.05, 30), ("room", 82, 68, 0, 0),
             ("corridor", 71, 50, 0, 0), ("corridor", 72, 60, -0.1, 20), ("corridor", 73, 70, 0, 0),
             ("corridor", 74, 80, -0.2, 0), ("corridor", 75, 90, 0, 25), ("corridor", 76, 105, -0.1, 0),
             ("street", 71, 50, 0, 0), ("street", 72, 60, 0, 30), ("street", 73, 70, -0.15, 0),
             ("street", 74, 80, 0, 15), ("street", 75, 90, -0.1, 0), ("street", 76, 82, 0, 20)]
    result = []
    for kind, seed, view, k1, readout in cases:
        options = ["--rolling-shutter", str(readout)] if readout else []
        base = world(kind, kind, seed, *options)
        name = f"{base['name']}_fov{view}" + (f"_k{k1}" if k1 else "") + (f"_rs{readout}" if readout else "")
        result.append({"name": name, "render": base["render"], "view": view, "k1": k1, "readout": readout})
    return result


class Lens:
    """Of camera.txt with absolute intrinsics, or of run.json."""

    def __init__(self, model, intrinsics, distortion, readout=0.0):
        self.model, self.intrinsics, self.distortion, self.readout = model, intrinsics, distortion, readout

    def project(self, x, y):
        fx, fy, cx, cy = self.intrinsics
        if self.model == "FOV":
            radius, omega = np.hypot(x, y), self.distortion[0]
            factor = np.arctan(2 * radius * np.tan(omega / 2)) / omega / radius if omega > 0 else 1
        elif self.model == "RadTan":
            k1, k2, p1, p2 = self.distortion[:4]
            square = x * x + y * y
            factor = 1 + k1 * square + k2 * square * square
            return (fx * (x * factor + 2 * p1 * x * y + p2 * (square + 2 * x * x)) + cx,
                    fy * (y * factor + 2 * p2 * x * y + p1 * (square + 2 * y * y)) + cy)
        else:
            factor = 1
        return fx * x * factor + cx, fy * y * factor + cy

    @property
    def focal(self):
        return self.intrinsics[0]


def read_camera(path):
    words = path.read_text().split("\n")[0].split()
    values = [float(word) for word in words[1:]]
    return Lens(words[0], values[:4], values[4:])


def distance(lens, truth, size):
    """The largest distance between pixels of one ray over a grid of the image, but for their mean [px]."""
    width, height = size
    x, y = np.meshgrid(np.linspace(-1.5, 1.5, 151), np.linspace(-1.5, 1.5, 151) + 1e-9)
    u, v = truth.project(x, y)
    inside = (u > 0) & (u < width) & (v > 0) & (v < height)
    if truth.model == "RadTan":  # Rays beyond where the polynomial folds come back into the image.
        k1, k2 = truth.distortion[:2]
        square = x * x + y * y
        inside &= 1 + 3 * k1 * square + 5 * k2 * square ** 2 > 0.1
    a, b = lens.project(x, y)
    du, dv = (a - u)[inside], (b - v)[inside]
    return float(np.hypot(du - du.mean(), dv - dv.mean()).max())


def write_camera(path, lens, size):
    words = [lens.model, *lens.intrinsics, *lens.distortion]
    path.write_text(" ".join(map(str, words)) + f"\n{size[0]} {size[1]}\ncrop\n{size[0]} {size[1]}\n")


def spoiled(truth, focal, flat):
    fx, fy, cx, cy = truth.intrinsics
    distortion = [0.0] * len(truth.distortion) if flat else truth.distortion
    return Lens(truth.model, [fx * focal, fy * focal, cx, cy], distortion)


def render(case, worlds, program):
    folder = worlds / "_".join(case["render"] + ([str(case["view"])] if "view" in case else [])).replace("--", "")
    if not (folder / "world.yaml").exists():
        shape = ["--size", SIZE]
        if "view" in case:
            size = tuple(map(int, SIZE.split("x")))
            focal = size[0] / 2 / np.tan(np.radians(case["view"] / 2))
            lens = Lens("RadTan", [focal, 1.003 * focal, 0.497 * size[0], 0.506 * size[1]],
                        [case["k1"], -0.1 * case["k1"], 0.0, 0.0])
            camera = worlds / (folder.name + ".txt")
            worlds.mkdir(parents=True, exist_ok=True)
            write_camera(camera, lens, size)
            shape = ["--camera", camera]
        subprocess.run([program, "simulate", *case["render"], *shape, "--frames", str(FRAMES), "-o", folder],
                       check=True, stdout=subprocess.DEVNULL)
    return folder


def seed_of(folder):
    return int(re.search(r"seed: (\d+)", (folder / "world.yaml").read_text())[1])


def without_camera(folder, out):
    """A folder of the same images, with nothing that tells of their lens."""
    bare = out / "bare"
    shutil.rmtree(bare, ignore_errors=True)
    bare.mkdir()
    # What is known of the photometry of every second sequence stays.
    photometry = ("pcalib.txt", "vignette.png") if seed_of(folder) % 2 else ()
    for name in ("images", "times.txt", "groundtruth.txt", *photometry):
        if not (bare / name).exists():
            (bare / name).symlink_to((folder / name).resolve())
    return bare


def error_of(run_json):
    evaluation = run_json.get("evaluation") or {}
    return (evaluation.get("ate_m") or {}).get("rmse", float("nan"))


def run_unknown(case, options):
    folder = render(case, options.out / "worlds", options.program)
    truth = read_camera(folder / "camera.txt")
    size = tuple(map(int, SIZE.split("x")))
    out = options.out / case["name"]
    out.mkdir(parents=True, exist_ok=True)
    results = []
    bare = without_camera(folder, out)
    for name, calibration in {"known": ["--calib", folder / "camera.txt"], "unknown": []}.items():
        with open(out / f"{name}.log", "w") as log:
            subprocess.run([options.program, "run", bare, "-o", out / name, "--no-loops", "--no-report", *calibration,
                            *options.rest], stdout=log, stderr=log, check=False)
        results.append(json.loads((out / name / "run.json").read_text()))
    camera, found = results[1]["self_calibration"]["camera"], results[1]["self_calibration"]["found"]
    lens = Lens(camera["model"], [camera[key] for key in ("fx", "fy", "cx", "cy")], camera["distortion"])
    return {"name": case["name"], "focal": 100 * (lens.focal / truth.focal - 1), "lens": distance(lens, truth, size),
            "readout": camera["readout_ms"] - case["readout"], "doubt": found["doubt"],
            "stddev": 100 * found["stddevs"][0] / lens.focal, "ate": error_of(results[1]),
            "ate_ratio": error_of(results[1]) / error_of(results[0])}


def show_unknown(row):
    print("%-28s focal %+.2f +- %.2f %% | lens %.2f px | readout %+.1f ms | ate %.4f m, x %.2f%s" % (
        row["name"], row["focal"], row["stddev"], row["lens"], row["readout"], row["ate"], row["ate_ratio"],
        f" | cannot tell: {row['doubt']}" if row["doubt"] else ""), flush=True)


def run(case, options):
    folder = render(case, options.out / "worlds", options.program)
    truth = read_camera(folder / "camera.txt")
    truth.readout = float(case.get("readout", 0))
    size = tuple(map(int, SIZE.split("x")))
    given = spoiled(truth, case.get("focal", 1.0), case.get("flat", False))
    out = options.out / case["name"]
    out.mkdir(parents=True, exist_ok=True)
    write_camera(out / "given.txt", given, size)
    with open(out / "log", "w") as log:
        subprocess.run([options.program, "run", folder, "-o", out / "run", "--calib", out / "given.txt", "--no-loops",
                        "--no-report", *options.rest], stdout=log, stderr=log, check=False)
    found = json.loads((out / "run" / "run.json").read_text())["self_calibration"]
    verdict = "corrected" if found["corrected"] else "refused" if found["refused"] else "kept"
    after = given
    if found["corrected"]:
        camera = found["camera"]
        after = Lens(camera["model"], [camera[key] for key in ("fx", "fy", "cx", "cy")], camera["distortion"],
                     camera["readout_ms"])
    return {"name": case["name"], "verdict": verdict, "passes": found["passes"],
            "focal": [100 * (lens.focal / truth.focal - 1) for lens in (given, after)],
            "lens": [distance(lens, truth, size) for lens in (given, after)],
            "readout": [lens.readout - truth.readout for lens in (given, after)], "refused": found["refused"]}


def shrinks(row):
    before, after = row["lens"] if row["lens"][0] > 0.01 else map(abs, row["readout"])
    return before / max(after, 1e-9) if before > 0 else float("nan")


def show(row):
    pair = lambda values, form: " -> ".join(form % value for value in values)
    text = "%-28s %-9s %d | focal %s %% | lens %s px | readout %s ms | shrinks %.1f" % (
        row["name"], row["verdict"], row["passes"], pair(row["focal"], "%+.2f"), pair(row["lens"], "%.2f"),
        pair(row["readout"], "%+.1f"), shrinks(row))
    print(text + (f" | {row['refused']}" if row["refused"] else ""), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--out", type=pathlib.Path, default=pathlib.Path("out/calibrations"))
    parser.add_argument("-k", "--pattern", default=".", help="only sequences whose name matches")
    parser.add_argument("--kinds", default="right,wrong,unknown")
    parser.add_argument("program")
    parser.add_argument("rest", nargs="*", help="options for `ldso run`, after --")
    options = parser.parse_args()
    results = {"right": [], "wrong": [], "unknown": []}
    for kind, cases in {"right": right_calibrations(), "wrong": wrong_calibrations(),
                        "unknown": unknown_cameras()}.items():
        if kind not in options.kinds.split(","): continue
        print(f"{kind} calibrations")
        for case in cases:
            if not re.search(options.pattern, case["name"]): continue
            results[kind].append(run_unknown(case, options) if kind == "unknown" else run(case, options))
            (show_unknown if kind == "unknown" else show)(results[kind][-1])
    harmed = [row for row in results["right"] if abs(row["focal"][1] - row["focal"][0]) > LARGEST_HARM]
    mended = [row for row in results["wrong"] if shrinks(row) >= LEAST_GAIN]
    print(f"right calibrations changed by more than {LARGEST_HARM} %: {len(harmed)} of {len(results['right'])}; "
          f"wrong ones at least {LEAST_GAIN:.0f} times better: {len(mended)} of {len(results['wrong'])}")
    if found := results["unknown"]:
        within = lambda limit: sum(abs(row["focal"]) <= limit for row in found)
        ratios = sorted(row["ate_ratio"] for row in found)
        print(f"unknown cameras: focal length within 1.5 % in {within(1.5)}, within 5 % in {within(5)} of {len(found)}, "
              f"cannot tell {sum(bool(row['doubt']) for row in found)}; ATE x {ratios[len(ratios) // 2]:.2f} (median), "
              f"{ratios[-1]:.2f} (worst), above 3 in {sum(not ratio <= 3 for ratio in ratios)}")
    (options.out / "runs.json").write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
