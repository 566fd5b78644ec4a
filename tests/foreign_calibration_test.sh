#!/usr/bin/env bash
# foreign_calibration_test.sh PROGRAM SEQUENCE WORK: a sequence with the calibration of another camera, whose lens does not
# bend what it shows. That is too wrong to be mended step by step: the run looks for the camera, and is right with it.
LDSO=$1 SEQUENCE=$2 WORK=$3/foreign_calibration
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

awk 'NR == 1 { $1 = "Pinhole"; NF = 5 } { print }' "$SEQUENCE/camera.txt" >"$WORK/foreign.txt"
true_fx=$(awk 'NR == 1 { print $2 }' "$SEQUENCE/camera.txt")
true_k=$(awk 'NR == 1 { print $6 }' "$SEQUENCE/camera.txt")

expect_exit 0 run "$SEQUENCE" -o "$WORK/run" --no-loops --calib "$WORK/foreign.txt" --set self_calibration.passes=3
expect_output "the calibration seems to be another camera's: focal lengths"
expect_output '^calibration +corrected: focal lengths'
fx=$(json "$WORK/run/run.json" "['self_calibration']['camera']['fx']")
k=$(json "$WORK/run/run.json" "['self_calibration']['camera']['distortion'][0]")
expect_true "the focal length $fx is found to 0.7 %" "abs($fx / $true_fx - 1) < 0.007"
expect_true "the distortion $k is found" "abs($k - $true_k) < 0.01"
ate=$(json "$WORK/run/run.json" "['evaluation']['ate_percent_of_path']")
expect_true "the ATE of $ate % of the path is that of a right camera" "$ate < 0.1"
[[ -s $WORK/run/camera.txt ]] || fail "the camera was not written"
