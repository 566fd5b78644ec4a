#!/usr/bin/env bash
# colmap_test.sh PROGRAM SEQUENCE WORK: COLMAP itself opens what `ldso export --format colmap` writes. Exit code 77: there
# is no COLMAP.
LDSO=$1 SEQUENCE=$2 WORK=$3/colmap
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
if ! command -v colmap >/dev/null; then
  echo "skipped: there is no COLMAP (package colmap)"
  exit 77
fi
export QT_QPA_PLATFORM=offscreen
rm -rf "$WORK" && mkdir -p "$WORK"
expect_exit 0 run "$SEQUENCE" -o "$WORK/out" --quiet --end 40
keyframes=$(poses "$WORK/out/keyframes.txt")
for images in rectified original; do
  expect_exit 0 export "$WORK/out" --format colmap --images "$images" -o "$WORK/$images"
  model=$WORK/$images/colmap/sparse/0
  colmap model_analyzer --path "$model" >"$WORK/log" 2>&1 || fail "COLMAP does not open the model"
  expect_output "^Cameras: 1$"
  expect_output "^Images: $keyframes$"
  expect_output "^Registered images: $keyframes$"
  expect_output "^Points: $(grep -vc '^#' "$model/points3D.txt")$"
  mkdir "$WORK/$images/binary"
  colmap model_converter --input_path "$model" --output_path "$WORK/$images/binary" --output_type BIN >"$WORK/log" 2>&1 ||
    fail "COLMAP does not convert the model"
  [[ -s $WORK/$images/binary/points3D.bin ]] || fail "COLMAP wrote no points"
done
