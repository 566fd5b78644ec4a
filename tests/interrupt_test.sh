#!/usr/bin/env bash
# interrupt_test.sh PROGRAM SEQUENCE WORK SIGNAL: a run that is ended by Ctrl-C or `kill` saves what there is.
LDSO=$1 SEQUENCE=$2 WORK=$3/interrupt_$4 SIGNAL=$4
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out

long=$WORK/sequence
long_sequence "$SEQUENCE" "$long"

# Of an earlier run: gone as soon as this one has begun, since run.json says that the folder is complete.
mkdir -p "$out" && echo '{"interrupted": false, "versions": {"ldso": "0.1.0"}}' >"$out/run.json"

# Job control, so that SIGINT is not ignored in the background.
set -m
"$LDSO" run "$long" -o "$out" >"$WORK/log" 2>&1 &
pid=$!
set +m
for ((i = 0; i < 600; i++)); do
  grep -q '^frame 100/' "$WORK/log" && break
  kill -0 "$pid" 2>/dev/null || fail "the run ended by itself"
  sleep 0.1
done
grep -q '^frame 100/' "$WORK/log" || fail "100 frames took more than 60 s"
[[ ! -e $out/run.json ]] || fail "run.json of an earlier run was left while the run goes on"
kill -s "$SIGNAL" "$pid"
status=0
wait "$pid" || status=$?

((status == 130)) || fail "the exit code is $status, expected is 130"
expect_output '^warning: interrupted'
expect_json "$out/run.json" "['interrupted']" True
frames=$(json "$out/run.json" "['counts']['frames']")
expect_true "the run ended early" "100 <= $frames < $total"
expect_true "the trajectory is saved" "$(poses "$out/trajectory.txt") > 50"
expect_json "$out/run.json" "['counts']['frames_with_pose']" "$(poses "$out/trajectory.txt")"
[[ -s $out/map.ply && -s $out/keyframes.txt ]] || fail "map.ply or keyframes.txt is missing"
