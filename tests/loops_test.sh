#!/usr/bin/env bash
# loops_test.sh PROGRAM SEQUENCE WORK: loop closing on a rendered circuit that comes back to its start and whose
# photometric calibration is withheld, so that the odometry drifts.
LDSO=$1 SEQUENCE=$2 WORK=$3/loops
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out

expect_exit 0 run "$SEQUENCE" -o "$out" --loop-pictures --threads 1
expect_output '^loops +[1-9][0-9]* closed, [0-9]+ candidates refused'
expect_output '^ +[0-9.]+ m before loop closing'
for file in trajectory.txt trajectory_odometry.txt keyframes.txt map.ply map_odometry.ply loops.json run.json; do
  [[ -s $out/$file ]] || fail "$file is missing or empty"
done

# Loops were closed, and it was worth it.
closed=$(json "$out/run.json" "['counts']['loops_closed']")
expect_true "loops are closed" "$closed >= 3"
before=$(json "$out/run.json" "['evaluation_odometry']['ate_m']['rmse']")
after=$(json "$out/run.json" "['evaluation']['ate_m']['rmse']")
echo "$closed loops, ATE $before m before, $after m after"
expect_true "loops make it better" "$after < 0.7 * $before"
expect_exit 0 eval "$out/trajectory_odometry.txt" "$SEQUENCE" --json "$WORK/eval.json"
expect_true "trajectory_odometry.txt is what was before" \
  "abs($(json "$WORK/eval.json" "['ate_m']['rmse']") - $before) < 1e-3 * $before"
cmp -s "$out/trajectory.txt" "$out/trajectory_odometry.txt" && fail "loops have changed no pose"
cmp -s "$out/map.ply" "$out/map_odometry.ply" && fail "loops have changed no point"
[[ $(poses "$out/trajectory.txt") == $(poses "$out/trajectory_odometry.txt") ]] || fail "poses are not as many"

# loops.json agrees with run.json, with the pictures and with the truth.
expect_true "all closed loops are listed" "len($(json "$out/loops.json" "['accepted']")) == $closed"
expect_true "all candidates are listed" \
  "len($(json "$out/loops.json" "['refused']")) == $(json "$out/run.json" "['counts']['loop_candidates']") - $closed"
python3 - "$out" "$SEQUENCE" <<'PY' || fail "a closed loop is wrong, or its picture is missing"
import json, math, os, sys
out, sequence = sys.argv[1:]
lines = [line.split() for line in open(sequence + "/groundtruth.txt") if not line.startswith("#")]
truth = [[float(x) for x in line[1:]] for line in lines]  # One pose for each frame.
scale = json.load(open(out + "/run.json"))["evaluation_odometry"]["S_truth_estimate"]["scale"]

def rotation(q):  # of x y z w
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]

for loop in json.load(open(out + "/loops.json"))["accepted"]:
    name = "%d_%d.png" % (loop["keyframe"], loop["candidate"])
    assert os.path.getsize(out + "/loops/" + name) > 10000, name
    keyframe, candidate = truth[loop["keyframe"]], truth[loop["candidate"]]
    A, B = rotation(keyframe[3:]), rotation(candidate[3:])
    S = loop["S_keyframe_candidate"]
    E = rotation(S["quaternion_xyzw"])
    # Trace of E^T A^T B: of the rotation from the estimate to the truth.
    R = [[sum(A[k][i] * B[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    trace = sum(E[i][j] * R[i][j] for i in range(3) for j in range(3))
    angle = math.degrees(math.acos(max(-1, min(1, (trace - 1) / 2))))
    d = [candidate[i] - keyframe[i] for i in range(3)]
    t = [sum(A[k][i] * d[k] for k in range(3)) for i in range(3)]
    off = math.dist(t, [scale * x for x in S["translation"]])
    assert angle < 3 and off < 0.05 + 0.15 * math.hypot(*d), (name, angle, off)
assert len(os.listdir(out + "/loops")) == len(json.load(open(out + "/loops.json"))["accepted"])
PY

# The same bits for any number of threads.
cp -r "$out" "$WORK/first"
expect_exit 0 run "$SEQUENCE" -o "$out" --threads 2 --quiet
[[ ! -e $out/loops ]] || fail "pictures of an earlier run were left"
for file in trajectory.txt trajectory_odometry.txt keyframes.txt map.ply map_odometry.ply loops.json; do
  cmp "$WORK/first/$file" "$out/$file" || fail "$file differs between --threads 1 and 2"
done

# Without loops: the odometry is the same, and nothing of theirs is left.
expect_exit 0 run "$SEQUENCE" -o "$out" --no-loops
expect_output '^loops +off'
for file in trajectory_odometry.txt map_odometry.ply loops.json loops; do
  [[ ! -e $out/$file ]] || fail "$file of an earlier run was left"
done
expect_json "$out/run.json" "['settings']['loops']['enabled']" False
expect_json "$out/run.json" "['counts']['loop_candidates']" 0
expect_true "there is one evaluation" "'evaluation_odometry' not in $(json "$out/run.json" "")"
cmp "$out/trajectory.txt" "$WORK/first/trajectory_odometry.txt" || fail "loop closing has changed the odometry"
cmp "$out/map.ply" "$WORK/first/map_odometry.ply" || fail "loop closing has changed the odometry's points"

status=0
"$LDSO" run "$SEQUENCE" -o "$out" --no-loops --loop-pictures >"$WORK/log" 2>&1 || status=$?
((status != 0)) || fail "--loop-pictures without loops was taken"
expect_output 'loop-pictures'
