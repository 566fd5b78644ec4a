#!/usr/bin/env bash
# doctor_command_test.sh PROGRAM SEQUENCE WORK: `ldso doctor` as it is called: text, JSON, files, exit codes, and that a run
# points to it.
LDSO=$1 SEQUENCE=$2 WORK=$3/doctor
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

expect_exit 0 doctor "$SEQUENCE"
expect_output 'TUM-mono, 60 frames, 30\.00 frames/s'
expect_exit 0 doctor "$SEQUENCE" --json --trial 0 -o "$WORK/out"
for file in doctor.json preview.png; do
  [[ -s $WORK/out/$file ]] || fail "$file is missing or empty"
done
[[ ! -e $WORK/out/mask.png ]] || fail "there is a mask, but nothing to mask"
expect_json "$WORK/out/doctor.json" "['exit_code']" 0
python3 -c "import json, sys; json.load(open(sys.argv[1]))" "$WORK/log" || fail "--json prints something else as well"
expect_exit 0 doctor "$SEQUENCE" --json --trial 0 -o "$WORK/out"

# Somebody's files stay, and the sequence is not written to.
mkdir "$WORK/mine" && echo mine >"$WORK/mine/preview.png"
expect_exit 1 doctor "$SEQUENCE" --trial 0 -o "$WORK/mine"
[[ $(cat "$WORK/mine/preview.png") == mine ]] || fail "a file of somebody else was touched"
expect_exit 1 doctor "$SEQUENCE" --trial 0 -o "$SEQUENCE"
expect_output 'is the folder of the sequence itself'

# Faults: exit codes and the gravest first.
copy_sequence "$SEQUENCE" "$WORK/gap"
awk '!/^#/ && n++ >= 30 { $2 = sprintf("%.6f", $2 + 2) } { print }' "$SEQUENCE/times.txt" >"$WORK/gap/times.txt"
expect_exit 2 doctor "$WORK/gap" --trial 0
expect_output '^warning \[times\.gaps\]'
copy_sequence "$SEQUENCE" "$WORK/blind"
echo 'Pinhole 100 100' >"$WORK/blind/camera.txt"
expect_exit 1 doctor "$WORK/blind"
expect_output '^error \[input\.unusable\]'
expect_output 'camera\.txt'
expect_exit 1 doctor "$WORK/nothing"
expect_exit 1 doctor camera:0
expect_output 'is a camera'

# A run that does not come to a map says where to look.
reorder_sequence "$SEQUENCE" "$WORK/standing" '[0] * 130' 0.0333333333
expect_exit 2 run "$WORK/standing" -o "$WORK/standing_out"
expect_output 'no map has begun within .*ldso doctor .*standing'
expect_output '^error: .*no frame could be tracked.*ldso doctor'
expect_exit 2 doctor "$WORK/standing"
expect_output '^warning \[motion\.no_start\]'
