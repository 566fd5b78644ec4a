#!/usr/bin/env bash
# What loop closing is worth: `ldso run` over many sequences, also made to drift, one line a run.
#
#   bench/loops.sh [options] [-- options for `ldso run`]
#     -o DIR        results (default: a new folder under TMPDIR); DIR/loops.tsv, DIR/summary.txt, one folder a run
#     -k PATTERN    only runs whose name, SEQUENCE/VARIANT, matches this regular expression
#     -x PROGRAM    the ldso program (default: build/release/ldso of this tree)
#     -t PROGRAM    loop_truth (default: build/bench/bench/loop_truth of this tree)
#     -j N          runs at once (default 1)
#
# Variants: nominal; nophoto (response, vignette and exposure times withheld); focal (focal lengths 1.5 % too long);
# reverse. Sequences: LDSO_DATA names a folder with 7scenes_kitchen and kitti/sequences/{00,05,06}; every folder in
# LDSO_SIM with a times.txt is a simulated one. ATE: before and after loop closing, after Sim(3) alignment, of all
# frames. Exit code 1 if a closed loop is wrong or a run failed.
set -euo pipefail
export LC_ALL=C

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
ldso=$here/../build/release/ldso
truth=$here/../build/bench/bench/loop_truth
out=
pattern=.
jobs=1
while getopts "o:k:x:t:j:h" option; do
  case $option in
    o) out=$OPTARG ;;
    k) pattern=$OPTARG ;;
    x) ldso=$OPTARG ;;
    t) truth=$OPTARG ;;
    j) jobs=$OPTARG ;;
    *) sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 2 ;;
  esac
done
shift $((OPTIND - 1))
run_options=("$@")

fail() { echo "loops.sh: $*" >&2; exit 1; }
[[ -x $ldso ]] || fail "no program at $ldso; build the preset release or give -x"
[[ -x $truth ]] || fail "no program at $truth; build the preset bench or give -t"
[[ $jobs =~ ^[1-9][0-9]*$ ]] || fail "-j takes a positive number, not '$jobs'"

source "$here/sequences.sh"
mapfile -t sequences < <(list_sequences)
((${#sequences[@]} > 0)) || fail "no sequences; set LDSO_DATA or LDSO_SIM"

if [[ -z $out ]]; then out=$(mktemp -d "${TMPDIR:-/tmp}/ldso_loops.XXXXXX"); fi
mkdir -p "$out"

# json FILE EXPRESSION: a figure of a JSON file, or "fail".
json() { python3 -c "import json, sys; print(json.load(open(sys.argv[1]))$2)" "$1" 2>/dev/null || echo fail; }

# figure NAME FILE: the first number of the line of loop_truth that begins with NAME, or "fail".
figure() {
  awk -v name="$1" 'index($0, name) == 1 { split(substr($0, length(name) + 1), f, " "); print f[1] + 0; found = 1; exit }
                    END { if (!found) print "fail" }' "$2"
}

# The camera with longer focal lengths. camera.txt gives them in pixels, or as shares of the image's size.
longer_focal_lengths() {
  awk 'NR == 1 { at = $1 ~ /^[A-Za-z]/ ? 2 : 1; $at *= 1.015; $(at + 1) *= 1.015 } { print }' "$1"
}

run_once() {  # name folder variant
  local name=$1 folder=$2 variant=$3 dir
  dir=$out/${name}_$variant
  local -a options=()
  rm -rf "$dir"
  mkdir -p "$dir"
  case $variant in
    nophoto) options=(--set photometry.use_response=false --set photometry.use_vignette=false
                      --set photometry.use_exposure=false) ;;
    focal)
      longer_focal_lengths "$folder/camera.txt" >"$dir/camera.txt"
      options=(--calib "$dir/camera.txt")
      ;;
    reverse) options=(--reverse) ;;
  esac
  local begin=$EPOCHREALTIME end
  "$ldso" run "$folder" -o "$dir" "${options[@]}" "${run_options[@]}" >"$dir/run.log" 2>&1 ||
    echo "loops.sh: $dir: ldso run failed, see run.log" >&2
  end=$EPOCHREALTIME
  touch "$dir/loop_truth.txt"
  if [[ -e $dir/loops.json ]]; then "$truth" "$folder" "$dir" >"$dir/loop_truth.txt" 2>&1 || true; fi
  local after before
  after=$(json "$dir/run.json" "['evaluation']['ate_m']['rmse']")
  before=$(json "$dir/run.json" "['evaluation_odometry']['ate_m']['rmse']")
  [[ $before != fail ]] || before=$after  # Without loops there is nothing to correct.
  awk -v OFS='\t' -v name="$name" -v variant="$variant" -v before="$before" -v after="$after" -v b="$begin" -v e="$end" \
    -v path="$(json "$dir/run.json" "['evaluation']['path_length_m']")" \
    -v loops="$(figure loops "$dir/loop_truth.txt")" -v wrong="$(figure wrong "$dir/loop_truth.txt")" \
    -v off="$(figure 'translation error   median' "$dir/loop_truth.txt")" \
    'BEGIN { failed = after == "fail"; percent = failed || path + 0 <= 0 ? "fail" : sprintf("%.4f", 100 * before / path)
             ratio = failed || before + 0 <= 0 ? "fail" : sprintf("%.3f", after / before)
             print name, variant, before, after, percent, ratio, loops, wrong, off, sprintf("%.1f", e - b) }' >"$dir/row.tsv"
  awk -F'\t' '{ printf "%-20s %-8s %10.6s %10.6s %10s %8s %6s %6s %10s %8s\n", $1, $2, $3, $4, $5, $6, $7, $8, $9, $10 }' \
    "$dir/row.tsv"
}

