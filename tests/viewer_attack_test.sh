#!/usr/bin/env bash
# viewer_attack_test.sh PROGRAM SEQUENCE WORK: malformed HTTP and WebSocket traffic, wrong hosts, origins and tokens and
# crowds of connections at a run that is watched: they are refused or held, and the run gives the bits it gives alone.
LDSO=$1 SEQUENCE=$2 WORK=$3/viewer_attack
rm -rf "$WORK" && mkdir -p "$WORK"
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/test_tools.sh"
unset DISPLAY WAYLAND_DISPLAY

repeat_sequence "$SEQUENCE" "$WORK/sequence" 4
expect_exit 0 run "$WORK/sequence" -o "$WORK/alone" --quiet
for address in 127.0.0.1:0 0.0.0.0:0; do
  : >"$WORK/log"  # The run empties it only when it begins, and until then the last one's address stands there.
  "$LDSO" run "$WORK/sequence" -o "$WORK/attacked" --view="$address" --view-paused --view-exit >"$WORK/log" 2>&1 &
  pid=$!
  trap 'kill -KILL "$pid" 2>/dev/null || true' EXIT
  url=
  for ((i = 0; i < 600; i++)); do
    url=$(sed -n 's/^viewer  *//p' "$WORK/log")
    [[ -z $url ]] || break
    kill -0 "$pid" 2>/dev/null || fail "the run ended by itself"
    sleep 0.1
  done
  [[ -n $url ]] || fail "there is no address after 60 s"
  python3 "$here/viewer_attack.py" "$url" || fail "an attack on $address was not refused"
  status=0
  wait "$pid" || status=$?
  trap - EXIT
  ((status == 0)) || fail "the exit code is $status"
  for file in trajectory.txt keyframes.txt map.ply trajectory_odometry.txt loops.json; do
    cmp "$WORK/alone/$file" "$WORK/attacked/$file" || fail "$file depends on attacks"
  done
done
