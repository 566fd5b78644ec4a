#!/usr/bin/env bash
# experiment_demo_test.sh PROGRAM WORK: the pipeline of all three benchmarks on small stand-ins.
LDSO=$1 WORK=$2/experiment_demo
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out

expect_exit 0 experiment --demo --size small -o "$out"
expect_output '^finished       18 jobs$'
expect_output '^run here       18$'

# Each format is what it stands for, and each ground truth is used.
expect_run() { # JOB FORMAT EXPRESSION LIMIT
  local run=$out/jobs/$1/run.json
  expect_json "$run" "['sequence']['format']" "$2"
  expect_json "$run" "['counts']['frames_with_pose']" "$(json "$run" "['counts']['frames']")"
  expect_true "the error of $1 is small" "0 < $(json "$run" "['evaluation']$3") < $4"
}
for direction in forward backward; do
  for variant in corners gradient_no_loops random_no_loops; do
    expect_run "sequence_01/$variant/${direction}_0" TUM-mono "['tum_mono']['e_align']" 0.15
    expect_run "V1_01/$variant/${direction}_0" EuRoC "['ate_percent_of_path']" 1
    expect_run "00/$variant/${direction}_0" KITTI "['ate_percent_of_path']" 0.05
  done
done

# The figures and tables of all of them.
for file in index.html summary.md results.csv figures/blocks_e_align_tum_mono.svg figures/curves_ate_euroc.svg \
  figures/curves_ate_kitti.svg tables/ate_kitti.tex tables/runtime.md; do
  [[ -s $out/summary/$file ]] || fail "$file is missing in the summary"
done
expect_output '^runs +18 finished, 0 failed, 0 pending$'

# Again: nothing is rendered and nothing is run.
expect_exit 0 experiment demo --size small -o "$out"
expect_output '^run here       0$'
! grep -q rendering "$WORK/log" || fail "stand-ins that were there were rendered again"

# The same in the other order, and in silence; the summary is written all the same.
rm -r "$out/summary"
expect_exit 0 experiment --size small -o "$out" --demo --quiet
[[ ! -s $WORK/log ]] || fail "--quiet has printed something"
[[ -s $out/summary/index.html ]] || fail "--quiet has left the summary out"
