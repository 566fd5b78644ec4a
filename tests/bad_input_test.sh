#!/usr/bin/env bash
# bad_input_test.sh PROGRAM SEQUENCE WORK CASE: what `ldso run` makes of damaged input. SEQUENCE is a sound sequence in
# TUM-mono layout; each case damages a copy of it. Either a clear error, or a warning, a skipped frame and a run that
# goes on.
LDSO=$1 SEQUENCE=$2 WORK=$3/$4 CASE=$4
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

damaged=$WORK/sequence
copy_sequence "$SEQUENCE" "$damaged"
frames=$(find -L "$damaged/images" -type f | wc -l)
out=$WORK/out

# A run that must be refused before it starts: exit code 1, a message, no results.
refused() {
  expect_exit 1 run "$damaged" -o "$out" "${@:2}"
  expect_output "^error: .*$1"
  [[ ! -e $out/trajectory.txt ]] || fail "a refused run has written a trajectory"
}

# A run that must go on in spite of one bad frame: all others have been processed, the reason is in run.json.
goes_on_without() {  # frame, pattern of the warning
  expect_exit 0 run "$damaged" -o "$out"
  expect_output "^warning: frame $1 is skipped: .*$2"
  expect_json "$out/run.json" "['counts']['frames']" "$frames"
  expect_json "$out/run.json" "['counts']['skipped_frames']" 1
  expect_json "$out/run.json" "['counts']['restarts']" 0
  expect_true "the frame has a reason in run.json" \
    "any(s['first'] <= $1 <= s['last'] and 'skipped' in s['reason'] for s in $(json "$out/run.json" "['untracked']"))"
  expect_true "frames after it have poses" "$(poses "$out/trajectory.txt") > $1 + 5"
  local time
  time=$(awk -v n=$(($1 + 1)) '!/^#/ && NF && ++i == n { printf "%.9f", $2 }' "$damaged/times.txt")
  if grep -q "^$time " "$out/trajectory.txt"; then fail "the skipped frame has a pose"; fi
}

case $CASE in
  missing_camera)
    rm "$damaged/camera.txt"
    refused 'calibration: there is none of the camera' --set self_calibration.enabled=false
    refused 'a live run cannot look for it' --live
    ;;
  short_camera)
    sed -i '3,$d' "$damaged/camera.txt"
    refused 'camera\.txt.*(line|four|lines)'
    ;;
  camera_without_numbers)
    sed -i '1s/.*/Pinhole one two three four 0/' "$damaged/camera.txt"
    refused 'camera\.txt:1'
    ;;
  wrong_image_size)  # of all images, according to the calibration
    sed -i '2s/.*/330 250/' "$damaged/camera.txt"
    refused 'the image is [0-9]+x[0-9]+, but the calibration .*330x250'
    ;;
  one_image_of_another_size)
    image=$(own_image "$damaged" 25)
    python3 - "$image" <<'PY'
import struct, sys, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
rows = b"".join(b"\0" + bytes(64) for _ in range(48))
open(sys.argv[1], "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 64, 48, 8, 0, 0, 0, 0))
                              + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
PY
    goes_on_without 25 '64 ?x ?48'
    ;;
  unreadable_image)
    echo "this is no image" >"$(own_image "$damaged" 25)"
    goes_on_without 25 "$(basename "$(own_image "$damaged" 25)")"
    ;;
  truncated_image)
    image=$(own_image "$damaged" 25)
    truncate -s $(($(stat -c %s "$image") / 2)) "$image"
    goes_on_without 25 "$(basename "$image")"
    ;;
  empty_image)
    : >"$(own_image "$damaged" 25)"
    goes_on_without 25 ''
    ;;
  times_too_short)
    sed -i '$d' "$damaged/times.txt"
    sed -i '$d' "$damaged/times.txt"
    expect_exit 0 run "$damaged" -o "$out"
    expect_output '^warning: .*times\.txt'
    expect_json "$out/run.json" "['counts']['frames']" $((frames - 2))
    ;;
  times_too_long)
    echo "99999 99999.5 10" >>"$damaged/times.txt"
    expect_exit 0 run "$damaged" -o "$out"
    expect_output '^warning: .*times\.txt'
    expect_json "$out/run.json" "['counts']['frames']" "$frames"
    ;;
  times_without_numbers)
    sed -i '5s/.*/00004 soon 10/' "$damaged/times.txt"
    refused 'times\.txt:5'
    ;;
  empty_folder)
    rm -rf "$damaged" && mkdir "$damaged"
    refused 'the folder is empty'
    ;;
  no_images)
    rm -rf "${damaged:?}/images" && mkdir "$damaged/images"
    refused 'images'
    ;;
  no_sequence)
    rm -rf "$damaged"
    refused 'no such file or folder'
    ;;
  bad_exposures)  # NaN, zero, negative: unknown, and said once
    awk '/^#/ || !NF { print; next } { n++; e = $3; if (n == 20) e = "nan"; if (n == 30) e = 0; if (n == 40) e = -5;
         print $1, $2, e }' "$damaged/times.txt" >"$WORK/times.txt"
    mv "$WORK/times.txt" "$damaged/times.txt"
    expect_exit 0 run "$damaged" -o "$out"
    expect_output '^warning: .*3 exposure'
    expect_json "$out/run.json" "['counts']['frames']" "$frames"
    expect_true "most frames have a pose" "$(poses "$out/trajectory.txt") > 0.8 * $frames"
    ;;
  no_exposures)  # times without any
    awk '/^#/ || !NF { print; next } { print $1, $2 }' "$damaged/times.txt" >"$WORK/times.txt"
    mv "$WORK/times.txt" "$damaged/times.txt"
    expect_exit 0 run "$damaged" -o "$out"
    expect_true "most frames have a pose" "$(poses "$out/trajectory.txt") > 0.8 * $frames"
    ;;
  black_images)  # nothing to track: results are written all the same, the exit code says so
    read -r width height < <(sed -n 2p "$damaged/camera.txt")
    grey_image "$WORK/black.png" "$width" "$height" 0
    for image in "$damaged"/images/*; do cp --remove-destination "$WORK/black.png" "$image"; done
    expect_exit 2 run "$damaged" -o "$out"
    expect_output '^error: .*no frame could be tracked; last reason: .+'
    expect_json "$out/run.json" "['counts']['frames_with_pose']" 0
    expect_json "$out/run.json" "['first_tracked_frame']" None
    [[ -f $out/trajectory.txt && -f $out/map.ply ]] || fail "results are missing"
    ;;
  damaged_ground_truth)  # is ignored, with a warning
    echo "1.0 north north north" >"$damaged/groundtruth.txt"
    expect_exit 0 run "$damaged" -o "$out"
    expect_output '^warning: .*ground truth is ignored'
    expect_true "there is no evaluation" "'problem' in $(json "$out/run.json" "['evaluation']")"
    ;;
  unwritable_output)  # is found out before the run
    echo "a file" >"$WORK/file"
    expect_exit 1 run "$damaged" -o "$WORK/file/out"
    expect_output '^error: .*the folder cannot be created'
    if grep -q 'frames/s' "$WORK/log"; then fail "the run was started"; fi
    ;;
  range_outside)
    refused 'sequence has only' --start 100000
    refused 'no frame is left' --start 5 --end 5
    ;;
  *)
    fail "there is no case $CASE"
    ;;
esac
