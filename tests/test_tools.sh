# shellcheck shell=bash
# Shared by the end-to-end tests: sourced, with LDSO (the program) and WORK (an empty folder of this test) set.
set -euo pipefail
export LC_ALL=C

fail() {
  echo "FAILED: $*" >&2
  if [[ -f $WORK/log ]]; then
    echo "--- output of the program" >&2
    cat "$WORK/log" >&2
  fi
  exit 1
}

# expect_exit CODE ARGUMENTS...: runs the program with the arguments, its output goes to $WORK/log.
expect_exit() {
  local expected=$1 status=0
  shift
  "$LDSO" "$@" >"$WORK/log" 2>&1 || status=$?
  ((status == expected)) || fail "ldso $* ended with $status, expected is $expected"
}

# expect_output PATTERN: the program's last output contains the extended regular expression.
expect_output() { grep -Eq -- "$1" "$WORK/log" || fail "the output does not contain '$1'"; }

# json FILE EXPRESSION: a figure of a JSON file, e.g. json run.json "['counts']['frames']".
json() { python3 -c "import json, sys; print(json.load(open(sys.argv[1]))$2)" "$1"; }

# expect_json FILE EXPRESSION VALUE
expect_json() {
  local value
  value=$(json "$1" "$2")
  [[ $value == "$3" ]] || fail "$1: $2 is $value, expected is $3"
}

# expect_true DESCRIPTION PYTHON-EXPRESSION
expect_true() { [[ $(python3 -c "print($2)") == True ]] || fail "$1: not true that $2"; }

poses() { awk '!/^#/ && NF { n++ } END { print n + 0 }' "$1"; }

# copy_sequence FROM TO: images as links, text files as copies that can be changed.
copy_sequence() {
  mkdir -p "$2/images"
  ln -s "$(realpath "$1")"/images/* "$2/images/"
  find "$1" -maxdepth 1 -type f -exec cp {} "$2/" \;
}

# grey_image PATH WIDTH HEIGHT LEVEL: a PNG file of that one grey level.
grey_image() {
  python3 - "$@" <<'PY'
import struct, sys, zlib
path, (width, height, level) = sys.argv[1], map(int, sys.argv[2:])
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
rows = b"".join(b"\0" + bytes([level]) * width for _ in range(height))
open(path, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
                       + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
PY
}

# own_image SEQUENCE NUMBER: the path of the image, which is no link any more and may be changed.
own_image() {
  local image
  image=$(find "$1/images" -name '*.*' | sort | sed -n "$(($2 + 1))p")
  cp --remove-destination "$(realpath "$image")" "$image"
  echo "$image"
}

# reorder_sequence FROM TO SHOWN INTERVAL [truth]: its images as links in the order of SHOWN, a Python expression of their
# number n that gives indices, one each INTERVAL seconds; with `truth` the ground truth of when they were taken.
reorder_sequence() {
  mkdir -p "$2/images"
  cp "$1/camera.txt" "$2/"
  find "$1" -maxdepth 1 \( -name pcalib.txt -o -name vignette.png \) -exec cp {} "$2/" \;
  python3 - "$@" <<'PY'
import os, sys
source, target, shown, interval = sys.argv[1:5]
rows = lambda name: [line.split() for line in open(source + name) if line.strip() and not line.startswith("#")]
times, images = rows("/times.txt"), sorted(os.listdir(source + "/images"))
assert len(times) == len(images)
frames = [("%06d" % k, "%.9f" % (k * float(interval)), i) for k, i in enumerate(eval(shown, {"n": len(images)}))]
with open(target + "/times.txt", "w") as out:
    for name, time, i in frames:
        image = target + "/images/" + name + os.path.splitext(images[i])[1]
        os.symlink(os.path.realpath(source + "/images/" + images[i]), image)
        out.write(" ".join([name, time] + times[i][2:]) + "\n")
if "truth" in sys.argv[5:]:
    truth = rows("/groundtruth.txt")
    assert len(truth) == len(images)
    with open(target + "/groundtruth.txt", "w") as out:
        out.writelines(" ".join([time] + truth[i][1:]) + "\n" for _, time, i in frames)
PY
}

# repeat_sequence FROM TO TIMES: the images to and fro, so many times in all. Without ground truth.
repeat_sequence() {
  reorder_sequence "$1" "$2" "[i for k in range($3) for i in (range(n) if k % 2 == 0 else range(n - 1, -1, -1))]" 0.1
}

# long_sequence FROM TO: so long that a run over it cannot be over before a signal comes. Sets `total`, its frames.
long_sequence() {
  repeat_sequence "$1" "$2" 200
  total=$(find "$2/images" -name '*.*' | wc -l)
}

# stutter_sequence FROM TO EVERY INTERVAL: each EVERY-th image comes twice, as from a driver that had no new one.
stutter_sequence() {
  reorder_sequence "$1" "$2" "[i for i in range(n) for _ in range(2 if i % $3 == $3 - 1 else 1)]" "$4" truth
}
