#!/usr/bin/env bash
# memory_test.sh PROGRAM SEQUENCE WORK: memory does not grow with the number of frames beyond the trajectory and the
# point cloud.
LDSO=$1 SEQUENCE=$2 WORK=$3/memory
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

# Which thread allocates from which of the C library's arenas is chance, and moves the peak by up to 8 MB: one arena.
export MALLOC_ARENA_MAX=1

# Both are longer than what is kept of the first frames until calibration and start have been judged (575 frames).
repeat_sequence "$SEQUENCE" "$WORK/short" 10
repeat_sequence "$SEQUENCE" "$WORK/long" 26
for length in short long; do
  expect_exit 0 run "$WORK/$length" -o "$WORK/out_$length" --quiet
done
figure() { json "$WORK/out_$1/run.json" "$2"; }
more_frames=$(($(figure long "['counts']['frames']") - $(figure short "['counts']['frames']")))
more_points=$(($(figure long "['counts']['points']") - $(figure short "['counts']['points']")))
growth=$(python3 -c "print($(figure long "['peak_memory_mb']") - $(figure short "['peak_memory_mb']"))")
echo "$more_frames frames and $more_points points more: $growth MB more"
# A record and some copies of it a frame, a point in the map, in the cloud and in the file's buffer; one image with its
# pyramid alone would be 1.6 MB.
expect_true "memory grows by the results only" "$growth < 10 + 2e-3 * $more_frames + 200e-6 * $more_points"
