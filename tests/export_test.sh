#!/usr/bin/env bash
# export_test.sh PROGRAM SEQUENCE WORK: a finished run in all formats; what can be read back is the same.
LDSO=$1 SEQUENCE=$2 WORK=$3/export
rm -rf "$WORK" && mkdir -p "$WORK"
tests=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
source "$tests/test_tools.sh"
out=$WORK/out

expect_exit 0 run "$SEQUENCE" -o "$out" --quiet --end 40
expect_exit 0 export "$out" --format ply,pcd,colmap,tum,kitti,euroc,csv
for file in map.ply map.pcd trajectory_tum.txt trajectory_kitti.txt trajectory_euroc.csv trajectory.csv \
  colmap/sparse/0/cameras.txt colmap/sparse/0/images.txt colmap/sparse/0/points3D.txt \
  colmap/sparse/0/cameras.bin colmap/sparse/0/images.bin colmap/sparse/0/points3D.bin \
  colmap/points.ply colmap/transforms.json; do
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
import json, math, os, struct, sys
folder, keyframes = sys.argv[1], int(sys.argv[2])
lines = lambda name: [l.split() for l in open(f"{folder}/sparse/0/{name}") if not l.startswith("#")]
camera, = lines("cameras.txt")
assert camera[1] == "PINHOLE", camera
width, height = map(int, camera[2:4])
images, points = lines("images.txt"), {p[0]: p for p in lines("points3D.txt")}
assert len(images) == 2 * keyframes > 0
several = 0
for head, seen in zip(images[::2], images[1::2]):
    data = open(f"{folder}/images/{head[9]}", "rb").read(26)
    assert struct.unpack(">II", data[16:24]) == (width, height), head
    assert data[25] == 2, "the image has not three channels"
    for x, y, point in zip(seen[::3], seen[1::3], seen[2::3]):
        assert 0 <= float(x) <= width and 0 <= float(y) <= height and point in points
for p in points.values():
    track = p[8:]
    assert len(track) >= 2 and len(track) % 2 == 0
    several += len(track) > 2
assert several > 0.5 * len(points), (several, len(points))

# Errors of reprojection are what they say: where points were found, against where pose and position put them.
fx, fy, cx, cy = map(float, camera[4:8])
def rotate(q, v):
    w, x, y, z = q
    u = (y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0])
    return [v[i] + 2 * (w * u[i] + (y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0])[i]) for i in range(3)]
sums = {p: [] for p in points}
for head, seen in zip(images[::2], images[1::2]):
    q, t = list(map(float, head[1:5])), list(map(float, head[5:8]))
    for x, y, point in zip(seen[::3], seen[1::3], seen[2::3]):
        c = [a + b for a, b in zip(rotate(q, list(map(float, points[point][1:4]))), t)]
        sums[point].append(math.hypot(fx * c[0] / c[2] + cx - float(x), fy * c[1] / c[2] + cy - float(y)))
worst = max(abs(sum(s) / len(s) - float(points[p][7])) for p, s in sums.items())
mean = sum(float(p[7]) for p in points.values()) / len(points)
print(f"{len(points)} points, mean error of reprojection {mean:.3f} px, told to {worst:.4f} px")
assert worst < 0.02 and 0.01 < mean < 0.5, (worst, mean)

transforms = json.load(open(f"{folder}/transforms.json"))
assert [f["file_path"] for f in transforms["frames"]] == ["images/" + head[9] for head in images[::2]]
assert transforms["w"] == width and abs(transforms["fl_x"] - fx) < 1e-6
assert os.path.exists(f"{folder}/{transforms['ply_file_path']}")
# The same in binary, read as COLMAP reads it.
data = open(f"{folder}/sparse/0/points3D.bin", "rb").read()
count, at = struct.unpack_from("<Q", data)[0], 8
assert count == len(points)
for _ in range(count):
    number, x, y, z, r, g, b, error, length = struct.unpack_from("<Q3d3BdQ", data, at)
    p = points[str(number)]
    assert abs(x - float(p[1])) < 1e-6 * max(1, abs(x)) and [r, g, b] == list(map(int, p[4:7])), p
    assert abs(error - float(p[7])) < 1e-3 and length == len(p[8:]) / 2
    at += struct.calcsize("<Q3d3BdQ") + 8 * length
