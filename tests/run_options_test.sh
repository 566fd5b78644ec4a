#!/usr/bin/env bash
# run_options_test.sh PROGRAM SEQUENCE WORK: the options of `ldso run` do what they say.
LDSO=$1 SEQUENCE=$2 WORK=$3/run_options
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out
frames=$(awk '!/^#/ && NF { n++ } END { print n }' "$SEQUENCE/times.txt")
time_of() { awk -v n=$(($1 + 1)) '!/^#/ && NF && ++i == n { printf "%.9f", $2 }' "$SEQUENCE/times.txt"; }
times() { awk '!/^#/ && NF { printf "%.9f\n", $1 }' "$out/trajectory.txt"; }

expect_exit 0 run "$SEQUENCE" -o "$out" --quiet
[[ ! -s $WORK/log ]] || fail "--quiet has printed something"
first=$(json "$out/run.json" "['initialized_at'][0]")
[[ -s $out/trajectory.svg ]] || fail "trajectory.svg is missing"

# A part of the sequence: only its frames are read.
expect_exit 0 run "$SEQUENCE" -o "$out" --start 10 --end 50
expect_json "$out/run.json" "['counts']['frames']" 40
expect_true "times are within the part" "$(times | sort -n | sed -n 1p) >= $(time_of 10)"
expect_true "times are within the part" "$(times | sort -n | tail -1) == $(time_of 49)"
[[ ! -e $out/trajectory_kitti.txt ]] || fail "trajectory_kitti.txt was not asked for"

expect_exit 0 run "$SEQUENCE" -o "$out" --stride 2 --kitti
expect_json "$out/run.json" "['counts']['frames']" $(((frames + 1) / 2))
[[ $(poses "$out/trajectory_kitti.txt") == $(poses "$out/trajectory.txt") ]] || fail "KITTI poses are not as many"

# Played backwards: times decrease and are those of the sequence; the map is as good.
expect_exit 0 run "$SEQUENCE" -o "$out" --reverse
times >"$WORK/times"
sort -c -n -r "$WORK/times" || fail "times do not decrease"
[[ $(tail -1 "$WORK/times") == $(time_of 0) ]] || fail "the last time is not that of frame 0"
expect_output '^ATE \(Sim3\)'
[[ ! -e $out/trajectory_kitti.txt ]] || fail "trajectory_kitti.txt of an earlier run was left"

# Settings: file, then command line; all of them are reported.
printf 'selection:\n  strategy: gradient\n  candidates: 700\nkeyframes: {window_max: 6}\n' >"$WORK/settings.yaml"
expect_exit 0 run "$SEQUENCE" -o "$out" --config "$WORK/settings.yaml" --set selection.candidates=800 --threads 1
expect_json "$out/run.json" "['settings']['selection']['strategy']" gradient
expect_json "$out/run.json" "['settings']['selection']['candidates']" 800
expect_json "$out/run.json" "['settings']['keyframes']['window_max']" 6
expect_json "$out/run.json" "['settings']['threads']" 1
expect_true "the gradient selection tracks" "$(poses "$out/trajectory.txt") > $frames / 2"
expect_exit 0 run "$SEQUENCE" -o "$out" --set selection.strategy=random
expect_true "the random selection tracks" "$(poses "$out/trajectory.txt") > $frames / 2"

# A calibration of its own.
expect_exit 1 run "$SEQUENCE" -o "$out" --calib "$WORK/no_such_camera.txt"
expect_output 'no_such_camera\.txt'
sed '3s/.*/full/' "$SEQUENCE/camera.txt" >"$WORK/camera.txt"
expect_exit 0 run "$SEQUENCE" -o "$out" --calib "$WORK/camera.txt"
expect_true "the given calibration is used" "'full' in '''$(json "$out/run.json" "['sequence']['camera']")'''"

# Too little ground truth to be compared with: said, and no failure.
cp -r "$SEQUENCE" "$WORK/little_truth"
grep -v '^#' "$SEQUENCE/groundtruth.txt" | sed -n 1,2p >"$WORK/little_truth/groundtruth.txt"
expect_exit 0 run "$WORK/little_truth" -o "$out" --end $((first + 1))
expect_output '^not evaluated: .+'
[[ ! -e $out/trajectory.svg ]] || fail "trajectory.svg of an earlier run was left"

# Nothing tracked: exit code 2, and why.
expect_exit 2 run "$SEQUENCE" -o "$out" --end 2
expect_output '^error: .*no frame could be tracked; last reason: .+'
expect_json "$out/run.json" "['counts']['frames_with_pose']" 0

