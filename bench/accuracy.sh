#!/usr/bin/env bash
# Accuracy of `ldso run` over many sequences: one line a run, then median and worst of each sequence.
#
# Results are deterministic, so repeating a run shows no spread. Instead each sequence is run from several first
# frames (and, reversed, from several last ones), which a robust system should not notice.
#
#   bench/accuracy.sh [options] [-- options for `ldso run`, e.g. --set selection.strategy=gradient]
#     -o DIR        results (default: a new folder under TMPDIR); DIR/runs.tsv, DIR/summary.txt, one folder a run
#     -n N          first frames 0..N-1 (default 5)
#     -d DIRECTIONS forward, reverse or both (default both)
#     -k PATTERN    only sequences whose name matches this regular expression
#     -x PROGRAM    the ldso program (default: build/release/ldso of this tree)
#
# Sequences: LDSO_DATA names a folder with 7scenes_kitchen and kitti/sequences/{00,05,06}; every folder in LDSO_SIM
# with a times.txt is a simulated one. Ground truth is what `ldso eval` finds in the sequence.
set -euo pipefail
export LC_ALL=C

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
ldso=$here/../build/release/ldso
out=
offsets=5
directions=both
pattern=.
while getopts "o:n:d:k:x:h" option; do
  case $option in
    o) out=$OPTARG ;;
    n) offsets=$OPTARG ;;
    d) directions=$OPTARG ;;
    k) pattern=$OPTARG ;;
    x) ldso=$OPTARG ;;
    *) sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 2 ;;
  esac
done
shift $((OPTIND - 1))
run_options=("$@")

fail() { echo "accuracy.sh: $*" >&2; exit 1; }
[[ -x $ldso ]] || fail "no program at $ldso; build the preset release or give -x"
[[ $offsets =~ ^[1-9][0-9]*$ ]] || fail "-n takes a positive number, not '$offsets'"
case $directions in
  both) directions="forward reverse" ;;
  forward | reverse) ;;
  *) fail "-d takes forward, reverse or both, not '$directions'" ;;
esac

source "$here/sequences.sh"
sequences=()
while IFS= read -r sequence; do
  if [[ ${sequence%%|*} =~ $pattern ]]; then sequences+=("$sequence"); fi
done < <(list_sequences)
((${#sequences[@]} > 0)) || fail "no sequences; set LDSO_DATA or LDSO_SIM, or check -k"

if [[ -z $out ]]; then out=$(mktemp -d "${TMPDIR:-/tmp}/ldso_accuracy.XXXXXX"); fi
mkdir -p "$out"
runs=$out/runs.tsv
columns="sequence direction offset frames poses first_tracked ate_m ate_percent scale_drift seconds frames_per_s"
tr ' ' '\t' <<<"$columns" >"$runs"

run_once() {  # name folder direction offset
  local name=$1 folder=$2 direction=$3 offset=$4
  local dir=$out/${name}_${direction}_$offset all frames
  local -a range=(--start "$offset")
  rm -rf "$dir"
  mkdir -p "$dir"
  frame_times "$folder" >"$dir/frame_times.txt"
  all=$(wc -l <"$dir/frame_times.txt")
  frames=$((all - offset))
  ((frames > 0)) || fail "$name has $all frames only, -n is too large"
  [[ $direction == reverse ]] && range=(--end "$frames" --reverse)

  local begin=$EPOCHREALTIME status=0
  "$ldso" run "$folder" -o "$dir" --no-loops "${range[@]}" "${run_options[@]}" >"$dir/run.log" 2>&1 || status=$?
  local end=$EPOCHREALTIME
  ((status == 0)) || echo "accuracy.sh: $dir: ldso run ended with $status, see run.log" >&2

  touch "$dir/trajectory.txt"
  "$ldso" eval "$dir/trajectory.txt" "$folder" --picture "$dir/trajectory.svg" --title "$name, $direction" \
    >"$dir/eval.txt" 2>&1 || true
  local poses first played
  poses=$(awk '!/^#/ && NF { n++ } END { print n + 0 }' "$dir/trajectory.txt")
  if [[ $direction == reverse ]]; then
    played=$(head -n "$frames" "$dir/frame_times.txt" | tac)
  else
    played=$(tail -n "$frames" "$dir/frame_times.txt")
  fi
  first=$(first_tracked "$dir/trajectory.txt" <<<"$played")
  awk -v OFS='\t' -v b="$begin" -v e="$end" -v n="$frames" \
    -v row="$name $direction $offset $frames $poses $first $(figure 'ATE [m]' "$dir/eval.txt") $(
      figure 'ATE of path' "$dir/eval.txt") $(figure 'scale drift' "$dir/eval.txt")" \
    'BEGIN { gsub(" ", OFS, row); s = e - b; printf "%s\t%.2f\t%.2f\n", row, s, n / s }' | tee -a "$runs"
}

# Median and worst of each sequence and direction; a failed run is worse than any other.
summarize() {
  awk -F'\t' "$awk_statistics"'
    NR > 1 {
      key = $1 "\t" $2
      if (!(key in count)) order[++keys] = key
      n = ++count[key]
      for (c = 4; c <= NF; c++) data[key, c, n] = value($c)
    }
    END {
      head = "%-20s %-8s %4s | %-19s | %-17s | %-15s | %-17s | %-11s | %8s %8s\n"
      printf head, "", "", "", "ATE [m]", "ATE of path [%]", "scale drift", "poses / frames", "first pose", "time", "frames"
      printf head, "sequence", "", "runs", "  median     worst", " median    worst", "median   worst", " median    worst", \
             "med.  worst", "[s]", "per s"
      for (k = 1; k <= keys; k++) {
        key = order[k]; split(key, name, "\t"); frames = largest(key, 4)
        printf "%-20s %-8s %4d |%9s %9s  |%8s %8s  |%7s %7s  |%5d %5d /%5d |%5s %6s |%9.1f %8.1f\n", name[1], name[2], \
          count[key], show(median(key, 7), "%.4f"), show(largest(key, 7), "%.4f"), \
          show(median(key, 8), "%.3f"), show(largest(key, 8), "%.3f"), \
          show(median(key, 9), "%.3f"), show(largest(key, 9), "%.3f"), \
          median(key, 5), smallest(key, 5), frames, \
          show(median(key, 6), "%d"), show(largest(key, 6), "%d"), median(key, 10), median(key, 11)
      }
    }' "$runs"
}

head -n 1 "$runs"
for sequence in "${sequences[@]}"; do
  for direction in $directions; do
    for ((offset = 0; offset < offsets; offset++)); do
      run_once "${sequence%%|*}" "${sequence#*|}" "$direction" "$offset"
    done
  done
done
echo
summarize | tee "$out/summary.txt"
echo
echo "results in $out"
