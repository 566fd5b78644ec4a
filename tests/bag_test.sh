#!/usr/bin/env bash
# bag_test.sh PROGRAM SEQUENCE WORK: a sequence in ROS bags runs as it does in a folder, to the last bit.
LDSO=$1 SEQUENCE=$2 WORK=$3/bag
here=$(dirname "${BASH_SOURCE[0]}")
rm -rf "$WORK" && mkdir -p "$WORK/plain"
source "$here/test_tools.sh"
out=$WORK/out

# Bags know nothing of exposures, response and vignette. Their times begin in the year 2023.
ln -s "$(realpath "$SEQUENCE/images")" "$WORK/plain/images"
cp "$SEQUENCE/camera.txt" "$WORK/plain/"
awk '!/^#/ && NF { printf "%s %.9f\n", $1, $2 }' "$SEQUENCE/times.txt" >"$WORK/plain/times.txt"
expect_exit 0 run "$WORK/plain" -o "$WORK/folder" --no-report
positions() { awk '!/^#/ && NF { $1 = ""; print }' "$1/trajectory.txt"; }

for kind in bag mcap db3; do
  python3 "$here/make_bag.py" "$WORK/plain" "$WORK/recording.$kind"
  expect_exit 0 run "$WORK/recording.$kind" -o "$out" --no-report
  expect_output '^calibration .*:/camera/camera_info, RadTan'
  diff <(positions "$WORK/folder") <(positions "$out") >/dev/null || fail "$kind: the trajectory is another one"
  expect_true "times are those of the headers" \
    "abs($(awk '!/^#/ && NF { print $1; exit }' "$out/trajectory.txt") - 1.7e9) < 5"
  expect_true "camera_info is the calibration" \
    "'/camera/camera_info' in '''$(json "$out/run.json" "['sequence']['calibration']")'''"
done

# The topic is kept for `ldso export`.
expect_exit 0 run "$WORK/recording.mcap" -o "$out" --topic camera/image_raw --no-report --end 40
expect_json "$out/run.json" "['sequence']['topic']" camera/image_raw
expect_exit 0 export "$out" --format colmap
expect_exit 1 run "$WORK/recording.mcap" -o "$out" --topic /camera/imageraw
expect_output 'did you mean /camera/image_raw/compressed'
expect_exit 1 run "$WORK/plain" -o "$out" --topic /camera/image_raw
expect_output 'is no ROS bag'

# A recording that broke off is run as far as it goes.
for kind in bag mcap db3; do
  size=$(stat -c %s "$WORK/recording.$kind")
  head -c $((size * 3 / 4)) "$WORK/recording.$kind" >"$WORK/cut.$kind"
  expect_exit 0 run "$WORK/cut.$kind" -o "$out" --no-report
  expect_output 'warning: .*cut off'
  expect_true "most frames are there" "30 < $(json "$out/run.json" "['counts']['frames']") < 50"
done
