#!/usr/bin/env bash
# resume_test.sh PROGRAM SEQUENCE WORK: a run that is killed leaves a checkpoint, of which `ldso resume` makes results.
LDSO=$1 SEQUENCE=$2 WORK=$3/resume
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out

long=$WORK/sequence
long_sequence "$SEQUENCE" "$long"

"$LDSO" run "$long" -o "$out" --checkpoint 1 >"$WORK/log" 2>&1 &
pid=$!
has_poses() { [[ -e $out/checkpoint.json ]] && (($(json "$out/checkpoint.json" "['counts']['frames_with_pose']") > 50)); }
for ((i = 0; i < 600; i++)); do
  has_poses && break
  kill -0 "$pid" 2>/dev/null || fail "the run ended by itself"
  sleep 0.1
done
has_poses || fail "no checkpoint with 50 poses within 60 s"
kill -s KILL "$pid"
status=0
wait "$pid" || status=$?
((status == 137)) || fail "the exit code is $status, expected is 137"
[[ ! -e $out/run.json ]] || fail "there is a run.json though the run was killed"

expect_exit 0 resume "$out"
expect_output '^frames  .* frames, .* with a pose'
[[ ! -e $out/checkpoint.json ]] || fail "the checkpoint is left"
expect_json "$out/run.json" "['interrupted']" True
frames=$(json "$out/run.json" "['counts']['frames']")
expect_true "the results are those of the checkpoint" "50 < $frames < $total"
# Killed while the next checkpoint was being written, the files may be newer than the figures.
expect_true "the trajectory is saved" "$(poses "$out/trajectory.txt") > 50"
[[ -s $out/map.ply && -s $out/keyframes.txt && -s $out/recording.ldso ]] || fail "files are missing"

expect_exit 0 export "$out" --format tum
expect_exit 0 resume "$out"
expect_output 'has ended with results already'
mkdir -p "$WORK/empty"
expect_exit 1 resume "$WORK/empty"
expect_output 'there is no checkpoint of a run'

# A run that ends by itself leaves none.
expect_exit 0 run "$SEQUENCE" -o "$out" --checkpoint 0.1
[[ -e $out/run.json && ! -e $out/checkpoint.json ]] || fail "a finished run leaves a checkpoint"
expect_json "$out/run.json" "['interrupted']" False
