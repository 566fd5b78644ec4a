#!/usr/bin/env bash
# full_disk_test.sh PROGRAM SEQUENCE WORK: results go to a disk that has too little room. What fits is kept, what does
# not is said, by name and exit code; no file is half there. The disk is a small one in memory, mounted where nobody
# else sees it; where that is not allowed the test is skipped (77).
LDSO=$1 SEQUENCE=$2 WORK=$3/full_disk
if [[ -z ${LDSO_IN_NAMESPACE:-} ]]; then
  rm -rf "$WORK" && mkdir -p "$WORK/disk"
  if ! unshare -rm mount -t tmpfs -o size=1m none "$WORK/disk" 2>"$WORK/mount"; then
    echo "skipped: no file system can be mounted here ($(head -n 1 "$WORK/mount"))"
    exit 77
  fi
  LDSO_IN_NAMESPACE=1 exec unshare -rm bash "$0" "$@"
fi
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
disk=$WORK/disk

# new_disk SIZE: an empty one.
new_disk() {
  umount "$disk" 2>/dev/null || true
  mount -t tmpfs -o size="$1" none "$disk"
}

# nothing_half: no file is left under another name than its own, and each that is there can be read as what it is.
nothing_half() {
  local left
  left=$(find "$disk" -name '*.partial')
  [[ -z $left ]] || fail "half a file is left: $left"
  if [[ -e $1/map.ply ]]; then
    local points
    points=$(sed -n 's/^element vertex //p' "$1/map.ply")
    expect_true "map.ply is whole" "$(($(stat -c %s "$1/map.ply") - $(grep -abo end_header "$1/map.ply" | cut -d: -f1) - 11)) == 20 * $points"
  fi
  [[ ! -e $1/run.json ]] || json "$1/run.json" "['counts']" >/dev/null
}

expect_exit 0 run "$SEQUENCE" -o "$WORK/whole"
whole=$(du -sb "$WORK/whole" | cut -f1)

# Room for the trajectory, but not for the map and the recording.
new_disk 48k
expect_exit 3 run "$SEQUENCE" -o "$disk/out"
expect_output '^error: .*/disk/out/map\.ply: cannot be written \(No space left on device\); .*room'
expect_output '^error: .*/disk/out/recording\.ldso: cannot be written'
expect_output '^error: .*/disk/out: results are missing; make room and run again'
cmp "$disk/out/trajectory.txt" "$WORK/whole/trajectory.txt" || fail "the trajectory was not kept"
[[ ! -e $disk/out/map.ply && ! -e $disk/out/recording.ldso ]] || fail "a file is there that had no room"
nothing_half "$disk/out"
if [[ -e $disk/out/run.json ]]; then
  expect_true "run.json says what is missing" "'results are missing' in '''$(json "$disk/out/run.json" "['error']")'''"
fi
# With room again the same folder serves.
mount -o remount,size=$((whole * 2)) "$disk"
expect_exit 0 run "$SEQUENCE" -o "$disk/out"
expect_json "$disk/out/run.json" "['error']" None
cmp "$disk/out/map.ply" "$WORK/whole/map.ply" || fail "the map is another one"

# No room at all: found out before the run.
new_disk 4k
mkdir "$disk/out"
head -c 1000000 /dev/zero >"$disk/filler" 2>/dev/null || true
expect_exit 1 run "$SEQUENCE" -o "$disk/out"
expect_output '^error: .*cannot be written \(No space left on device\)'
if grep -q 'frames/s' "$WORK/log"; then fail "the run was started"; fi
[[ ! -e $disk/out/.ldso_files ]] || fail "a list is left that says nothing"

# Room for more and more, with checkpoints that find none meanwhile.
for size in 24k 96k 160k; do
  new_disk $size
  status=0
  "$LDSO" run "$SEQUENCE" -o "$disk/out" --checkpoint 0.5 >"$WORK/log" 2>&1 || status=$?
  ((status == 0 || status == 3)) || fail "with a disk of $size the run ended with $status"
  ((status == 0)) || expect_output '^error: .*cannot be written'
  nothing_half "$disk/out"
done

# The other commands that write.
new_disk 16k
expect_exit 1 export "$WORK/whole" --format ply -o "$disk/export"
expect_output '^error: .*map\.ply: cannot be written \(No space left on device\)'
expect_exit 1 simulate room --frames 20 --size 160x120 -o "$disk/simulated"
expect_output '^error: .*(cannot be written|cannot be created)'
nothing_half "$disk"

# Output that goes nowhere.
for arguments in "settings --json" "eval $WORK/whole/trajectory.txt $WORK/whole/trajectory.txt"; do
  status=0
  # shellcheck disable=SC2086
  "$LDSO" $arguments >/dev/full 2>"$WORK/log" || status=$?
  ((status == 1)) || fail "ldso $arguments ended with $status although its output was lost"
  expect_output '^error: the output cannot be written'
done
