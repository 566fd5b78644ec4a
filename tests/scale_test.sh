#!/usr/bin/env bash
# scale_test.sh PROGRAM SEQUENCE WORK NAME PERCENT OPTIONS...: a known length makes trajectory, map and exports metric,
# within so many percent of the truth.
LDSO=$1 SEQUENCE=$2 WORK=$3/scale_$4 PERCENT=$5
shift 5
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
out=$WORK/out

expect_exit 0 run "$SEQUENCE" -o "$out" --no-loops --quiet "$@"
expect_json "$out/run.json" "['scale']['metric']" True
grep -v warning "$WORK/log" || true
scale=$(json "$out/run.json" "['evaluation']['S_truth_estimate']['scale']")
echo "scale of the truth in the map: $scale, $(json "$out/run.json" "['scale']")"
expect_true "the map is metric within $PERCENT %" "abs($scale - 1) < 0.01 * $PERCENT"

# A run without it is another one by this factor alone, and exports are in metres as well.
expect_exit 0 run "$SEQUENCE" -o "$WORK/free" --no-loops
expect_json "$WORK/free/run.json" "['scale']" None
expect_exit 0 export "$out" --format ply,tum
python3 - "$out" "$WORK/free" "$(json "$out/run.json" "['scale']['metres_per_unit']")" <<'PY' || fail "the units differ"
import struct, sys
out, free, factor = sys.argv[1], sys.argv[2], float(sys.argv[3])
def cloud(path):
    data = open(path, "rb").read()
    end = b"end_header\n"
    return [p[:3] for p in struct.iter_unpack("<fff4Bf", data[data.index(end) + len(end):])]
def poses(path):
    return [list(map(float, line.split())) for line in open(path) if not line.startswith("#")]
metric, unit = poses(out + "/trajectory.txt"), poses(free + "/trajectory.txt")
assert len(metric) == len(unit) > 50
for a, b in zip(metric, unit):
    assert all(abs(x - factor * y) <= 1e-5 * max(1, abs(x)) for x, y in zip(a[1:4], b[1:4])), (a, b)
exported = poses(out + "/export/trajectory_tum.txt")
assert len(exported) == len(metric)
for a, b in zip(metric, exported):
    assert all(abs(x - y) <= 1e-9 for x, y in zip(a, b)), (a, b)
metric, exported = cloud(out + "/map.ply"), cloud(out + "/export/map.ply")
assert len(metric) == len(exported) > 500
for a, b in zip(metric, exported):
    assert all(abs(x - y) <= 1e-4 * max(1, abs(x)) for x, y in zip(a, b)), (a, b)
PY

# What cannot be is said before the run, what is not found after it.
expect_exit 1 run "$SEQUENCE" -o "$WORK/bad" --scale 3 3 1
expect_output 'both frames are the same one'
expect_exit 1 run "$SEQUENCE" -o "$WORK/bad" --scale 3 100000 1
expect_output 'there is no frame 100000'
expect_exit 1 run "$SEQUENCE" -o "$WORK/bad" --scale-tag 36h12:1:0.1
expect_output "there is no family '36h12'"
expect_exit 1 run "$SEQUENCE" -o "$WORK/bad" --scale-height -2
expect_output 'is no length'
[[ ! -e $WORK/bad ]] || fail "a refused run has made its folder"
expect_exit 0 run "$SEQUENCE" -o "$WORK/none" --no-loops --quiet --end 60 --scale-tag 25h9:9:0.1
expect_output '^warning: the scale stays free, tag 25h9:9 of 0.1 m: the tag is found in 0 images'
expect_json "$WORK/none/run.json" "['scale']['metric']" False
