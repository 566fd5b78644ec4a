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

# own_image SEQUENCE NUMBER: the path of the image, which is no link any more and may be changed.
own_image() {
  local image
  image=$(find "$1/images" -name '*.*' | sort | sed -n "$(($2 + 1))p")
  cp --remove-destination "$(realpath "$image")" "$image"
  echo "$image"
}

# repeat_sequence FROM TO TIMES: the images to and fro, so many times in all, as links. Without ground truth.
repeat_sequence() {
  mkdir -p "$2/images"
  cp "$1/camera.txt" "$2/"
  find "$1" -maxdepth 1 \( -name pcalib.txt -o -name vignette.png \) -exec cp {} "$2/" \;
  python3 - "$@" <<'PY'
import os, sys
source, target, times = sys.argv[1], sys.argv[2], int(sys.argv[3])
lines = [line.split() for line in open(source + "/times.txt") if line.strip() and not line.startswith("#")]
images = sorted(os.listdir(source + "/images"))
assert len(lines) == len(images)
frames = list(zip(images, lines))
number = 0
with open(target + "/times.txt", "w") as out:
    for repetition in range(times):
        for image, line in frames if repetition % 2 == 0 else frames[::-1]:
            name = "%06d" % number
            os.symlink(os.path.realpath(source + "/images/" + image), target + "/images/" + name + os.path.splitext(image)[1])
            out.write(" ".join([name, "%.6f" % (number / 10)] + line[2:]) + "\n")
            number += 1
PY
}

# stutter_sequence FROM TO EVERY: each EVERY-th image comes twice, at even intervals of time, as from a driver that had no
# new one. Ground truth is where the image was taken.
stutter_sequence() {
  copy_sequence "$1" "$2"
  rm -r "$2/images" && mkdir "$2/images"
  python3 - "$@" <<'PY'
import os, sys
source, target, every = sys.argv[1], sys.argv[2], int(sys.argv[3])
rows = lambda name: [line.split() for line in open(source + name) if line.strip() and not line.startswith("#")]
times, truth, images = rows("/times.txt"), rows("/groundtruth.txt"), sorted(os.listdir(source + "/images"))
assert len(times) == len(truth) == len(images)
interval = float(times[1][1]) - float(times[0][1])
shown = [i for i in range(len(times)) for _ in range(1 + (i % every == every - 1))]
with open(target + "/times.txt", "w") as new_times, open(target + "/groundtruth.txt", "w") as new_truth:
    for number, i in enumerate(shown):
        name, time = "%06d" % number, "%.9f" % (number * interval)
        os.symlink(os.path.realpath(source + "/images/" + images[i]),
                   target + "/images/" + name + os.path.splitext(images[i])[1])
        new_times.write(" ".join([name, time] + times[i][2:]) + "\n")
        new_truth.write(" ".join([time] + truth[i][1:]) + "\n")
PY
}
