#!/usr/bin/env bash
# bench_test.sh PROGRAM SEQUENCE WORK: `ldso bench` says in one line how fast the machine is, with settings as everywhere.
LDSO=$1 WORK=$3/bench
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

expect_exit 0 bench --frames 60 --runs 1 --set preset=fast
expect_output '^ldso [0-9.]+: [0-9.]+ frames/s \([0-9.]+ to [0-9.]+ in 1 runs\) on the built-in room, 60 frames of 424x318, 2 threads; tracking [0-9.]+ ms, a keyframe [0-9.]+ ms$'
expect_exit 1 bench --set preset=faster
expect_output "there is no preset 'faster'; there are: default, fast"
expect_exit 1 bench --frames 3
