#!/usr/bin/env bash
# rolling_shutter_test.sh PROGRAM SEQUENCE WORK READOUT_MS: a sequence through a rolling shutter that its calibration
# does not tell. The run finds out how long the readout takes, begins anew and is as good as it has to be; the written
# calibration has it; the result does not depend on the number of threads.
LDSO=$1 SEQUENCE=$2 WORK=$3/rolling_shutter READOUT=$4
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
percent() { json "$1/run.json" "['evaluation']['ate_percent_of_path']"; }

expect_exit 0 run "$SEQUENCE" -o "$WORK/found" --no-loops
expect_output 'readout [0-9.]+ ms instead of 0.0'
found=$(json "$WORK/found/run.json" "['self_calibration']['camera']['readout_ms']")
expect_true "the readout of $found ms is $READOUT ms within 15 %" "abs($found / $READOUT - 1) < 0.15"

expect_exit 0 run "$SEQUENCE" -o "$WORK/ignored" --no-loops --set self_calibration.enabled=false
{ cat "$SEQUENCE/camera.txt" && echo "rolling_shutter $READOUT"; } >"$WORK/true.txt"
expect_exit 0 run "$SEQUENCE" -o "$WORK/known" --no-loops --calib "$WORK/true.txt"
expect_json "$WORK/known/run.json" "['self_calibration']['passes']" 1
echo "ATE in % of the path: known $(percent "$WORK/known"), ignored $(percent "$WORK/ignored"), found $(percent "$WORK/found")"
expect_true "known, it does no harm" "$(percent "$WORK/known") < 0.1"
expect_true "found, it does less than half of the harm" "2 * $(percent "$WORK/found") < $(percent "$WORK/ignored")"

# Exported images are as with a global shutter: points are found where they should be, unlike in the original ones.
for images in rectified original; do
  expect_exit 0 export "$WORK/known" --format colmap --images "$images" -o "$WORK/$images"
  sed -n '/ px from where it should be/p;/rolling shutter/p' "$WORK/log"
  expect_output "rolling shutter of $READOUT.0 ms is $([[ $images == rectified ]] && echo undone || echo ignored)"
done
mean_error() { awk '!/^#/ { sum += $8; n++ } END { print sum / n }' "$1/colmap/sparse/0/points3D.txt"; }
expect_true "the rolling shutter is undone" "2 * $(mean_error "$WORK/rectified") < $(mean_error "$WORK/original")"

# An image that comes twice does not mean that the camera stood still.
stutter_sequence "$SEQUENCE" "$WORK/stutter" 10 0.033333333
expect_exit 0 run "$WORK/stutter" -o "$WORK/twice" --no-loops --calib "$WORK/true.txt"
echo "each tenth image twice: $(percent "$WORK/twice")"
expect_true "repeated images do no harm" "$(percent "$WORK/twice") < 1.2 * $(percent "$WORK/known")"

expect_exit 0 run "$SEQUENCE" -o "$WORK/again" --no-loops --calib "$WORK/found/camera.txt" --threads 1
expect_json "$WORK/again/run.json" "['self_calibration']['passes']" 1
cmp "$WORK/again/trajectory.txt" "$WORK/found/trajectory.txt" || fail "the written calibration gives another trajectory"
