#!/usr/bin/env python3
"""Runs ldso on a sequence of VSLAM-LAB: one command in, one trajectory out.

    vslamlab_ldso_mono.py sequence_path:DIR calibration_yaml:FILE rgb_csv:FILE exp_folder:DIR exp_id:N [KEY:VALUE ...]

or the same as --KEY VALUE (then exp_it is exp_id). The benchmark passes these by itself (baseline_ldso.py). Further keys:
`ldso` (the program; `ldso` on the PATH), `cam` (rgb_0), `loops` (1), `preset` (none), `settings_yaml` (settings of ldso,
used if the file is there), `verbose` (0).

Writes to exp_folder: NNNNN_KeyFrameTrajectory.csv, which the benchmark evaluates (despite its name all frames; nanoseconds,
camera to world), NNNNN_trajectory.txt (the same in TUM's format) and NNNNN_ldso/ (all results, report.html among them).
"""

import bisect
import csv
import pathlib
import subprocess
import sys

LENSES = {  # Names of VSLAM-LAB: model of camera.txt, coefficients.
    "radtan4": ("RadTan", 4), "radtan5": ("RadTan", 5), "radtan8": ("RadTan", 8), "equid4": ("KannalaBrandt", 4),
}
DEFAULTS = {"ldso": "ldso", "cam": "rgb_0", "loops": "1", "preset": "", "settings_yaml": "", "verbose": "0"}
NEEDED = ("sequence_path", "calibration_yaml", "rgb_csv", "exp_folder", "exp_id")


def fail(text):
    sys.exit(f"error: {text}")


def parse(arguments):
    """Of KEY:VALUE and --KEY VALUE."""
    options, words = dict(DEFAULTS), iter(arguments)
    for word in words:
        if word.startswith("--"):
            options[word[2:]] = next(words, "")
        elif ":" in word:
            key, value = word.split(":", 1)
            options[key] = value
        else:
            fail(f"'{word}' is neither KEY:VALUE nor --KEY VALUE")
    options.setdefault("exp_id", options.get("exp_it", ""))
    missing = [key for key in NEEDED if not options.get(key)]
    if missing:
        fail(f"not given: {', '.join(missing)}")
    return options


def read_camera(path, name):
    """The lines of a camera.txt."""
    try:
        import yaml
    except ImportError:
        fail("the calibration is YAML; install PyYAML (python3-yaml)")
    if not path.is_file():
        fail(f"{path}: there is no such file")
    cameras = (yaml.safe_load(path.read_text(encoding="utf-8").replace("%YAML:1.0", "")) or {}).get("cameras") or []
    found = [camera for camera in cameras if camera.get("cam_name") == name]
    if not found:
        fail(f"{path}: there is no camera {name}, but {', '.join(str(c.get('cam_name')) for c in cameras) or 'none'}")
    camera = found[0]
    numbers = [*camera["focal_length"], *camera["principal_point"]]
    lens, coefficients = "Pinhole", [0]
    if any(camera.get("distortion_coefficients") or []):
        kind = camera.get("distortion_type")
        if kind not in LENSES:
            fail(f"{path}: ldso has no lens '{kind}', but {', '.join(LENSES)}")
        lens, count = LENSES[kind]
        coefficients = list(camera["distortion_coefficients"])[:count]
    width, height = camera["image_dimension"]
    first = " ".join(map(str, [lens, *numbers, *coefficients]))
    return [first, f"{width} {height}", "none" if lens == "Pinhole" else "crop", f"{width} {height}"]


def read_frames(path, name):
    """(nanoseconds, image below the sequence) of each frame."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    columns = f"ts_{name} (ns)", f"path_{name}"
    if not rows or any(column not in rows[0] for column in columns):
        fail(f"{path}: it has no frames of {name}")
    return [(int(float(row[columns[0]])), row[columns[1]]) if "." in row[columns[0]] else
            (int(row[columns[0]]), row[columns[1]]) for row in rows]


def seconds_text(nanoseconds):
    return f"{nanoseconds // 10**9}.{nanoseconds % 10**9:09d}"


def make_sequence(folder, options, frames):
    """A folder of links to the images, with their times: the frames that the benchmark chose, in its order."""
    (folder / "images").mkdir(parents=True, exist_ok=True)
    for old in (folder / "images").iterdir():
        if old.is_symlink():
            old.unlink()
    times = []
    for number, (nanoseconds, image) in enumerate(frames):
        source = (pathlib.Path(options["sequence_path"]) / image).resolve()
        (folder / "images" / f"{number:06d}{source.suffix}").symlink_to(source)
        times.append(f"{number:06d} {seconds_text(nanoseconds)}\n")
    (folder / "times.txt").write_text("".join(times), encoding="utf-8")
    camera = read_camera(pathlib.Path(options["calibration_yaml"]), options["cam"])
    (folder / "camera.txt").write_text("\n".join(camera) + "\n", encoding="utf-8")


def write_trajectory(trajectory, frames, csv_path, tum_path):
    """Of ldso's trajectory, which is TUM's format already; with the frames' own times, to the nanosecond, which seconds
    since 1970 in a double are not."""
    times = sorted(nanoseconds for nanoseconds, _ in frames)
    rows = []
    for line in trajectory.read_text(encoding="utf-8").splitlines():
        if not line or line.startswith("#"):
            continue
        time, *pose = line.split()
        seconds, _, fraction = time.partition(".")
        said = int(seconds) * 10**9 + int(f"{fraction:0<9}"[:9])
        after = bisect.bisect_left(times, said)
        rows.append([min(times[max(0, after - 1):after + 1], key=lambda t: abs(t - said)), *pose])
    with open(csv_path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["ts (ns)", "tx (m)", "ty (m)", "tz (m)", "qx", "qy", "qz", "qw"])
        writer.writerows(rows)
    tum_path.write_text("".join(f"{seconds_text(row[0])} {' '.join(row[1:])}\n" for row in rows), encoding="utf-8")
    return len(rows)


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    options = parse(sys.argv[1:])
    stem = pathlib.Path(options["exp_folder"]) / str(options["exp_id"]).zfill(5)
    work = stem.with_name(stem.name + "_ldso")
    frames = read_frames(options["rgb_csv"], options["cam"])
    make_sequence(work / "sequence", options, frames)
    command = [options["ldso"], "run", str(work / "sequence"), "-o", str(work / "out")]
    if options["verbose"] in ("0", ""):
        command.append("--quiet")
    if options["loops"] == "0":
        command.append("--no-loops")
    if options["preset"]:
        command += ["--set", f"preset={options['preset']}"]
    if options["settings_yaml"] and pathlib.Path(options["settings_yaml"]).is_file():
        command += ["--config", options["settings_yaml"]]
    status = subprocess.run(command, check=False).returncode
    trajectory = work / "out" / "trajectory.txt"
    if status != 0 or not trajectory.is_file():
        fail(f"ldso ended with {status}")
    poses = write_trajectory(trajectory, frames, stem.with_name(stem.name + "_KeyFrameTrajectory.csv"),
                             stem.with_name(stem.name + "_trajectory.txt"))
    print(f"{poses} poses")


if __name__ == "__main__":
    main()
