#!/usr/bin/env bash
# From nothing to a first trajectory: installs what is missing, builds, renders the built-in sequence, runs ldso on
# it, compares the result with the truth and says where the pictures are.
#
#   scripts/demo.sh [--world room|window_room|wall|corridor|street|eight] [--frames N] [--seed N] [--fresh]
#     --frames N  only the first N frames
#     --fresh     render the sequence again even if it is there
# Results: out/demo/ (LDSO_DEMO_OUT changes that).
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/build_tools.sh

fail() { echo "demo.sh: $*" >&2; exit 1; }
usage() { sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit "$1"; }
world=room
fresh=0
options=()
while (($# > 0)); do
  case $1 in
    --world) world=${2:?--world takes a name}; shift 2 ;;
    --frames) options+=(--frames "${2:?--frames takes a number}"); shift 2 ;;
    --seed) options+=(--seed "${2:?--seed takes a number}"); shift 2 ;;
    --fresh) fresh=1; shift ;;
    -h | --help) usage 0 ;;
    *) echo "demo.sh: unknown option $1" >&2; usage 2 >&2 ;;
  esac
done

step() { printf '\n== %s\n' "$*"; }
ldso=build/release/ldso
out=${LDSO_DEMO_OUT:-out/demo}
sequence=$out/sequence
result=$out/result

step "Installing what is missing"
scripts/install_packages.sh build python
install_node

step "Building $ldso"
configure release
build release --target ldso_app

step "Rendering the built-in sequence ($world)"
# world.yaml is written last: with it the sequence is complete. recipe.txt says what was asked for.
recipe="$world ${options[*]}"
if ((fresh)) || [[ ! -f $sequence/world.yaml || $ldso -nt $sequence/world.yaml ]] ||
  [[ $(cat "$out/recipe.txt" 2>/dev/null) != "$recipe" ]]; then
  rm -rf "$sequence"
  mkdir -p "$out"
  "$ldso" simulate "$world" -o "$sequence" "${options[@]}"
  echo "$recipe" >"$out/recipe.txt"
else
  echo "$sequence is there already (--fresh renders it again)"
fi

step "Running"
"$ldso" run "$sequence" -o "$result"

step "Comparing with the truth"
"$ldso" eval "$result/trajectory.txt" "$sequence" --picture "$result/trajectory.svg" --title "$world" |
  tee "$result/eval.txt"

# figure NAME: the first number of the line that begins with NAME.
figure() { awk -v n="$1" 'index($0, n) == 1 { split(substr($0, length(n) + 1), f, " "); print f[1]; exit }' "$result/eval.txt"; }
entry() { sed -n "s/^ *\"$1\": \([-0-9.e+]*\),\{0,1\}$/\1/p" "$result/run.json" | sed -n 1p; }
ate=$(figure "ATE [m]")
percent=$(figure "ATE of path")
[[ -n $ate && -n $percent ]] || fail "the comparison has no ATE; see $result/eval.txt"

step "Done"
printf 'ATE                 %s m, %s %% of the path\n' "$ate" "$percent"
printf 'speed               %.1f frames/s (%s of %s frames have a pose)\n' "$(entry frames_per_s)" \
  "$(entry frames_with_pose)" "$(awk 'NF' "$sequence/times.txt" | wc -l)"
printf 'trajectory picture  %s\n' "$(realpath "$result/trajectory.svg")"
printf 'point cloud         %s\n' "$(realpath "$result/map.ply")"
