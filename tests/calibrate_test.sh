#!/usr/bin/env bash
# calibrate_test.sh PROGRAM SEQUENCE WORK: `ldso calibrate` as it is called: boards to print, a calibration from rendered
# images, what is refused, and that no file of the user is touched.
LDSO=$1 SEQUENCE=$2 WORK=$3/calibrate
rm -rf "$WORK" && mkdir -p "$WORK/images"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

# Boards.
expect_exit 0 calibrate board chessboard:5x4:0.03 -o "$WORK/board.svg"
expect_output 'chessboard:5x4:0\.03$'
python3 -c "import sys, xml.dom.minidom as d; d.parse(sys.argv[1])" "$WORK/board.svg" || fail "board.svg is no XML"
expect_exit 0 calibrate board aprilgrid:4x4 --paper a3 -o "$WORK/board.pdf"
[[ $(head -c 5 "$WORK/board.pdf") == %PDF- ]] || fail "board.pdf is no PDF"
expect_exit 1 calibrate board chessboard:9x6:0.1 -o "$WORK/large.pdf"
expect_output 'does not fit on paper'
expect_exit 1 calibrate board chessboard:9x6 -o "$WORK/board.png"
echo mine >"$WORK/mine.pdf"
expect_exit 1 calibrate board chessboard:9x6 -o "$WORK/mine.pdf"
[[ $(cat "$WORK/mine.pdf") == mine ]] || fail "a file of somebody else was overwritten"

# Images of a board by a camera of 300 px focal length.
python3 - "$WORK/images" <<'PY'
import math, sys
W, H, F, SQUARE = 320, 240, 300.0, 0.03
def level(x, y):
    if not (-0.5 <= x < 6.5 and -0.5 <= y < 5.5):
        return 120
    inside = 0 <= x < 6 and 0 <= y < 5
    return 30 if inside and (math.floor(x) + math.floor(y)) % 2 == 0 else 220
views = [(0, 0, .24, 0, 0), (.4, 0, .25, .04, .01), (-.4, .1, .26, -.04, -.02), (0, .45, .25, .03, .03),
         (.1, -.45, .26, -.03, .03), (.3, .3, .3, .05, -.03), (-.3, -.3, .3, -.06, -.03), (-.35, .3, .22, 0, 0)]
for number, (a, b, z, tx, ty) in enumerate(views):
    ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
    r1, r2, n = (cb, sa * sb, -ca * sb), (0, ca, sa), (sb, -sa * cb, ca * cb)
    distance = n[0] * tx + n[1] * ty + n[2] * z
    rows = bytearray()
    for v in range(H):
        for u in range(W):
            total = 0
            for k in range(4):
                ray = ((u - .25 + .5 * (k % 2) - 159.5) / F, (v - .25 + .5 * (k // 2) - 119.5) / F, 1.0)
                s = distance / (n[0] * ray[0] + n[1] * ray[1] + n[2])
                p = (s * ray[0] - tx, s * ray[1] - ty, s - z)
                x = (r1[0] * p[0] + r1[1] * p[1] + r1[2] * p[2]) / SQUARE + 3
                y = (r2[1] * p[1] + r2[2] * p[2]) / SQUARE + 2.5
                total += level(x, y)
            rows.append(total // 4)
    open(f"{sys.argv[1]}/{number:03}.pgm", "wb").write(b"P5\n%d %d\n255\n" % (W, H) + rows)
PY
echo 'what calibrates another camera' >"$WORK/images/camera.txt"
calibrate=(calibrate "$WORK/images" --board chessboard:5x4:0.03)
expect_exit 0 "${calibrate[@]}" --model pinhole -o "$WORK/out"
expect_output '8 frames looked at, 8 show the board'
expect_output '^advice: Only 8 views'
for file in camera.txt calibration.json coverage.png residuals.png; do
  [[ -s $WORK/out/$file ]] || fail "$file is missing or empty"
done
focal=$(json "$WORK/out/calibration.json" "['parameters']['fx']")
expect_true "the focal length is found" "abs($focal / 300 - 1) < 0.005"
[[ $(cat "$WORK/images/camera.txt") == 'what calibrates another camera' ]] || fail "camera.txt of the images was touched"
expect_exit 0 "${calibrate[@]}" --json -o "$WORK/out"
python3 -c "import json, sys; json.load(open(sys.argv[1]))" "$WORK/log" || fail "--json prints something else as well"
expect_exit 0 export "$WORK/out/camera.txt" --format kalibr -o "$WORK/export"

# What is refused.
mkdir "$WORK/mine" && echo mine >"$WORK/mine/camera.txt"
expect_exit 1 "${calibrate[@]}" -o "$WORK/mine"
[[ $(cat "$WORK/mine/camera.txt") == mine ]] || fail "a camera.txt of somebody else was overwritten"
expect_exit 1 "${calibrate[@]}" -o "$WORK/images"
expect_exit 1 calibrate "$WORK/images"
expect_output '\-\-board and -o are needed'
expect_exit 1 calibrate "$WORK/images" --board chessboard:5x -o "$WORK/no"
expect_output "'5x' is no number of columns and rows"
expect_exit 1 calibrate "$SEQUENCE" --end 5 --board chessboard:9x6 -o "$WORK/no"
expect_output 'none of the 5 frames looked at shows a chessboard of 9x6'
expect_exit 1 calibrate "$WORK/images" --end 2 --board chessboard:5x4 -o "$WORK/no"
expect_output 'well seen in 2 images'
[[ ! -e $WORK/no/camera.txt ]] || fail "there is a camera.txt, but no calibration"
expect_exit 1 calibrate camera:0 --board chessboard:9x6 -o "$WORK/no"
expect_output 'is a camera'

# Response from an exposure sweep; what is missing is named.
mkdir "$WORK/sweep"
python3 - "$WORK/sweep" <<'PY'
import sys
W, H, IMAGES = 160, 120, 40
times = open(f"{sys.argv[1]}/times.txt", "w")
for k in range(IMAGES):
    exposure = 0.05 * 1.2 ** k
    scene = (3 + (u * 7 + v * 11) % 97 + u / 9 for v in range(H) for u in range(W))
    rows = bytes(min(255, round(255 * min(1, exposure * b / 255) ** 0.5)) for b in scene)
    open(f"{sys.argv[1]}/{k:05}.pgm", "wb").write(b"P5\n%d %d\n255\n" % (W, H) + rows)
    times.write(f"{k:05} {k / 10:.2f} {exposure:.6f}\n")
PY
expect_exit 0 calibrate photometric --response "$WORK/sweep" -o "$WORK/photometric"
expect_output 'pcalib\.txt: response from 2[0-9][0-9] of 256 grey levels'
middle=$(awk '{ print NF, $129 }' "$WORK/photometric/pcalib.txt")
expect_true "the response is a square" "(lambda n, v: n == 256 and abs(v - 255 * (128 / 255) ** 2) < 1.5)(*map(float, '$middle'.split()))"
expect_exit 1 calibrate photometric -o "$WORK/photometric"
expect_exit 1 calibrate photometric --response "$WORK/images" -o "$WORK/photometric"
expect_output 'its exposure time is not known'
expect_exit 1 calibrate photometric --vignette "$WORK/images" -o "$WORK/photometric"
expect_output 'give --board and --calib'
expect_exit 1 calibrate photometric --vignette "$WORK/images" --board chessboard:5x4 --calib "$WORK/out/camera.txt" \
  -o "$WORK/photometric"
expect_output 'board is found in 8 images, which do not tell the vignette'
