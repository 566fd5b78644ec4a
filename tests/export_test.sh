#!/usr/bin/env bash
# export_test.sh PROGRAM SEQUENCE WORK: a finished run in all formats; what can be read back is the same.
LDSO=$1 SEQUENCE=$2 WORK=$3/export
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out

expect_exit 0 run "$SEQUENCE" -o "$out" --quiet --end 40
expect_exit 0 export "$out" --format ply,pcd,colmap,tum,kitti,euroc,csv
for file in map.ply map.pcd trajectory_tum.txt trajectory_kitti.txt trajectory_euroc.csv trajectory.csv \
  colmap/sparse/0/cameras.txt colmap/sparse/0/images.txt colmap/sparse/0/points3D.txt; do
  [[ -s $out/export/$file ]] || fail "$file is missing or empty"
done
cmp "$out/trajectory.txt" "$out/export/trajectory_tum.txt" || fail "the TUM trajectory is another one"
poses=$(poses "$out/trajectory.txt")
expect_true "EuRoC has all poses" "$(poses "$out/export/trajectory_euroc.csv") == $poses"
expect_true "CSV has all poses and titles" "$(poses "$out/export/trajectory.csv") == $poses + 1"
expect_true "KITTI has all poses" "$(poses "$out/export/trajectory_kitti.txt") == $poses"
for file in trajectory_tum.txt trajectory_euroc.csv; do
  expect_exit 0 eval "$out/export/$file" "$SEQUENCE" --json "$WORK/$file.json"
done
expect_true "both are as good" \
  "abs($(json "$WORK/trajectory_tum.txt.json" "['ate_m']['rmse']") - $(json "$WORK/trajectory_euroc.csv.json" "['ate_m']['rmse']")) < 1e-6"

# The cloud is that of map.ply, as far as f32 goes.
python3 - "$out/map.ply" "$out/export/map.ply" "$out/export/map.pcd" <<'PY' || fail "the clouds differ"
import struct, sys
def body(path, end):
    data = open(path, "rb").read()
    return data[data.index(end) + len(end):]
ply = [[p for p in struct.iter_unpack("<fff4Bf", body(path, b"end_header\n"))] for path in sys.argv[1:3]]
pcd = [p for p in struct.iter_unpack("<fffff", body(sys.argv[3], b"DATA binary\n"))]
close = lambda a, b: abs(a - b) <= 1e-4 * max(1, abs(a))
assert len(ply[0]) == len(ply[1]) == len(pcd) > 500, (len(ply[0]), len(ply[1]), len(pcd))
for a, b, c in zip(*ply, pcd):
    assert all(map(close, a, b)), (a, b)
    assert all(map(close, b[:3], c[:3])) and b[6] == c[3] and close(b[7], c[4]), (b, c)
PY

# Every keyframe is an image of the right size with observations inside of it, and has its file.
python3 - "$out/export/colmap" "$(poses "$out/keyframes.txt")" <<'PY' || fail "the model of COLMAP is wrong"
import os, struct, sys
folder, keyframes = sys.argv[1], int(sys.argv[2])
lines = lambda name: [l.split() for l in open(f"{folder}/sparse/0/{name}") if not l.startswith("#")]
camera, = lines("cameras.txt")
assert camera[1] == "PINHOLE", camera
width, height = map(int, camera[2:4])
images, points = lines("images.txt"), {p[0]: p for p in lines("points3D.txt")}
assert len(images) == 2 * keyframes > 0
several = 0
for head, seen in zip(images[::2], images[1::2]):
    data = open(f"{folder}/images/{head[9]}", "rb").read(24)
    assert struct.unpack(">II", data[16:24]) == (width, height), head
    for x, y, point in zip(seen[::3], seen[1::3], seen[2::3]):
        assert 0 <= float(x) <= width and 0 <= float(y) <= height and point in points
for p in points.values():
    track = p[8:]
    assert len(track) >= 2 and len(track) % 2 == 0
    several += len(track) > 2
assert several > 0.5 * len(points), (several, len(points))
PY

expect_exit 0 export "$out" --format ply --max-depth-error 0.02 -o "$WORK/few"
expect_true "uncertain points are left out" \
  "0 < $(sed -n 's/^element vertex //p;/^end_header/q' "$WORK/few/map.ply") < $(sed -n 's/^element vertex //p;/^end_header/q' "$out/map.ply")"
expect_exit 0 export "$out" --format colmap --images original -o "$WORK/original"
grep -q '^1 OPENCV ' "$WORK/original/colmap/sparse/0/cameras.txt" || fail "the original camera is not OPENCV"
image=$(find "$WORK/original/colmap/images" -type f | sort | sed -n 1p)
cmp "$image" "$SEQUENCE/images/$(basename "$image")" || fail "the original image is another one"

# The camera in the formats of other programs, each of which can be given as a calibration again.
expect_exit 0 export "$out" --format kalibr,ros,opencv,colmap-camera,basalt,nerfstudio -o "$WORK/cameras"
for file in camchain.yaml camera_info.yaml camera.yaml cameras.txt calibration.json transforms.json; do
  expect_exit 2 run "$SEQUENCE" -o "$WORK/again" --quiet --end 3 --no-report --calib "$WORK/cameras/$file"
  for number in fx fy cx cy; do
    expect_true "$file has the $number of the run" \
      "abs($(json "$WORK/again/run.json" "['self_calibration']['camera']['$number']") - $(json "$out/run.json" "['self_calibration']['camera']['$number']")) < 1e-6"
  done
done
expect_exit 0 export "$WORK/cameras/camchain.yaml:cam0" --format opencv -o "$WORK/converted"
cmp "$WORK/cameras/camera.yaml" "$WORK/converted/camera.yaml" || fail "a converted calibration is another one"
expect_exit 1 export "$WORK/cameras/camchain.yaml:1" --format opencv -o "$WORK/converted"
expect_output 'there is no camera 1'
expect_exit 1 export "$WORK/cameras/camchain.yaml" --format ply -o "$WORK/converted"
expect_output 'of a file only calibrations can be made'

expect_exit 1 export "$WORK/nothing" --format ply
expect_output 'there is no finished run'
expect_exit 1 export "$out" --format obj
expect_output 'obj'
mv "$out" "$WORK/moved"
sed -i "s|$SEQUENCE|$WORK/gone|" "$WORK/moved/run.json"
expect_exit 1 export "$WORK/moved" --format colmap
expect_output 'gone: the sequence of the run .* is not there.*--sequence'
expect_exit 0 export "$WORK/moved" --format colmap --sequence "$SEQUENCE"
expect_exit 0 export "$WORK/moved" --format colmap --images none -o "$WORK/none"
[[ ! -e $WORK/none/colmap/images ]] || fail "images were written"
