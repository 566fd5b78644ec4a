#!/usr/bin/env bash
# unknown_camera_test.sh PROGRAM SEQUENCE WORK: a sequence whose camera nobody calibrated. The run finds it, writes it
# with how certain it is, and is nearly as good as with the true one; a live run, which cannot look for it, says so.
LDSO=$1 SEQUENCE=$2 WORK=$3/unknown_camera
rm -rf "$WORK" && mkdir -p "$WORK/bare"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
percent() { json "$1/run.json" "['evaluation']['ate_percent_of_path']"; }

for name in images times.txt groundtruth.txt; do ln -s "$(realpath "$SEQUENCE/$name")" "$WORK/bare/$name"; done
true_fx=$(awk 'NR == 1 { print $2 }' "$SEQUENCE/camera.txt")

expect_exit 0 run "$WORK/bare" -o "$WORK/found" --no-loops
expect_output 'there is no calibration of the camera: looking for it'
expect_output '^calibration +found: focal lengths'
fx=$(json "$WORK/found/run.json" "['self_calibration']['camera']['fx']")
stddev=$(json "$WORK/found/run.json" "['self_calibration']['found']['stddevs'][0]")
expect_json "$WORK/found/run.json" "['self_calibration']['found']['doubt']" ""
expect_true "the focal length $fx is found to 1.5 %" "abs($fx / $true_fx - 1) < 0.015"
expect_true "its standard deviation of $stddev px is told" "0 < $stddev < 0.01 * $fx"
[[ -s $WORK/found/camera.txt ]] || fail "the camera was not written"

# What was found is good for later runs.
expect_exit 0 run "$WORK/bare" -o "$WORK/known" --no-loops --calib "$SEQUENCE/camera.txt"
expect_exit 0 run "$WORK/bare" -o "$WORK/again" --no-loops --calib "$WORK/found/camera.txt"
echo "ATE in % of the path: known $(percent "$WORK/known"), found $(percent "$WORK/found")"
expect_true "the ATE is at most three times that with the true camera" \
  "$(percent "$WORK/found") < 3 * $(percent "$WORK/known")"

expect_exit 1 run "$WORK/bare" -o "$WORK/live" --live
expect_output 'a live run cannot look for it'