assert at == len(data)
PY

expect_exit 0 export "$out" --format ply --max-depth-error 0.02 -o "$WORK/few"
expect_true "uncertain points are left out" \
  "0 < $(sed -n 's/^element vertex //p;/^end_header/q' "$WORK/few/map.ply") < $(sed -n 's/^element vertex //p;/^end_header/q' "$out/map.ply")"
expect_exit 0 export "$out" --format colmap --images original -o "$WORK/original"
grep -q '^1 OPENCV ' "$WORK/original/colmap/sparse/0/cameras.txt" || fail "the original camera is not OPENCV"
image=$(find "$WORK/original/colmap/images" -type f | sort | sed -n 1p)
PYTHONPATH=$tests python3 - "$image" "$SEQUENCE/images/$(basename "$image")" <<'PY' || fail "the original image is another one"
import sys
import png_image
(width, height, channels, written), original = (png_image.read(path) for path in sys.argv[1:])
assert (width, height, channels) == original[:2] + (3,)
assert all(row[c::3] == grey for row, grey in zip(written, original[3]) for c in range(3))
PY

# As many as are asked for, of all frames.
expect_exit 0 export "$out" --format colmap --images 8 -o "$WORK/eight"
expect_true "eight images are written" "$(find "$WORK/eight/colmap/images" -type f | wc -l) == 8"
expect_true "eight images are in the model" "$(grep -vc '^#' "$WORK/eight/colmap/sparse/0/images.txt") == 16"
expect_exit 1 export "$out" --format colmap --images some -o "$WORK/some"
expect_output '^error: --images some: is neither a kind nor a number'
expect_exit 1 export "$out" --format colmap --images none,8 -o "$WORK/some"
[[ ! -e $WORK/some ]] || fail "a refused export has made its folder"

# Colours come from the images and go to the points, of the recording too.
mkdir -p "$WORK/colored/images"
PYTHONPATH=$tests python3 - "$SEQUENCE" "$WORK/colored" <<'PY'
import pathlib, sys
import png_image
source, to = map(pathlib.Path, sys.argv[1:])
for path in sorted((source / "images").iterdir())[:40]:
    width, _, _, rows = png_image.read(path)
    yellow = [b"".join(bytes((v, v, 0)) for v in row) for row in rows]
    png_image.write(to / "images" / path.name, width, 3, yellow)
PY
cp "$SEQUENCE/camera.txt" "$SEQUENCE/times.txt" "$WORK/colored/"
expect_exit 0 run "$WORK/colored" -o "$WORK/colored_out" --quiet --end 40 --no-report
expect_exit 0 export "$WORK/colored_out" --format colmap,ply
is_yellow='!/^#/ && NF { if ($5 != $6 || $7 != 0) exit 1; red += $5 > 20; n++ } END { exit !(n > 300 && red > n / 2) }'
awk "$is_yellow" "$WORK/colored_out/export/colmap/sparse/0/points3D.txt" ||
  fail "the points have not the colours of the images"
python3 - "$WORK/colored_out/export/map.ply" <<'PY' || fail "the cloud has not the colours of the images"
import struct, sys
data = open(sys.argv[1], "rb").read()
points = list(struct.iter_unpack("<fff4Bf", data[data.index(b"end_header\n") + 11:]))
assert all(p[3] == p[4] and p[5] == 0 for p in points) and sum(p[3] > 20 for p in points) > len(points) / 2
PY
expect_exit 0 export "$WORK/colored_out" --format colmap --images original -o "$WORK/colored_original"
image=$(find "$WORK/colored_original/colmap/images" -type f | sort | sed -n 1p)
cmp "$image" "$WORK/colored/images/$(basename "$image")" || fail "the original image in colour is another one"
expect_exit 0 export "$WORK/colored_out" --format colmap --images none -o "$WORK/colored_none"
awk "$is_yellow" "$WORK/colored_none/colmap/sparse/0/points3D.txt" || fail "the recording has not the colours"

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
