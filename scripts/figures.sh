#!/usr/bin/env bash
# Makes the pictures of the documentation anew, in docs/pictures, by the program and the module themselves:
#
#   scripts/figures.sh [BUILD-FOLDER]     (build/release)
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:-build/release} pictures=docs/pictures
ldso=$build/ldso
[[ -x $ldso ]] || { echo "figures.sh: $ldso: there is no program" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# What the worlds look like: a frame from the middle of the way that was rendered.
for world in room window_room wall corridor street; do
  "$ldso" simulate "$world" -o "$work/$world" --size 320x240 --frames 121 >/dev/null
  cp "$(find "$work/$world/images" -type f | sort | sed -n 61p)" "$pictures/world_$world.png"
done

# A way round the room and over its start again: the estimate beside the truth, and a loop that was closed.
"$ldso" simulate room -o "$work/circuit" --size 320x240 --fps 15 --seed 1 >/dev/null
"$ldso" run "$work/circuit" -o "$work/out" --loop-pictures --no-report --quiet
cp "$work/out/trajectory.svg" "$pictures/trajectory.svg"
loop=$(python3 - "$work/out/loops.json" <<'PY'
import json, sys
loops = json.load(open(sys.argv[1]))["accepted"]
widest = max(loops, key=lambda loop: (loop["keyframe"] - loop["candidate"], loop["inliers"]))
print(f"{widest['keyframe']}_{widest['candidate']}.png")
PY
)
cp "$work/out/loops/$loop" "$pictures/loop.png"

PYTHONPATH=$build/python /usr/bin/python3 python/tutorial/tutorial.py "$pictures"
ls -l "$pictures"
