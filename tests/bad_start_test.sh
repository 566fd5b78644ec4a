#!/usr/bin/env bash
# bad_start_test.sh PROGRAM SEQUENCE WORK: a sequence that begins slowly before a window, where the first map is wrong and
# its scale drifts by a factor of three. The map that takes its place is right; without the two safeguards of a start
# the run is wrong by far, so that the bound would tell if one of them stopped working.
LDSO=$1 SEQUENCE=$2 WORK=$3/bad_start
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
percent() { json "$1/run.json" "['evaluation']['ate_percent_of_path']"; }

expect_exit 0 run "$SEQUENCE" -o "$WORK/healed" --no-loops --set self_calibration.enabled=false
expect_output 'explains the images better .* takes the place of the first one'
expect_exit 0 run "$SEQUENCE" -o "$WORK/first" --no-loops --set self_calibration.enabled=false --set revision.enabled=false
echo "ATE in % of the path: healed $(percent "$WORK/healed"), first map $(percent "$WORK/first")"
expect_true "every frame has a pose" "$(poses "$WORK/healed/trajectory.txt") == 300"
expect_true "the start has healed" "$(percent "$WORK/healed") < 2"
expect_true "it was bad" "$(percent "$WORK/first") > 8"
