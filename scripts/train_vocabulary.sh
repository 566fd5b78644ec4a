#!/usr/bin/env bash
# train_vocabulary.sh: makes data/vocabulary.ldsovoc, the vocabulary that is built into the library, from renderings of
# `ldso simulate` alone.
#
#   scripts/train_vocabulary.sh [-w WORK] [-o FILE] [-x PROGRAM] [-t THREADS] [-r]
#     -w WORK     where the renderings go; those that are there already are used again (default: out/vocabulary)
#     -o FILE     the vocabulary (default: data/vocabulary.ldsovoc)
#     -x PROGRAM  the ldso program (default: build/release/ldso)
#     -r          render only
# The same program makes the same file, for any number of threads. A quarter of an hour of rendering on two cores,
# training takes a few minutes.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."

work=out/vocabulary
file=data/vocabulary.ldsovoc
ldso=build/release/ldso
threads=2
render_only=0
while getopts "w:o:x:t:rh" option; do
  case $option in
    w) work=$OPTARG ;;
    o) file=$OPTARG ;;
    x) ldso=$OPTARG ;;
    t) threads=$OPTARG ;;
    r) render_only=1 ;;
    *) sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 2 ;;
  esac
done
[[ -x $ldso ]] || { echo "train_vocabulary.sh: no program at $ldso; build the preset release or give -x" >&2; exit 1; }

sequences=()
# render WORLD FPS SEED: far fewer frames than a camera takes: training needs many places, not many views of one. Cameras
# of all kinds: blurred, noisy, with and without photometric calibration, of several sizes.
render() {
  local folder=$work/$1_$3
  local options=()
  sequences+=("$folder")
  [[ -f $folder/world.yaml ]] && return  # it is written last
  case $(($3 % 5)) in
    0) options+=(--motion-blur) ;;
    1) options+=(--no-calibration --hide-exposure) ;;
    2) options+=(--noise 2) ;;
    3) options+=(--no-calibration --hide-exposure --motion-blur --exposure 12) ;;
    4) ;;
  esac
  if [[ $1 == street ]]; then
    (($3 % 3)) || options+=(--size 800x320)
  else
    (($3 % 3)) || options+=(--lens pinhole --size 752x480)
  fi
  rm -rf "$folder"
  "$ldso" simulate "$1" -o "$folder" --seed "$3" --fps "$2" --threads "$threads" "${options[@]}"
}

# In turns, so that an interrupted rendering is a fair sample too. Tests and experiments use lower seeds.
for ((seed = 1001; seed <= 1060; ++seed)); do
  render room 1.5 "$seed"
  if ((seed <= 1020)); then
    render corridor 1 "$seed"
    render street 1 "$seed"
  fi
done
((render_only)) && exit 0

"$ldso" vocab train "${sequences[@]}" -o "$file" --branching 10 --depth 5 --seed 1 --threads "$threads"
"$ldso" vocab info "$file"
