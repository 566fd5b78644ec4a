#!/usr/bin/env python3
"""Checks the rules of the sources that no compiler checks: which room may include which, where libraries may show up,
and a few habits (CONTRIBUTING.md). Prints one line for each violation: file:line: what is wrong."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What the files of a room may include beside their own room and include/ldso. A folder inside a room counts as a room
# of its own where it is listed.
ROOMS = {
    "util": [],
    "geometry": ["util"],
    "image": ["geometry", "util"],
    "io": ["image", "geometry", "util"],
    "odometry/selection": ["image", "geometry", "util"],
    "odometry/init": ["odometry/selection", "odometry:records", "image", "geometry", "util"],
    "odometry/window": ["odometry:records", "image", "geometry", "util"],
    "odometry": ["odometry/selection", "odometry/init", "odometry/window", "image", "geometry", "util"],
    "place": ["image", "geometry", "util"],
    "mapping": ["place", "image", "geometry", "util"],
    "slam": ["mapping", "place", "odometry", "io", "image", "geometry", "util"],
    "evaluation": ["io", "image", "geometry", "util"],
    "simulation": ["io", "image", "geometry", "util"],
    "viewer": ["slam", "io", "image", "geometry", "util"],
    "app": ["viewer", "simulation", "evaluation", "slam", "mapping", "place", "odometry", "odometry/selection",
            "odometry/init", "odometry/window", "io", "image", "geometry", "util"],
}

# The plain records of the odometry, on which its window and its start stand ("odometry:records" above).
ODOMETRY_RECORDS = {"keyframe", "point", "brightness", "residual_pattern", "texel_sampling-inl"}

# Libraries that stay inside rooms.
LIBRARIES = {
    r"opencv2/": {"io", "place"},
    r"zip\.h": {"io", "simulation"},
    r"yaml-cpp/": {"io", "evaluation", "simulation"},
    r"nlohmann/": {"io", "evaluation", "app", "viewer"},
    r"CLI/": {"app"},
    r"boost/": {"viewer"},
    r"ceres/": {"mapping"},
    r"hwy/": {"image", "odometry", "odometry/selection", "odometry/init", "odometry/window", "simulation"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')

problems = []


def problem(path, line, text):
    problems.append(f"{path.relative_to(ROOT)}:{line}: {text}")


def code_lines(path):
    """(number, line) without comments and, but for #include, without the contents of strings."""
    text = path.read_text(encoding="utf-8")
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group(0).count("\n"), text, flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        if not INCLUDE.match(line):
            line = re.sub(r'"(?:\\.|[^"\\])*"', '""', line)
        yield number, re.sub(r"//.*", "", line)


def includes(path):
    """(line, is_quoted, name)"""
    for number, line in code_lines(path):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1) == '"', match.group(2)


def room_of(name):
    """The room of a path below src/, e.g. odometry/window of odometry/window/window.h."""
    parts = name.split("/")
    return max((r for r in ROOMS if parts[:-1][: r.count("/") + 1] == r.split("/")), key=len, default=None)


def is_test(path):
    return path.stem.endswith("_test") or path.stem.startswith("test_")


def may_include(room, target):
    other = room_of(target)
    if other == room or other in ROOMS[room]:
        return True
    if other == "odometry" and "odometry:records" in ROOMS[room]:
        return pathlib.PurePath(target).stem in ODOMETRY_RECORDS
    # To include a room from outside is to include any folder of it.
    return other is not None and room.split("/")[0] != other.split("/")[0] and other.split("/")[0] in ROOMS[room]


def check_rooms(path, room):
    for line, quoted, name in includes(path):
        if not quoted:
            continue
        if name.startswith("ldso/"):
            if not (ROOT / "include" / name).exists():
                problem(path, line, f"there is no include/{name}")
        elif not (ROOT / "src" / name).exists():
            problem(path, line, f'there is no src/{name}: includes are relative to src/')
        elif is_test(path) and name.split("/")[0] == room.split("/")[0]:
            pass  # the folders of a room share test helpers
        elif not may_include(room, name):
            problem(path, line, f"{room} must not include {name}: it lies above it (scripts/check_source.py)")


def check_public_header(path):
    for line, quoted, name in includes(path):
        if quoted and not name.startswith("ldso/"):
            problem(path, line, "a public header includes public headers only")
        if not quoted and "/" in name and not name.startswith("Eigen/"):
            problem(path, line, f"<{name}> must not be in a public header")


def check_libraries(path, room):
    for line, quoted, name in includes(path):
        for pattern, rooms in LIBRARIES.items():
            if not quoted and re.match(pattern, name) and room not in rooms:
                problem(path, line, f"<{name}> belongs to {', '.join(sorted(rooms))} only")


def resolve(name):
    for base in ("src", "include"):
        path = ROOT / base / name
        if path.exists():
            return path
    return None


def check_kernel(path):
    """Code that is compiled for several instruction sets must not see Eigen: its inline functions would be compiled
    with instructions that other machines do not have, and the linker may pick those."""
    seen, waiting = {path}, [path]
    while waiting:
        current = waiting.pop()
        for line, quoted, name in includes(current):
            if name.startswith("Eigen/"):
                problem(path, 1, f"a kernel must not include Eigen, but {current.relative_to(ROOT)}:{line} does")
            file = resolve(name) if quoted else None
            if file and file not in seen:
                seen.add(file)
                waiting.append(file)


