#!/usr/bin/env bash
# benchmark_suite_test.sh PROGRAM SEQUENCE WORK: a sequence as VSLAM-LAB has them, by the command that it would run; and
# trajectories as evo reads them. Exit code 77: there is no PyYAML, which that command needs.
LDSO=$1 SEQUENCE=$2 WORK=$3/benchmark_suite
rm -rf "$WORK" && mkdir -p "$WORK/sequence/rgb_0" "$WORK/exp"
tests=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
source "$tests/test_tools.sh"
if ! python3 -c 'import yaml' 2>/dev/null; then
  echo "skipped: there is no PyYAML (package python3-yaml)"
  exit 77
fi

# Every frame but those of the beginning, as the benchmark may choose; its clock begins far from zero.
python3 - "$SEQUENCE" "$WORK/sequence" <<'PY'
import pathlib, sys
source, to = map(pathlib.Path, sys.argv[1:])
times = [line.split() for line in (source / "times.txt").read_text().splitlines() if not line.startswith("#")]
images = sorted((source / "images").iterdir())
rows = ["ts_rgb_0 (ns),path_rgb_0"]
for image, time in list(zip(images, times))[3:43]:
    (to / "rgb_0" / image.name).symlink_to(image.resolve())
    rows.append(f"{10**18 + round(float(time[1]) * 1e9)},rgb_0/{image.name}")
(to / "rgb.csv").write_text("\n".join(rows) + "\n")
camera, size = [line.split() for line in (source / "camera.txt").read_text().splitlines() if line.strip()][:2]
model, (fx, fy, cx, cy), k = camera[0], camera[1:5], camera[5:9]
assert model == "RadTan" and float(cx) > 1, camera
(to / "calibration.yaml").write_text(f"""%YAML 1.2
---
cameras:
  - {{cam_name: rgb_0, cam_type: rgb, cam_model: pinhole, focal_length: [{fx}, {fy}], principal_point: [{cx}, {cy}],
     distortion_type: radtan4, distortion_coefficients: [{', '.join(k)}], image_dimension: [{size[0]}, {size[1]}], fps: 30.0}}
""")
PY
baseline() { python3 "$tests/../bench/vslamlab/vslamlab_ldso_mono.py" "ldso:$LDSO" "$@" >"$WORK/log" 2>&1; }
arguments=("sequence_path:$WORK/sequence" "rgb_csv:$WORK/sequence/rgb.csv" "exp_folder:$WORK/exp" exp_id:7 mode:mono)

baseline "${arguments[@]}" "calibration_yaml:$WORK/sequence/calibration.yaml" loops:0 || fail "the baseline failed"
python3 - "$WORK/exp/00007_KeyFrameTrajectory.csv" "$WORK/exp/00007_trajectory.txt" "$WORK/sequence/rgb.csv" <<'PY' ||
import csv, math, sys
table = list(csv.reader(open(sys.argv[1])))
assert table[0] == ["ts (ns)", "tx (m)", "ty (m)", "tz (m)", "qx", "qy", "qz", "qw"], table[0]
frames = {int(row[0]) for row in list(csv.reader(open(sys.argv[3])))[1:]}
rows = table[1:]
assert len(rows) > 30 and all(int(row[0]) in frames for row in rows), "times are not those of the frames"
# What evo asks of a TUM file: eight numbers with blanks between them, growing times, and unit quaternions.
tum = [[float(word) for word in line.split(" ")] for line in open(sys.argv[2]) if not line.startswith("#")]
assert len(tum) == len(rows) and all(len(line) == 8 and all(map(math.isfinite, line)) for line in tum)
assert all(a[0] < b[0] for a, b in zip(tum, tum[1:]))
assert all(abs(math.hypot(*line[4:]) - 1) < 1e-6 for line in tum)
PY
  fail "the trajectory is not what the benchmark or evo reads"

# The other form of arguments, and what goes wrong.
long=(--sequence_path "$WORK/sequence" --rgb_csv "$WORK/sequence/rgb.csv" --exp_folder "$WORK/exp" --exp_it 8)
if baseline "${long[@]}" --calibration_yaml "$WORK/nothing.yaml"; then fail "a missing calibration is no error"; fi
sed 's/radtan4/brown9/' "$WORK/sequence/calibration.yaml" >"$WORK/brown.yaml"
if baseline "${long[@]}" --calibration_yaml "$WORK/brown.yaml"; then fail "an unknown lens is no error"; fi
expect_output "ldso has no lens 'brown9'"
if baseline "${arguments[@]}"; then fail "a missing argument is no error"; fi
expect_output 'not given: calibration_yaml'
if baseline "${long[@]}" --calibration_yaml "$WORK/sequence/calibration.yaml" --cam rgb_9; then fail "no such camera"; fi
expect_output 'it has no frames of rgb_9'
[[ ! -e $WORK/exp/00008_KeyFrameTrajectory.csv ]] || fail "a failed run has left a trajectory"
