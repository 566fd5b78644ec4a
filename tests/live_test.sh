#!/usr/bin/env bash
# live_test.sh PROGRAM SEQUENCE WORK: a sequence played at its own pace, one that comes too fast, and cameras that are
# not there.
LDSO=$1 SEQUENCE=$2 WORK=$3/live
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

frames=$(find "$SEQUENCE/images" -name '*.*' | wc -l)
expect_live() { # OUT: all frames are accounted for
  local run=$1/run.json
  expect_json "$run" "['sequence']['frames']" "$frames"
  expect_true "frames add up" "$(json "$run" "['counts']['frames']") + $(json "$run" "['live']['dropped_frames']") == $frames"
  expect_true "frames took their time" "$(json "$run" "['live']['mean_latency_ms']") > 0"
}

seconds=$(awk '!/^#/ && NF { if (!n++) first = $2; last = $2 } END { print last - first }' "$SEQUENCE/times.txt")
expect_exit 0 run "$SEQUENCE" -o "$WORK/paced" --live
expect_output '^live +[0-9]+ frames dropped'
expect_live "$WORK/paced"
expect_true "it is played at its own pace" "$(json "$WORK/paced/run.json" "['timing']['wall_s']") > 0.99 * $seconds"

# A thousand frames a second.
copy_sequence "$SEQUENCE" "$WORK/fast"
awk '{ $2 = 0.001 * n++; print }' <(grep -v '^#' "$SEQUENCE/times.txt") >"$WORK/fast/times.txt"
rm -f "$WORK/fast/groundtruth.txt"
# Whether anything can be tracked then is another matter.
status=0
"$LDSO" run "$WORK/fast" -o "$WORK/dropped" --live >"$WORK/log" 2>&1 || status=$?
((status == 0 || status == 2)) || fail "it ended with $status"
expect_output '^warning: [0-9]+ frames were dropped, at most [0-9]+ in a row: they came faster'
expect_live "$WORK/dropped"
expect_true "frames are dropped" "$(json "$WORK/dropped/run.json" "['live']['dropped_frames']") > 10"
expect_true "and they are missed" "$(json "$WORK/dropped/run.json" "['live']['longest_gap']") > 1"
grep -q 'frames dropped' "$WORK/dropped/report.html" || fail "the report does not say that frames were dropped"

# The same without haste has nothing of it.
expect_exit 0 run "$SEQUENCE" -o "$WORK/paced" --end 20 --quiet
expect_json "$WORK/paced/run.json" "['live']" None

expect_exit 1 run camera:97 -o "$WORK/camera" --live --calib "$SEQUENCE/camera.txt"
expect_output 'camera:97: there is no such camera.*/dev/video\*'
expect_exit 1 run camera:0 -o "$WORK/camera"
expect_output 'camera:0: a camera needs its calibration.*--calib'
expect_exit 1 run camera:0 -o "$WORK/camera" --calib "$SEQUENCE/camera.txt" --reverse
expect_output 'camera:0: a camera can only be played from now on'
expect_exit 1 run "$SEQUENCE" -o "$WORK/camera" --live --view --view-paused
expect_output 'live'
