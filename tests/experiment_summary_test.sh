#!/usr/bin/env bash
# experiment_summary_test.sh PROGRAM SEQUENCE WORK: figures, tables and comparisons of made-up experiments, and metrics by
# name.
LDSO=$1 WORK=$3/experiment_summary
rm -rf "$WORK" && mkdir -p "$WORK"
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/test_tools.sh"

make_experiment() { python3 "$here/make_experiment.py" "$@"; }
results() { json "$1/summary/results.json" "$2"; }

# Nothing to see yet.
expect_exit 1 experiment summarize "$WORK/none"
expect_output '^error: .*none: is not the folder of an experiment'
mkdir -p "$WORK/empty/jobs"
expect_exit 1 experiment summarize "$WORK/empty"
expect_output '^error: .*holds no job'
make_experiment "$WORK/pending" --pending 1 --poses 50
expect_exit 0 experiment summarize "$WORK/pending"
expect_output '0 finished, 0 failed, 36 pending'
[[ -s $WORK/pending/summary/index.html ]] || fail "there is no index"

# Three data sets, one of them with ground truth at both ends only.
a=$WORK/a
make_experiment "$a" --poses 120
make_experiment "$a" --poses 120 --dataset tum_mono --metric tum_mono --sequences s01,s02
make_experiment "$a" --poses 120 --dataset kitti --sequences 00,05 --variants corners,corners_no_loops --directions forward
expect_exit 0 experiment summarize "$a"
expect_output '68 finished, 0 failed, 0 pending'
expect_output '^\| corners, forward, before loops '
for figure in blocks_ate_euroc curves_ate_euroc blocks_e_align_tum_mono curves_e_align_tum_mono curves_e_t_tum_mono \
  curves_e_r_tum_mono curves_e_s_tum_mono blocks_ate_kitti trajectory_00_corners_forward_0; do
  [[ -s $a/summary/figures/$figure.svg ]] || fail "there is no figure $figure"
  python3 -c "import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])" "$a/summary/figures/$figure.svg" ||
    fail "$figure.svg is no XML"
  grep -q "figures/$figure.svg" "$a/summary/index.html" || fail "$figure is not in index.html"
  grep -q "figures/$figure.svg" "$a/summary/summary.md" || fail "$figure is not in summary.md"
done
if grep -q 'LDSO (published)' "$a/summary/tables/ate_kitti.md"; then fail "published figures stand beside an excerpt"; fi
grep -q '^corners,' "$a/summary/tables/runtime.csv" || fail "the runtime table is missing"
[[ $(wc -l <"$a/summary/results.csv") == 69 ]] || fail "results.csv has not a line a job"
# The odometry's scale was made to drift; loop closing takes three quarters of it away.
expect_true "loops help" "all(r['ate_m'] < r['before_loops_ate_m'] for r in $(results "$a" "") if r['dataset'] == 'kitti' and r['loops'])"
expect_true "drift was measured" "all(0 < abs(1 - r['e_s']) < 0.3 for r in $(results "$a" "") if r['dataset'] == 'tum_mono')"
# `ldso eval` says the same.
expect_exit 0 eval "$a/jobs/s01/random/forward_0/trajectory.txt" "$a/truth/tum_mono_s01.txt" --metric tum-mono
expect_output '^TUM-mono e_align +[0-9.]+ m'
expect_output '^TUM-mono e_s +[0-9.]+$'
if grep -q '^ATE' "$WORK/log"; then fail "more than one metric is printed"; fi
e_align=$(awk '/^TUM-mono e_align/ { print $3 }' "$WORK/log")
expect_true "both say the same" "abs($e_align - [r['e_align_m'] for r in $(results "$a" "") if r['id'] == 's01/random/forward_0'][0]) < 1e-5"
expect_exit 1 eval "$a/jobs/00/corners/forward_0/trajectory.txt" "$a/truth/kitti_00.txt" --metric tum-mono
expect_output '^error: metric tum-mono: the ground truth has no start and end segment'
expect_exit 1 eval "$a/jobs/s01/random/forward_0/trajectory.txt" "$a/truth/tum_mono_s01.txt" --metric kitti
expect_output '^error: metric kitti: the ground truth is of both ends only'

# Published figures beside a sequence of the right length.
make_experiment "$WORK/kitti" --dataset kitti --sequences 04 --poses 271 --variants corners --directions forward
expect_exit 0 experiment summarize "$WORK/kitti"
grep -q 'LDSO (published)' "$WORK/kitti/summary/tables/ate_kitti.md" || fail "published figures are missing"
grep -q '1.220' "$WORK/kitti/summary/tables/ate_kitti.tex" || fail "LDSO's published figure of KITTI 04 is missing"

