#!/usr/bin/env bash
# interface_test.sh PROGRAM SEQUENCE WORK LIBRARY COMPILER: the interface in C is what it was: its functions under their
# versions, the layout of its structs; its header is C99 and C++; the example gives what the program gives.
LDSO=$1 SEQUENCE=$2 WORK=$3/c_interface LIBRARY=$4 COMPILER=$5
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
include=$here/../../include
rm -rf "$WORK" && mkdir -p "$WORK/images"
source "$here/../../tests/test_tools.sh"

# What may be relied on. A function that is new is added to both files; a line that is gone breaks programs.
nm -D --defined-only --with-symbol-versions "$LIBRARY" | awk '$2 != "A" { print $3 }' | sort >"$WORK/symbols"
diff "$here/symbols.txt" "$WORK/symbols" >"$WORK/log" || fail "libldso.so.1 shows other functions than it did"
[[ $(readelf -d "$LIBRARY" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p') == libldso.so.1 ]] || fail "the library has another name"
"$COMPILER" -std=c99 -Wall -Wextra -pedantic -Werror -I"$include" "$here/layout.c" -o "$WORK/layout"
"$WORK/layout" >"$WORK/layout.txt"
diff "$here/layout.txt" "$WORK/layout.txt" >"$WORK/log" || fail "structs of ldso.h are laid out otherwise than they were"
"${COMPILER}" -x c++ -std=c++11 -Wall -Wextra -Werror -I"$include" -fsyntax-only "$here/layout.c"

# The example, on images that it reads itself.
python3 - "$SEQUENCE/images" "$WORK/images" <<'PY'
import pathlib, struct, sys, zlib
def grey_png(path):
    data, at, body = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", data[at + 8:at + 21])
            assert (depth, colour, interlaced) == (8, 0, 0)
        body += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    raw, rows, above = zlib.decompress(body), [], bytearray(width)
    def paeth(a, b, c):
        p = a + b - c
        return min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
    for y in range(height):
        kind, row = raw[y * (width + 1)], bytearray(raw[y * (width + 1) + 1:(y + 1) * (width + 1)])
        for x in range(width):
            a, b, c = row[x - 1] if x else 0, above[x], above[x - 1] if x else 0
            row[x] = (row[x] + [0, a, b, (a + b) // 2, paeth(a, b, c)][kind]) & 255
        rows.append(row)
        above = row
    return width, height, b"".join(rows)
for path in sorted(pathlib.Path(sys.argv[1]).iterdir()):
    width, height, pixels = grey_png(path)
    (pathlib.Path(sys.argv[2]) / (path.stem + ".pgm")).write_bytes(b"P5\n%d %d\n255\n" % (width, height) + pixels)
PY
"$COMPILER" -std=c99 -Wall -Wextra -pedantic -Werror -I"$include" "$here/../example/track.c" "$LIBRARY" -o "$WORK/track"
export LD_LIBRARY_PATH=$(dirname "$LIBRARY")
(cd "$WORK" && ./track "$(realpath "$SEQUENCE")/camera.txt" 30 images/*.pgm >trajectory.txt 2>log) || fail "the example failed"
grep -q 'the map is initialized' "$WORK/log" || fail "the example heard nothing"
# Times and exposures come with the sequence and are not what the example gives: the program gets the same.
mkdir "$WORK/as_the_example" && ln -s "$WORK/images" "$WORK/as_the_example/images"
for file in camera.txt pcalib.txt vignette.png; do cp "$SEQUENCE/$file" "$WORK/as_the_example/"; done
awk 'NF { printf "%s %.17g\n", $1, (NR - 1) / 30 }' "$SEQUENCE/times.txt" >"$WORK/as_the_example/times.txt"
expect_exit 0 run "$WORK/as_the_example" -o "$WORK/by_program" --no-report
cmp "$WORK/trajectory.txt" <(grep -v '^#' "$WORK/by_program/trajectory.txt") || fail "the example's trajectory is not that of the program"
cmp "$WORK/map.ply" "$WORK/by_program/map.ply" || fail "the example's map is not that of the program"

# Bad input is said.
status=0
(cd "$WORK" && ./track no_camera.txt 30 images/*.pgm >/dev/null 2>log) || status=$?
[[ $status == 1 ]] && grep -q 'no_camera.txt' "$WORK/log" || fail "a missing calibration is not said"
"$COMPILER" -std=c99 -Wall -Wextra -pedantic -Werror -I"$include" "$here/misuse.c" "$LIBRARY" -o "$WORK/misuse"
"$WORK/misuse" >"$WORK/log" || fail "misuse is not refused"