HEADER_HABITS = [(r"^\s*using\s+namespace\b", "no `using namespace` in a header")]
HABITS = [
    (r"\busing\s+namespace\s+(std|Eigen|cv)\b", "no `using namespace` of a library"),
    (r"\bsleep_(for|until)\b|\busleep\b", "nothing waits by sleeping: use a condition variable"),
    (r"\.detach\(\)", "no thread is detached"),
    (r"\bstd::rand\b|\bsrand\(|\brandom_device\b", "random numbers come from seeded generators"),
    (r"\bstd::unordered_\w+<[^<>]*\*", "no container ordered by addresses"),
]
LIBRARY_HABITS = [
    (r"\bstd::(cout|cerr|clog)\b|\b(?:std::)?(?:printf|puts|fprintf)\(", "the library prints nothing: use a LogSink"),
    (r"\b(?:std::)?(?:exit|abort|quick_exit)\(", "the library does not end the program: throw ldso::Error"),
]


def check_habits(path, rules):
    for number, line in code_lines(path):
        for pattern, text in rules:
            if re.search(pattern, line):
                problem(path, number, text)


def check_pragma_once(path):
    if "#pragma once" not in path.read_text(encoding="utf-8"):
        problem(path, 1, "a header begins with #pragma once")


def check_built(path):
    """A test that no CMakeLists.txt names would never run."""
    folder = path.parent
    while folder != ROOT:
        lists = folder / "CMakeLists.txt"
        name = path.relative_to(folder).as_posix()
        if lists.exists() and re.search(rf"(?<![\w/.]){re.escape(name)}(?![\w.])", lists.read_text(encoding="utf-8")):
            return
        folder = folder.parent
    problem(path, 1, "no CMakeLists.txt names this file")


def check_build_files():
    files = [*ROOT.glob("CMake*"), *ROOT.glob("cmake/*"), *ROOT.glob("src/**/CMakeLists.txt"),
             *ROOT.glob("bench/CMakeLists.txt"), *ROOT.glob("tests/**/CMakeLists.txt")]
    for path in files:
        for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
            flag = re.search(r"-march=|-mavx|-mfma|-ffast-math|-Ofast", line)
            if flag:
                problem(path, number, f"{flag.group(0)}: one binary runs on every machine, with the same results")


def check_include_circles(headers):
    """`#pragma once` would hide them."""
    edges = {h: [p for _, q, n in includes(h) if q and (p := resolve(n))] for h in headers}
    state = {}

    def visit(header, way):
        if state.get(header) == "done":
            return
        if state.get(header) == "open":
            circle = [p.relative_to(ROOT).as_posix() for p in way[way.index(header):]]
            problem(header, 1, "headers include each other: " + " -> ".join(circle))
            return
        state[header] = "open"
        for other in edges.get(header, []):
            visit(other, way + [other])
        state[header] = "done"

    for header in headers:
        visit(header, [header])


def check_one_definition(headers):
    """A class that two headers define has two layouts under one name, and the linker picks functions of either."""
    first = {}
    for header in headers:
        space = ""
        for number, line in code_lines(header):
            opened = re.match(r"namespace ([\w:]+) \{", line)
            space = opened.group(1) if opened else space
            defined = re.match(r"(?:struct|class|union|enum(?: class)?) (\w+)(?: final)?(?: ?:[^{;]*)? ?\{", line)
            if not defined:
                continue
            other = first.setdefault((space, defined.group(1)), header)
            if other != header:
                problem(header, number, f"{space}::{defined.group(1)} is also in {other.relative_to(ROOT)}")


def main():
    public = sorted((ROOT / "include").rglob("*.h"))
    sources = sorted(p for p in (ROOT / "src").rglob("*") if p.suffix in (".h", ".cpp"))
    for path in public:
        check_public_header(path)
        check_habits(path, LIBRARY_HABITS)
    for path in sources:
        room = room_of(path.relative_to(ROOT / "src").as_posix())
        if room is None:
            problem(path, 1, "lies in no room that scripts/check_source.py knows")
            continue
        check_rooms(path, room)
        if not is_test(path):
            check_libraries(path, room)
            if room != "app":
                check_habits(path, LIBRARY_HABITS)
        if path.stem.endswith("_kernels") and path.suffix == ".cpp":
            check_kernel(path)
        if path.suffix == ".cpp":
            check_built(path)
    for path in public + sources:
        check_habits(path, HABITS)
        if path.suffix == ".h":
            # Highway's *-inl.h are included once for each instruction set.
            if not path.stem.endswith("-inl"):
                check_pragma_once(path)
            check_habits(path, HEADER_HABITS)
    headers = public + [p for p in sources if p.suffix == ".h"]
    check_include_circles(headers)
    check_one_definition(headers)
    check_build_files()
    print("\n".join(problems) if problems else f"{len(public) + len(sources)} files are as they should be")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
