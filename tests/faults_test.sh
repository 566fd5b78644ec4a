#!/usr/bin/env bash
# faults_test.sh PROGRAM SEQUENCE WORK: a rendered circuit that comes back to its start, with a fault in its middle: frames
# cut out, frames in another order, darkness, a frozen image. The fault is said, no pose is wrong, and a loop joins the
# maps before and after it.
LDSO=$1 SEQUENCE=$2 WORK=$3/faults
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
interval=0.0666666667

# run_fault NAME MOST-WITHOUT-POSE: the run has one part, all its poses are right, and few are missing.
run_fault() {
  local name=$1 missing
  expect_exit 0 run "$WORK/$name" -o "$WORK/out_$name" --set self_calibration.enabled=false
  expect_output '^warning: frame [0-9]+ is lost: '
  expect_json "$WORK/out_$name/run.json" "['segments']" "[]"
  echo "$name: $(grep -E '^warning|^loops|^ATE' "$WORK/log" | tr '\n' ';')"
  expect_true "the ATE is that of an undisturbed run" \
    "$(json "$WORK/out_$name/run.json" "['evaluation']['ate_m']['rmse']") < 2 * $undisturbed"
  missing=$(($(poses "$WORK/$name/times.txt") - $(poses "$WORK/out_$name/trajectory.txt")))
  expect_true "few poses are missing: $missing" "$missing <= $2"
}

expect_exit 0 run "$SEQUENCE" -o "$WORK/undisturbed" --set self_calibration.enabled=false
expect_json "$WORK/undisturbed/run.json" "['counts']['restarts']" 0
undisturbed=$(json "$WORK/undisturbed/run.json" "['evaluation']['ate_m']['rmse']")
echo "undisturbed: ATE $undisturbed m"

reorder_sequence "$SEQUENCE" "$WORK/cut" '[*range(200), *range(245, n)]' $interval truth
run_fault cut 20

reorder_sequence "$SEQUENCE" "$WORK/dark" '[*range(n)]' $interval truth
for ((i = 200; i < 215; i++)); do
  grey_image "$(own_image "$WORK/dark" "$i")" 320 240 2
done
run_fault dark 35
awk -v from=200 -v to=214 '!/^#/ && NF && $1 > (from - 0.5) * 0.0666666667 && $1 < (to + 0.5) * 0.0666666667 { n++ }
                           END { exit n > 0 }' "$WORK/out_dark/trajectory.txt" || fail "a black image has a pose"