runs=()
for sequence in "${sequences[@]}"; do
  IFS='|' read -r name folder <<<"$sequence"
  for variant in nominal nophoto focal reverse; do
    [[ $variant == focal && ! -e $folder/camera.txt ]] && continue
    [[ $name/$variant =~ $pattern ]] && runs+=("$name|$folder|$variant")
  done
done
((${#runs[@]} > 0)) || fail "no run matches -k $pattern"

printf '%-20s %-8s %10s %10s %10s %8s %6s %6s %10s %8s\n' sequence variant 'ATE before' 'after [m]' 'before [%]' ratio \
  loops wrong 'off by [m]' 'time [s]'
for run in "${runs[@]}"; do
  while (($(jobs -rp | wc -l) >= jobs)); do wait -n || true; done
  IFS='|' read -r name folder variant <<<"$run"
  run_once "$name" "$folder" "$variant" &
done
wait

tr ' ' '\t' <<<"sequence variant ate_before_m ate_after_m before_percent ratio loops wrong off_m seconds" >"$out/loops.tsv"
for run in "${runs[@]}"; do cat "$out/${run%%|*}_${run##*|}/row.tsv" >>"$out/loops.tsv"; done
echo
awk -F'\t' '
  NR == 1 { next }
  $6 == "fail" { failed++; next }
  $8 == "fail" { unchecked++ }
  { n++; loops += $7; wrong += $8; without += $7 == 0
    if (worst == "" || $6 > worst) { worst = $6; at = $1 "/" $2 }
    if ($6 > 1.05) worse++
    if ($5 > 0.1) { drifted++; if (least == "" || $6 > least) { least = $6; least_at = $1 "/" $2 } if ($6 > 0.25) little++ } }
  END {
    printf "%d runs, %d failed, %d without a loop\n", n + failed, failed, without
    printf "loops                    %d, wrong %d%s\n", loops, wrong, unchecked ? ", " unchecked " runs not checked" : ""
    if (n) printf "worst ratio              %.3f (%s); above 1.05: %d\n", worst, at, worse
    if (drifted) printf "ATE before above 0.1 %%   %d runs; worst ratio %.3f (%s); above 0.25: %d\n", drifted, least, least_at, little
    exit failed || wrong || unchecked
  }' "$out/loops.tsv" | tee "$out/summary.txt"
echo "results in $out"
