#!/usr/bin/env bash
# own_files_test.sh PROGRAM SEQUENCE WORK: commands overwrite and remove files of ldso alone. Whatever else lies where
# their results go stays, and the message says what is in the way.
LDSO=$1 SEQUENCE=$2 WORK=$3/own_files
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

# expect_kept FILE...: they say "mine" as they did.
expect_kept() {
  local file
  for file in "$@"; do
    [[ $(cat "$file" 2>/dev/null) == mine ]] || fail "$file has been touched"
  done
}
# tree FOLDER: all its files with their content.
tree() { (cd "$1" && find . -type f -exec sha256sum {} + | sort); }
run() { expect_exit "$1" run "$SEQUENCE" --end 20 --quiet --no-report "${@:2}"; }

# The folder of the sequence, by whatever name, and what belongs to it.
copy_sequence "$SEQUENCE" "$WORK/sequence"
tree "$WORK/sequence" >"$WORK/before"
ln -s sequence "$WORK/link"
for out in "$WORK/sequence" "$WORK/sequence/" "$WORK/link" "$WORK/sequence/images/.."; do
  expect_exit 1 run "$WORK/sequence" -o "$out" --quiet
  expect_output 'is the folder of the sequence itself'
done
(cd "$WORK/sequence" && expect_exit 1 run . -o . --quiet)
expect_output 'is the folder of the sequence itself; give a folder of its own'
expect_exit 1 run "$WORK/sequence" -o "$WORK/sequence/images" --quiet
expect_output 'is a part of the sequence'
expect_exit 1 run "$WORK/sequence" -o "$WORK/sequence" --job --quiet
tree "$WORK/sequence" | diff "$WORK/before" - || fail "the sequence has been touched"
# A folder that is made inside is none of its parts, also the second time.
expect_exit 0 run "$WORK/sequence" -o "$WORK/sequence/out" --end 20 --quiet
expect_exit 0 run "$WORK/sequence" -o "$WORK/sequence/out" --end 20 --quiet

# Results that would take the name of somebody's file, and files that have other names.
for name in camera.txt map.ply log.txt; do
  mkdir "$WORK/$name.out"
  echo mine | tee "$WORK/$name.out/$name" >"$WORK/$name.out/notes.txt"
  run 1 -o "$WORK/$name.out" --job
  expect_kept "$WORK/$name.out"/{$name,notes.txt}
done
run 1 -o "$WORK/camera.txt.out"
expect_output '^error: .*camera\.txt: is in the way: it was not written by ldso.*give another folder'
mkdir -p "$WORK/mixed/loops"
echo mine | tee "$WORK/mixed/notes.txt" >"$WORK/mixed/settings.yaml"
run 0 -o "$WORK/mixed"
run 0 -o "$WORK/mixed"
expect_kept "$WORK/mixed"/{notes.txt,settings.yaml}

# What ldso wrote is replaced, also by versions that kept no list: those left a run.json.
rm "$WORK/mixed/.ldso_files"
run 0 -o "$WORK/mixed" --no-loops
[[ ! -e $WORK/mixed/map_odometry.ply ]] || fail "a file of an earlier version was left"
rm "$WORK/mixed/.ldso_files"
echo mine >"$WORK/mixed/camera.txt"  # That run had corrected nothing.
run 1 -o "$WORK/mixed"
expect_kept "$WORK/mixed/camera.txt"
rm "$WORK/mixed"/{camera.txt,run.json} "$WORK/mixed/.ldso_files"
run 1 -o "$WORK/mixed"
expect_output 'is in the way'

# An input of the run.
run 0 -o "$WORK/calibrated"
cp "$SEQUENCE/camera.txt" "$WORK/calibrated/"
run 1 -o "$WORK/calibrated" --calib "$WORK/calibrated/camera.txt"
expect_output 'camera\.txt: is read by this run'
cmp "$SEQUENCE/camera.txt" "$WORK/calibrated/camera.txt"
rm "$WORK/calibrated/camera.txt"

# Exports.
mkdir -p "$WORK/exports/colmap"
echo mine | tee "$WORK/exports/map.ply" >"$WORK/exports/colmap/cameras.txt"
for format in ply colmap; do
  expect_exit 1 export "$WORK/calibrated" --format $format --images none -o "$WORK/exports"
  expect_output 'is in the way'
done
expect_exit 0 export "$WORK/calibrated" --format tum,pcd -o "$WORK/exports"
expect_exit 0 export "$WORK/calibrated" --format tum,pcd -o "$WORK/exports"
expect_kept "$WORK/exports"/{map.ply,colmap/cameras.txt}
expect_exit 0 export "$WORK/calibrated" --format ply
rm "$WORK/calibrated/export/.ldso_files"
expect_exit 0 export "$WORK/calibrated" --format ply

# Rendered sequences; a folder of numbered images is not one.
mkdir -p "$WORK/photos/images" "$WORK/kitti/sequences/07" "$WORK/kitti/poses"
echo mine | tee "$WORK/photos/images/00001.png" "$WORK/kitti/poses/07.txt" >"$WORK/photos/notes.txt"
simulate() { expect_exit "$1" simulate room --frames 2 --size 64x48 "${@:2}"; }
simulate 1 -o "$WORK/photos"
expect_output 'images/: is in the way'
simulate 1 --layout kitti --lens pinhole -o "$WORK/kitti/sequences/07"
expect_output 'poses/07\.txt: is in the way'
expect_kept "$WORK/photos"/{images/00001.png,notes.txt} "$WORK/kitti/poses/07.txt"
simulate 0 --depth -o "$WORK/rendered"
rm "$WORK/rendered/.ldso_files"  # As an earlier version left it.
simulate 0 -o "$WORK/rendered"
[[ ! -e $WORK/rendered/depth && -e $WORK/rendered/images/00001.png ]] || fail "depth maps of before were left"

# Single files that are named.
expect_exit 1 eval "$WORK/calibrated/trajectory.txt" "$SEQUENCE" --picture "$WORK/photos/images/00001.png"
expect_output 'is there already and is not an SVG picture'
expect_exit 1 eval "$WORK/calibrated/trajectory.txt" "$SEQUENCE" --json "$WORK/photos/notes.txt"
for _ in once again; do
  expect_exit 0 eval "$WORK/calibrated/trajectory.txt" "$SEQUENCE" --json "$WORK/e.json" --picture "$WORK/e.svg"
done
expect_exit 1 vocab train "$SEQUENCE" -o "$WORK/photos/images/00001.png"
expect_output 'is there already and is not a vocabulary of ldso'

# Experiments and their summaries.
mkdir "$WORK/experiment" "$WORK/summary"
echo mine | tee "$WORK/experiment/experiment.json" >"$WORK/summary/index.html"
printf 'sequences: [{path: %s}]\n' "$SEQUENCE" >"$WORK/plan.yaml"
expect_exit 1 experiment run "$WORK/plan.yaml" -o "$WORK/experiment" --quiet
python3 "$(dirname "${BASH_SOURCE[0]}")/make_experiment.py" "$WORK/made" --poses 40 >/dev/null
expect_exit 1 experiment summarize "$WORK/made" -o "$WORK/summary" --no-trajectories
expect_output 'index\.html: is in the way'
expect_kept "$WORK/experiment/experiment.json" "$WORK/summary/index.html" "$WORK/photos"/{images/00001.png,notes.txt}
expect_exit 0 experiment summarize "$WORK/made" --no-trajectories
rm "$WORK/made/summary/.ldso_files"
expect_exit 0 experiment summarize "$WORK/made" --no-trajectories
