#!/usr/bin/env bash
# Runs in a Debian without anything of ldso: installs the packages beside this file and uses them as their users would.
# README's quick start comes first: three commands and at most two minutes lead to the first trajectory. The rest is for
# those that build on it. scripts/try_packages.sh makes such a Debian.
set -euo pipefail
export LC_ALL=C DEBIAN_FRONTEND=noninteractive
cd "$(dirname "${BASH_SOURCE[0]}")"
fail() { echo "use_packages.sh: $*" >&2; exit 1; }
step() { printf '\n== %s (%d s)\n' "$*" "$SECONDS"; }
install() {
  apt-get -qq install -y --no-install-recommends "$@" >install.log 2>&1 || { cat install.log; fail "$*: cannot be installed"; }
}
# indented_after TEXT FILE: the lines of code that follow the line that begins so, without their indentation.
indented_after() {
  awk -v text="$1" 'index($0, text) == 1 { on = 1; next } on && /^    / { print substr($0, 5); seen = 1; next } seen { exit }' "$2"
}
# fenced_after TEXT FILE: the first block of code between fences after that line.
fenced_after() {
  awk -v text="$1" 'index($0, text) == 1 { on = 1; next } on && /^```/ { if (seen) exit; seen = 1; next } seen' "$2"
}

apt-get -qq update

step "The tarball, with nothing installed"
mkdir elsewhere && tar xzf ldso-*.tar.gz -C elsewhere
unpacked=$(echo elsewhere/ldso-*)
"$unpacked/bin/ldso" simulate room -o small --frames 60 --size 320x240 >/dev/null
"$unpacked/bin/ldso" run small -o by_tarball --quiet
[[ $(wc -l <by_tarball/trajectory.txt) -gt 50 ]] || fail "the tarball's program has no trajectory"

step "README: from the package to the first trajectory"
indented_after "Or from the packages" README.md >quick_start.sh
cat quick_start.sh
(($(wc -l <quick_start.sh) == 3)) || fail "README's quick start is not three commands"
TIMEFORMAT="%0R s, of them %0U s of processor time and %0S s of the system's"
{ time bash -e quick_start.sh >quick_start.log 2>&1; } 2>quick_start.time ||
  { cat quick_start.log; fail "README's quick start does not work"; }
tail -n 8 quick_start.log
echo "from the package to the trajectory: $(cat quick_start.time)"
read -r seconds _ <quick_start.time
ldso eval out/trajectory.txt room | grep '^ATE'
ldso run small -o by_package --quiet
cmp by_package/trajectory.txt by_tarball/trajectory.txt || fail "the tarball's trajectory is another one"

# From here on nothing is timed, and nothing has to survive a power cut.
echo force-unsafe-io >/etc/dpkg/dpkg.cfg.d/unsafe-io

step "Manual pages, completion, vocabulary, viewer"
for file in ldso/vocabulary.ldsovoc man/man1/ldso.1.gz man/man1/ldso-run.1.gz bash-completion/completions/ldso; do
  dpkg -S "/usr/share/$file" >/dev/null || fail "the packages have no /usr/share/$file"
done
bash -c 'source /usr/share/bash-completion/completions/ldso; COMP_WORDS=(ldso exp); COMP_CWORD=1; _ldso
  echo "${COMPREPLY[*]}"' | grep -qx 'export experiment' || fail "commands are not completed"
{ timeout 5 ldso view out 2>&1 || true; } | grep -q 'http://127.0.0.1' || fail "the program was built without the viewer"
grep -q WebGL out/report.html || fail "the report has no map in 3D"

step "Python: the same results, and docs/python.md's loop over a video"
install ./python3-ldso_*.deb
python3 - <<'PY'
import ldso
run = ldso.run("small", "by_python", log=None)
mine, others = (open(f"{folder}/trajectory.txt").read() for folder in ("by_python", "by_package"))
assert mine == others, "Python's trajectory is another one"
world = ldso.open("small")
for i in range(len(world)):
    image = world[i].image
    with open(f"small/{i:05d}.pgm", "wb") as file:
        file.write(b"P5 %d %d 255\n" % image.shape[::-1] + image.astype("uint8").tobytes())
PY
install python3-opencv
mkdir video && cp room/camera.txt video/
python3 - <<'PY'
import cv2, pathlib
video = cv2.VideoWriter("video/video.mp4", cv2.VideoWriter_fourcc(*"mp4v"), 30, (640, 480))
for path in sorted(pathlib.Path("room/images").iterdir()):
    video.write(cv2.imread(str(path)))
video.release()
PY
fenced_after "## Images one by one" docs/python.md >video/loop.py
(($(wc -l <video/loop.py) <= 15)) || fail "the loop over a video has more than 15 lines"
(cd video && python3 loop.py >log && tail -n 1 log && ldso eval trajectory.txt ../room | grep '^ATE')
(($(wc -l <video/trajectory.txt) > 200)) || fail "most of the video has no poses"

step "C"
install ./libldso1_*.deb ./libldso-dev_*.deb gcc g++ libc6-dev cmake ninja-build pkgconf
# shellcheck disable=SC2046  # several options
cc -std=c99 -o track example/track.c $(pkg-config --cflags --libs ldso)
ldd track | grep -q 'libldso.so.1 => /' || fail "the example is not linked with the library"
./track small/camera.txt 30 small/*.pgm >by_c.txt
(($(wc -l <by_c.txt) > 50)) || fail "the example in C has no trajectory"

step "C++"
for project in consumer consumer_output; do
  cmake -G Ninja -S "$project" -B "$project/build" -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build "$project/build" >/dev/null
done
consumer/build/consumer
consumer_output/build/consumer small by_library >/dev/null
cmp by_library/trajectory.txt by_package/trajectory.txt || fail "the library's trajectory is another one"

step "Gone again"
apt-get -qq purge -y ldso libldso1 libldso-dev python3-ldso >/dev/null
left=$(find /usr -name '*ldso*' -not -path '/usr/share/doc/*')
[[ -z $left ]] || fail "these stayed behind: $left"
((seconds <= 120)) || fail "all works, but from the package to the first trajectory it took $seconds s, more than two minutes"
echo "1 passed, 0 failed"
