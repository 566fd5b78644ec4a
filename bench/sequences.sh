# To be sourced: the sequences that measurements run over, and how figures are read from results.

# One "name|folder" a line: of LDSO_DATA 7scenes_kitchen and kitti/sequences/{00,05,06}, of LDSO_SIM every folder with a
# times.txt.
list_sequences() {
  local number folder times
  if [[ -n ${LDSO_DATA:-} ]]; then
    if [[ -d $LDSO_DATA/7scenes_kitchen ]]; then echo "7scenes_kitchen|$LDSO_DATA/7scenes_kitchen"; fi
    for number in 00 05 06; do
      folder=$LDSO_DATA/kitti/sequences/$number
      if [[ -d $folder ]]; then echo "kitti_$number|$folder"; fi
    done
  fi
  if [[ -n ${LDSO_SIM:-} ]]; then
    for times in "$LDSO_SIM"/*/times.txt; do
      [[ -f $times ]] || continue
      folder=$(dirname "$times")
      echo "$(basename "$folder")|$folder"
    done
  fi
}

# Times of the frames in their order in the sequence; TUM-mono has "id time exposure", KITTI the time alone.
frame_times() { awk '!/^#/ && NF { print (NF == 1 ? $1 : $2) }' "$1/times.txt"; }

# What a short run over this folder is compared with: the scale of a few steps needs a truth that is surer than the depth
# camera's of the kitchen, whose error is as large as the steps; the one by structure from motion lies beside it.
sure_truth() { if [[ -f $1/groundtruth_sfm.txt ]]; then echo "$1/groundtruth_sfm.txt"; else echo "$1"; fi; }

# figure NAME FILE: the first number of the line of `ldso eval` that begins with NAME, or "fail".
figure() {
  awk -v name="$1" 'index($0, name) == 1 { split(substr($0, length(name) + 1), f, " "); print f[1]; found = 1; exit }
                    END { if (!found) print "fail" }' "$2"
}

# Position of the first pose among the frames that were to be processed (standard input, in playing order).
first_tracked() {
  awk 'FILENAME == ARGV[1] { if (!/^#/ && NF && !seen) { first = $1; seen = 1 } next }
       { d = $1 - first; if (d < 0) d = -d; if (FNR == 1 || d < best) { best = d; at = FNR - 1 } }
       END { print seen ? at : "fail" }' "$1" -
}

# Functions for awk programs that summarize runs: data[key, column, i] are the values of count[key] runs, from value(text);
# a failed run is worse than any other.
awk_statistics='
  function value(text) { return text == "fail" ? 1e99 : text + 0 }
  function show(x, format) { return x >= 1e98 ? "fail" : sprintf(format, x) }
  function sort_values(key, c, n,   i, j, t) {
    for (i = 1; i <= n; i++) v[i] = data[key, c, i]
    for (i = 2; i <= n; i++) for (j = i; j > 1 && v[j - 1] > v[j]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
  }
  function median(key, c,   n) {
    n = count[key]; sort_values(key, c, n)
    return n % 2 ? v[(n + 1) / 2] : (v[n / 2] + v[n / 2 + 1]) / 2
  }
  function largest(key, c) { sort_values(key, c, count[key]); return v[count[key]] }
  function smallest(key, c) { sort_values(key, c, count[key]); return v[1] }
'
