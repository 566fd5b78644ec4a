#!/usr/bin/env bash
# determinism_test.sh PROGRAM SEQUENCE WORK: the same input gives the same bits, in every run and for 1, 2 and 4 threads.
LDSO=$1 SEQUENCE=$2 WORK=$3/determinism
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

for run in 1 2 4 2_again; do
  expect_exit 0 run "$SEQUENCE" -o "$WORK/$run" --threads "${run%_again}" --quiet
done
expect_true "there is something to compare" "$(poses "$WORK/1/trajectory.txt") > 20"
for run in 2 4 2_again; do
  for file in trajectory.txt keyframes.txt map.ply; do
    cmp "$WORK/1/$file" "$WORK/$run/$file" || fail "$file differs between --threads 1 and run $run"
  done
done
