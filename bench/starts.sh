#!/usr/bin/env bash
# Starts of `ldso run`: short runs from many first frames, and how many of them go wrong.
#
# A start is judged by what follows it: if the scale of the last third of a run differs from that of its first third by
# more than a limit, its start was bad and did not heal. Nothing of that shows in the residuals, and one long run has
# one start only.
#
#   bench/starts.sh [options] [-- options for `ldso run`, e.g. --set initializer.good_parallax_angle=4]
#     -o DIR        results (default: a new folder under TMPDIR); DIR/runs.tsv, DIR/summary.txt, one folder a run
#     -l N          frames of a run (default 150)
#     -e N          from every N-th first frame (default 50)
#     -c LIMIT      largest change of scale of a sound start, as a factor (default 1.2)
#     -s FOLDER     a sequence to run on; may be repeated (default: those of LDSO_DATA and LDSO_SIM, see accuracy.sh)
#     -k PATTERN    only sequences whose name matches this regular expression
#     -x PROGRAM    the ldso program (default: build/release/ldso of this tree)
#
# Verdicts: good; scale (changed, and nothing was said); said (changed, but frames were lost or a new map was started,
# so the user knows); few (too few poses to tell: less than half of the frames).
set -euo pipefail
export LC_ALL=C

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
ldso=$here/../build/release/ldso
out=
length=150
every=50
limit=1.2
pattern=.
folders=()
while getopts "o:l:e:c:s:k:x:h" option; do
  case $option in
    o) out=$OPTARG ;;
    l) length=$OPTARG ;;
    e) every=$OPTARG ;;
    c) limit=$OPTARG ;;
    s) folders+=("$OPTARG") ;;
    k) pattern=$OPTARG ;;
    x) ldso=$OPTARG ;;
    *) sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 2 ;;
  esac
done
shift $((OPTIND - 1))
run_options=("$@")

fail() { echo "starts.sh: $*" >&2; exit 1; }
[[ -x $ldso ]] || fail "no program at $ldso; build the preset release or give -x"
for number in "$length" "$every"; do
  [[ $number =~ ^[1-9][0-9]*$ ]] || fail "-l and -e take a positive number, not '$number'"
done

source "$here/sequences.sh"
sequences=()
list() {
  local folder
  if ((${#folders[@]} == 0)); then list_sequences; fi
  for folder in "${folders[@]}"; do echo "$(basename "$folder")|$folder"; done
}
while IFS= read -r sequence; do
  if [[ ${sequence%%|*} =~ $pattern ]]; then sequences+=("$sequence"); fi
done < <(list)
((${#sequences[@]} > 0)) || fail "no sequences; give -s, set LDSO_DATA or LDSO_SIM, or check -k"

if [[ -z $out ]]; then out=$(mktemp -d "${TMPDIR:-/tmp}/ldso_starts.XXXXXX"); fi
mkdir -p "$out"
runs=$out/runs.tsv
tr ' ' '\t' <<<"sequence start frames poses first_tracked ate_m ate_percent scale_drift verdict" >"$runs"

run_once() {  # name folder start frames
  local name=$1 folder=$2 start=$3 frames=$4
  local dir=$out/${name}_$start status=0 poses first said
  rm -rf "$dir"
  mkdir -p "$dir"
  "$ldso" run "$folder" -o "$dir" --no-loops --no-report --start "$start" --end $((start + frames)) \
    "${run_options[@]}" >"$dir/run.log" 2>&1 || status=$?
  ((status == 0)) || echo "starts.sh: $dir: ldso run ended with $status, see run.log" >&2
  touch "$dir/trajectory.txt"
  "$ldso" eval "$dir/trajectory.txt" "$(sure_truth "$folder")" >"$dir/eval.txt" 2>&1 || true
  poses=$(awk '!/^#/ && NF { n++ } END { print n + 0 }' "$dir/trajectory.txt")
  first=$(first_tracked "$dir/trajectory.txt" < <(frame_times "$folder" | tail -n +$((start + 1)) | head -n "$frames"))
  said=$(grep -c '^warning:' "$dir/run.log" || true)
  awk -v OFS='\t' -v said="$said" -v limit="$limit" \
    -v row="$name $start $frames $poses $first $(figure 'ATE [m]' "$dir/eval.txt") $(
      figure 'ATE of path' "$dir/eval.txt") $(figure 'scale drift' "$dir/eval.txt")" \
    'BEGIN { gsub(" ", OFS, row); split(row, f, OFS)
             verdict = 2 * f[4] < f[3] || f[8] == "fail" ? "few" : f[8] <= limit ? "good" : said > 0 ? "said" : "scale"
             print row, verdict }' | tee -a "$runs"
}

# Of each sequence: how many starts went wrong, and how well the others did.
summarize() {
  awk -F'\t' "$awk_statistics"'
    NR > 1 {
      if (!($1 in count)) order[++keys] = $1
      n = ++count[$1]
      for (c = 5; c <= 8; c++) data[$1, c, n] = value($c)
      ++verdicts[$1, $9]
    }
    END {
      head = "%-20s %6s | %5s %5s %5s %5s | %-19s | %-17s | %-15s | %s\n"
      printf head, "", "", "", "", "", "", "ATE [m]", "ATE of path [%]", "scale drift", "first pose"
      printf head, "sequence", "starts", "good", "scale", "said", "few", "  median     worst", " median    worst", \
             "median   worst", "med.  worst"
      for (k = 1; k <= keys; k++) {
        key = order[k]
        printf "%-20s %6d | %5d %5d %5d %5d |%9s %9s  |%8s %8s  |%7s %7s  |%5s %6s\n", key, count[key], \
          verdicts[key, "good"], verdicts[key, "scale"], verdicts[key, "said"], verdicts[key, "few"], \
          show(median(key, 6), "%.4f"), show(largest(key, 6), "%.4f"), \
          show(median(key, 7), "%.3f"), show(largest(key, 7), "%.3f"), \
          show(median(key, 8), "%.3f"), show(largest(key, 8), "%.3f"), \
          show(median(key, 5), "%d"), show(largest(key, 5), "%d")
      }
    }' "$runs"
}

head -n 1 "$runs"
for sequence in "${sequences[@]}"; do
  folder=${sequence#*|}
  all=$(frame_times "$folder" | wc -l)
  # The last run has at least two thirds of the frames of the others; a sequence that is shorter is run whole.
  for ((start = 0; start == 0 || 3 * (all - start) >= 2 * length; start += every)); do
    run_once "${sequence%%|*}" "$folder" "$start" $((all - start < length ? all - start : length))
  done
done
echo
summarize | tee "$out/summary.txt"
echo
echo "results in $out"
