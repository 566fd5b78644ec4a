#!/usr/bin/env bash
# viewer_test.sh PROGRAM SEQUENCE WORK HAS_VIEWER: the viewer on the command line; a run that is watched gives the same
# bits as one that is not.
LDSO=$1 SEQUENCE=$2 WORK=$3/viewer_command_line HAS_VIEWER=$4
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
unset DISPLAY WAYLAND_DISPLAY

expect_exit 0 run "$SEQUENCE" -o "$WORK/alone" --quiet
[[ -s $WORK/alone/recording.ldso ]] || fail "there is no recording"
expect_exit 1 view "$WORK"
expect_output 'recording.ldso: there is no recording'
head -c 1000 "$WORK/alone/recording.ldso" >"$WORK/damaged.ldso"
expect_exit 1 view "$WORK/damaged.ldso"
expect_output 'damaged.ldso: it ends too early'

if [[ $HAS_VIEWER != ON ]]; then
  expect_exit 1 run "$SEQUENCE" -o "$WORK/watched" --view
  expect_output 'this ldso was built without it; install'
  exit 0
fi

expect_exit 1 run "$SEQUENCE" -o "$WORK/watched" --view=1.2.3.4.5
expect_output '1.2.3.4.5: it is no IP address'
expect_exit 1 run "$SEQUENCE" -o "$WORK/watched" --view=127.0.0.1:x
expect_output "'x' is no port"
expect_exit 0 run "$SEQUENCE" -o "$WORK/watched" --view --view-exit
expect_output '^viewer +http://127\.0\.0\.1:[0-9]+/$'
for file in trajectory.txt keyframes.txt map.ply trajectory_odometry.txt loops.json; do
  cmp "$WORK/alone/$file" "$WORK/watched/$file" || fail "$file depends on being watched"
done
expect_exit 0 run "$SEQUENCE" -o "$WORK/open" --view=0.0.0.0 --view-exit
expect_output '^viewer +http://127\.0\.0\.1:[0-9]+/\?token=[0-9a-f]{32}$'
