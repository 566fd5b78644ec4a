#!/usr/bin/env bash
# self_calibration_test.sh PROGRAM SEQUENCE WORK: a sequence whose calibration is wrong by 2 % in the focal lengths and
# whose distortion is off. The run finds out, corrects it, begins anew and is as good as it has to be; the corrected
# calibration is written for later runs; the result does not depend on the number of threads.
LDSO=$1 SEQUENCE=$2 WORK=$3/self_calibration
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
percent() { json "$1/run.json" "['evaluation']['ate_percent_of_path']"; }

awk 'NR == 1 { for (i = 2; i <= 3; i++) $i *= 1.02; $6 += 0.01 } { print }' "$SEQUENCE/camera.txt" >"$WORK/wrong.txt"
true_fx=$(awk 'NR == 1 { print $2 }' "$SEQUENCE/camera.txt")
true_k=$(awk 'NR == 1 { print $6 }' "$SEQUENCE/camera.txt")

# A right calibration stays.
expect_exit 0 run "$SEQUENCE" -o "$WORK/right" --no-loops
expect_json "$WORK/right/run.json" "['self_calibration']['passes']" 1
[[ ! -e $WORK/right/camera.txt ]] || fail "a calibration was written that nothing is wrong with"

# A wrong one is found out.
expect_exit 0 run "$SEQUENCE" -o "$WORK/corrected" --no-loops --calib "$WORK/wrong.txt"
expect_output 'the images contradict the calibration: focal lengths [0-9.]+ [0-9.]+ instead of'
expect_output '^calibration +corrected: focal lengths'
passes=$(json "$WORK/corrected/run.json" "['self_calibration']['passes']")
fx=$(json "$WORK/corrected/run.json" "['self_calibration']['camera']['fx']")
k=$(json "$WORK/corrected/run.json" "['self_calibration']['camera']['distortion'][0]")
expect_true "the run began anew" "$passes > 1"
expect_true "the focal length $fx is found to 0.7 %" "abs($fx / $true_fx - 1) < 0.007"
expect_true "the distortion $k is found" "abs($k - $true_k) < 0.005"
[[ -s $WORK/corrected/camera.txt ]] || fail "the corrected calibration was not written"

# What that is worth.
expect_exit 0 run "$SEQUENCE" -o "$WORK/wrong" --no-loops --calib "$WORK/wrong.txt" --set self_calibration.enabled=false
expect_json "$WORK/wrong/run.json" "['self_calibration']['passes']" 1
echo "ATE in % of the path: right $(percent "$WORK/right"), wrong $(percent "$WORK/wrong"), corrected $(percent "$WORK/corrected")"
expect_true "the ATE is less than a third of that with the wrong calibration" \
  "3 * $(percent "$WORK/corrected") < $(percent "$WORK/wrong")"

# Again with what was found, and with other threads.
expect_exit 0 run "$SEQUENCE" -o "$WORK/again" --no-loops --calib "$WORK/corrected/camera.txt"
expect_json "$WORK/again/run.json" "['self_calibration']['passes']" 1
cmp "$WORK/again/trajectory.txt" "$WORK/corrected/trajectory.txt" || fail "the written calibration gives another trajectory"
expect_exit 0 run "$SEQUENCE" -o "$WORK/threads" --no-loops --calib "$WORK/wrong.txt" --threads 1
cmp "$WORK/threads/trajectory.txt" "$WORK/corrected/trajectory.txt" || fail "the result depends on the number of threads"