# Options of the summary.
expect_exit 0 experiment summarize "$a" -o "$WORK/elsewhere" --log-axes --no-trajectories --quiet
[[ ! -s $WORK/log ]] || fail "--quiet has printed something"
grep -q logarithmic "$WORK/elsewhere/figures/curves_ate_euroc.svg" || fail "the axis is not logarithmic"
if compgen -G "$WORK/elsewhere/figures/trajectory_*" >/dev/null; then fail "trajectories were drawn"; fi
printf -- '- {system: X, source: here, dataset: euroc, figure: ate, unit: m, values: {MH_01: 0.5}}\n' >"$WORK/others.yaml"
expect_exit 0 experiment summarize "$a" -o "$WORK/elsewhere" --no-trajectories --published "$WORK/others.yaml"
grep -q 'X (published)' "$WORK/elsewhere/tables/ate_euroc.md" || fail "other published figures are not shown"
if command -v rsvg-convert >/dev/null; then
  expect_exit 0 experiment summarize "$a" -o "$WORK/png" --no-trajectories --png
  [[ -s $WORK/png/figures/blocks_ate_euroc.png ]] || fail "there is no PNG"
  grep -q 'blocks_ate_euroc.png' "$WORK/png/summary.md" || fail "summary.md does not show the PNG"
fi
mkdir "$WORK/bin"
PATH=$WORK/bin expect_exit 0 experiment summarize "$a" -o "$WORK/no_png" --no-trajectories --png
expect_output '^warning: no PNG files: rsvg-convert is not installed'

# Lost, crashed, damaged and pending runs: said, and the others go on.
b=$WORK/b
cp -r "$a" "$b"
rm "$b/jobs/MH_01/corners/forward_0/run.json"
echo '{"exit_code": 139, "signal": 11, "reason": ""}' >"$b/jobs/MH_01/corners/forward_0/failure.json"
truncate -s 200 "$b/jobs/MH_01/corners/forward_1/run.json"
rm "$b/jobs/MH_01/corners/backward_0/run.json"
python3 - "$b/jobs/MH_02/gradient/forward_0" <<'PY'
import json, sys
run = json.load(open(sys.argv[1] + "/run.json"))
run["untracked"] = [{"first": 70, "last": 119, "reason": "too few points"}]
json.dump(run, open(sys.argv[1] + "/run.json", "w"))
PY
expect_exit 0 experiment summarize "$b"
expect_output '^warning: .*forward_1/run.json: is damaged'
expect_output '64 finished, 2 failed, 2 pending'
grep -q '<small>([0-9]*/[0-9]* failed)</small>' "$b/summary/index.html" || fail "failed runs are not in the tables of the page"
grep -q 'killed by signal 11' "$b/summary/summary.md" || fail "the crash is not in the summary"
grep -q 'lost at frame 70 of 120: too few points' "$b/summary/summary.md" || fail "the lost run is not in the summary"
grep -q '>failed: 2<' "$b/summary/figures/blocks_ate_euroc.svg" || fail "failed runs are not in the figure"

# Comparison with itself, with runs that fail, and with larger errors; of folders and of files.
expect_exit 0 experiment compare "$a" "$a/summary/results.csv" --max-loss 0
expect_output '^overall +\+0\.00 %'
expect_exit 3 experiment compare "$a" "$b" --max-loss 50
expect_output '^LOSS +MH_01/corners/forward_0 fails now'
expect_output '^warning: 2 runs have a result in A alone: MH_01/corners/backward_0 MH_01/corners/forward_1'
expect_exit 0 experiment compare "$b" "$a" --max-loss 50
expect_output '^failed in A alone: MH_01/corners/forward_0 MH_02/gradient/forward_0'
expect_exit 0 experiment compare "$a" "$b"
make_experiment "$WORK/worse" --poses 120 --scale 1.2
expect_exit 3 experiment compare "$a/summary/results.json" "$WORK/worse" --max-loss 10
expect_output '^LOSS +overall \+(19|20|21)\.'
expect_exit 0 experiment compare "$a/summary/results.json" "$WORK/worse" --max-loss 25
expect_exit 3 experiment compare "$a/summary/results.csv" "$WORK/worse" --max-sequence-loss 10
expect_output '^LOSS +V1_01, random: \+(19|20|21)\.'
expect_exit 1 experiment compare "$WORK/neither" "$WORK/nowhere"
expect_output "neither, .*/nowhere: there is no such folder or file"
expect_exit 1 experiment compare "$a" "$WORK/nowhere"
expect_output '^error: .*nowhere: there is no such folder or file'
