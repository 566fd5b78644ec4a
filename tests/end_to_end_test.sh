#!/usr/bin/env bash
# end_to_end_test.sh PROGRAM SEQUENCE WORK NAME BOUND [OPTIONS...]: a whole run over a rendered sequence. Its ATE must
# not exceed BOUND % of the path, every frame from the tenth on must have a pose, and all files must be there and agree.
LDSO=$1 SEQUENCE=$2 WORK=$3/end_to_end_$4 BOUND=$5
options=("${@:6}")
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out

expect_exit 0 run "$SEQUENCE" -o "$out" --no-loops --kitti "${options[@]}"
expect_output '^ATE \(Sim3\) +[0-9.]+ m rmse, [0-9.]+ % of the path'
expect_output '^frame [0-9]+/[0-9]+ +[0-9.]+ frames/s +[0-9]+ keyframes +tracked'
for file in trajectory.txt trajectory_kitti.txt keyframes.txt map.ply run.json trajectory.svg; do
  [[ -s $out/$file ]] || fail "$file is missing or empty"
done

frames=$(json "$out/run.json" "['counts']['frames']")
expect_true "all images were read" "$frames == $(json "$out/run.json" "['sequence']['frames']")"
expect_json "$out/run.json" "['counts']['frames_with_pose']" "$(poses "$out/trajectory.txt")"
expect_json "$out/run.json" "['counts']['keyframes']" "$(poses "$out/keyframes.txt")"
expect_true "KITTI poses are as many" "$(poses "$out/trajectory_kitti.txt") == $(poses "$out/trajectory.txt")"
expect_json "$out/run.json" "['counts']['points']" "$(sed -n 's/^element vertex //p;/^end_header/q' "$out/map.ply" | sed -n 1p)"
expect_json "$out/run.json" "['counts']['restarts']" 0
expect_true "there are points" "$(json "$out/run.json" "['counts']['points']") > 500"
expect_true "no frame after the tenth is without a pose" \
  "all(s['last'] < 10 for s in $(json "$out/run.json" "['untracked']"))"
expect_true "untracked frames are counted" \
  "sum(s['last'] - s['first'] + 1 for s in $(json "$out/run.json" "['untracked']")) == $frames - $(poses "$out/trajectory.txt")"
expect_true "the map is initialized early" "$(json "$out/run.json" "['initialized_at']")[0] < 20"
expect_true "stages were timed" \
  "{'decode', 'preprocess', 'odometry'} <= set($(json "$out/run.json" "['timing']['stages']"))"

expect_true "libraries have versions" "all(v[:1].isdigit() for v in $(json "$out/run.json" "['versions']['libraries']").values())"
expect_true "Ceres is one of them" "'Ceres' in $(json "$out/run.json" "['versions']['libraries']")"

# Timestamps are those of the sequence.
awk '!/^#/ && NF { print $1 }' "$out/trajectory.txt" | sed 's/0*$//' | sort >"$WORK/times_out"
awk '!/^#/ && NF { printf "%.9f\n", $2 }' "$SEQUENCE/times.txt" | sed 's/0*$//' | sort >"$WORK/times_in"
[[ -z $(comm -23 "$WORK/times_out" "$WORK/times_in") ]] || fail "trajectory.txt has times that the sequence has not"

expect_exit 0 eval "$out/trajectory.txt" "$SEQUENCE" --json "$WORK/eval.json"
percent=$(json "$WORK/eval.json" "['ate_percent_of_path']")
echo "ATE $percent % of the path (bound $BOUND)"
expect_true "ATE is within its bound" "$percent <= $BOUND"
expect_true "run.json holds the same ATE" \
  "abs($(json "$out/run.json" "['evaluation']['ate_percent_of_path']") - $percent) < 1e-3 * $percent + 1e-6"
