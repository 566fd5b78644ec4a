#!/usr/bin/env python3
"""Checks the rules of the sources that no compiler checks: which room may include which, where libraries may show up,
and a few habits (CONTRIBUTING.md). Prints one line for each violation: file:line: what is wrong."""

import pathlib
import re
import sys

import source_measures

ROOT = pathlib.Path(__file__).resolve().parent.parent

# The parts of the project, and the folder that the includes of their files are relative to.
PARTS = {"engine": "engine", "io": "", "tools": "tools", "program": "program",
         "python": "python", "c": "c", "ros": "ros"}

# What the files of a room may include beside their own room and include/ldso: the rooms named here and, with each of
# them, its folders and all that it may include itself. A folder inside a room counts as a room of its own where it is
# listed; it does not see the room around it.
ROOMS = {
    # engine
    "util": [],
    "settings": ["util"],
    "geometry": ["util"],
    "image": ["geometry", "settings"],
    "odometry/state": ["image"],
    "odometry/residual": ["odometry/state"],
    "odometry/selection": ["image"],
    "odometry/init": ["odometry/selection", "odometry/state"],
    "odometry/tracking": ["odometry/residual"],
    "odometry/window": ["odometry/residual"],
    "odometry/depth": ["odometry/window"],
    "odometry": ["odometry/selection", "odometry/init", "odometry/tracking", "odometry/depth"],
    "place": ["image"],
    "mapping/map": ["place"],
    "mapping/matching": ["mapping/map"],
    "mapping/verification": ["mapping/matching"],
    "mapping/graph": ["mapping/map"],
    "mapping": ["mapping/verification", "mapping/graph"],
    "slam": ["odometry", "mapping"],
    "sequence": ["slam"],
    # io
    "io/text": ["util"],
    "io/settings": ["io/text", "settings"],
    "io/images": ["io/text", "image"],
    "io/calibration": ["io/images"],
    "io/maps": ["io/text", "geometry"],
    "io/bags": ["io/calibration"],
    "io/datasets": ["io/bags", "io/maps"],
    # tools
    "simulation/rendering": ["image"],
    "simulation/worlds": ["simulation/rendering", "io/datasets"],
    "simulation/worlds/street": ["simulation/worlds"],
    "simulation/sequences": ["simulation/worlds/street", "io/datasets"],
    "evaluation": ["io/datasets"],
    "experiment/jobs": ["io/datasets"],
    "experiment/plan": ["experiment/jobs", "io/settings"],
    "experiment/results": ["experiment/jobs", "evaluation"],
    "experiment/summary": ["experiment/results"],
    "experiment": ["experiment/summary", "experiment/plan"],
    # program
    "camera": ["io/datasets"],
    "running": ["sequence", "camera"],
    "doctor": ["sequence", "io/datasets"],
    "viewer/map": ["io/datasets"],
    "viewer/recording": ["viewer/map"],
    "viewer/server": ["viewer/map"],
    "viewer": ["viewer/recording", "viewer/server"],
    "calibration/board": ["io/images"],
    "calibration/lens": ["calibration/board", "io/datasets"],
    "calibration/photometric": ["calibration/lens"],
    "scaling": ["slam", "io/datasets"],
    "terminal": ["running", "scaling"],
    "results": ["running", "scaling", "viewer", "evaluation", "io/settings"],
    "imagery": ["viewer/recording"],
    "report": ["results"],
    "output": ["report", "imagery", "mapping/map", "experiment/jobs"],
    "commands/experiment": ["output", "terminal", "experiment/summary", "experiment/plan", "simulation/sequences"],
    "commands": ["commands/experiment", "doctor", "calibration/lens", "calibration/photometric"],
    "": ["commands"],  # program/main.cpp
    # c
    "interface": ["sequence", "io/datasets", "io/settings"],
    # ros
    "core": ["sequence", "output"],
    "ros1": ["core"],
    "ros1/test": ["ros1"],
    "ros2/src": ["core"],
    # python
    "bindings": ["output", "simulation/sequences"],
}

# Libraries that stay inside rooms.
LIBRARIES = {
    r"opencv2/": {"io", "camera", "calibration", "doctor", "place", ""},
    r"zip\.h": {"io", "simulation"},
    r"(bzlib|lz4frame|sqlite3|zstd)\.h": {"io"},
    r"yaml-cpp/": {"io", "simulation"},
    r"nlohmann/": {"io", "evaluation", "experiment", "results", "report", "output", "commands", "doctor", "calibration",
                    "viewer"},
    r"CLI/": {"commands", "results", "terminal", ""},
    r"boost/": {"viewer"},
    r"pybind11/": {"bindings"},
    r"ceres/": {"mapping"},
    r"hwy/": {"image", "odometry", "simulation"},
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


def part_of(path):
    return path.relative_to(ROOT).parts[0]


def include_name(path):
    """How others include it: "io/text/text_file.h", "odometry/odometry.h"."""
    return path.relative_to(ROOT / PARTS[part_of(path)]).as_posix()


def room_of(name):
    """The room of a file by the name it is included by, e.g. odometry/window of odometry/window/gauge.h."""
    parts = name.split("/")
    if len(parts) == 1:
        return ""
    return max((r for r in ROOMS if parts[:-1][: r.count("/") + 1] == r.split("/")), key=len, default=None)


def reach(room):
    """The rooms that a room may include."""
    found, waiting = set(), list(ROOMS[room])
    while waiting:
        other = waiting.pop()
        if other not in found:
            found.add(other)
            waiting += ROOMS[other]
    return found


def check_room_circles():
    for room in ROOMS:
        if room in reach(room):
            problem(ROOT / "scripts/check_source.py", 1, f"the rooms around {room} may include each other in a circle")


def is_test(path):
    return path.stem.endswith("_test") or path.stem.startswith("test_")


def may_include(room, target):
    other = room_of(target)
    return other is not None and (other == room or other in reach(room))


def check_rooms(path, room):
    for line, quoted, name in includes(path):
        if not quoted:
            continue
        other = resolve(name)
        if other is None:
            problem(path, line, f"there is no {name}: includes are relative to engine/, tools/, program/ or the project")
        elif name.startswith("ldso/") or name == "ldso.h" or (is_test(path) and is_test(other)):
            pass  # tests share helpers
        elif is_test(path) and name.split("/")[0] == room.split("/")[0]:
            pass  # and see all of their room
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
            if not quoted and re.match(pattern, name) and room.split("/")[0] not in rooms:
                problem(path, line, f"<{name}> belongs to {', '.join(sorted(rooms))} only")


def resolve(name):
    for base in ["include", *PARTS.values()]:
        path = ROOT / base / name
        if path.is_file() and (base or name.startswith("io/")):
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
    (r"\bset(?:NumThreads|LogLevel)\(|\bsetlocale\(|\bstd::signal\(", "what holds for the process is the program's"),
]


PROCESS_HABITS = [
    (r"\b(setLogLevel|setNumThreads|setlocale|set_terminate)\b", "what changes the whole process is for main.cpp alone"),
]


def check_habits(path, rules):
    for number, line in code_lines(path):
        for pattern, text in rules:
            if re.search(pattern, line):
                problem(path, number, text)


def check_pragma_once(path):
    if "#pragma once" not in path.read_text(encoding="utf-8"):
        problem(path, 1, "a header begins with #pragma once")


def check_folders(sources):
    """Every folder is a room of its own, so that no two can include each other unseen."""
    for folder in sorted({include_name(p).rpartition("/")[0] for p in sources}):
        if folder not in ROOMS:
            problem(ROOT / "scripts/check_source.py", 1, f"{folder} is no room in ROOMS")


def check_measures(files):
    for path, line, text in source_measures.problems([p for p in files if not is_test(p)], ROOT):
        problem(path, line, text)


def check_build_files():
    files = [*ROOT.glob("CMake*"), *ROOT.glob("cmake/*"), *(ROOT / f"{part}/CMakeLists.txt" for part in PARTS),
             *ROOT.glob("bench/CMakeLists.txt"), *ROOT.glob("fuzz/CMakeLists.txt"), *ROOT.glob("tests/**/CMakeLists.txt")]
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
    sources = sorted(p for part in PARTS for p in (ROOT / part).rglob("*")
                     if p.suffix in (".h", ".cpp") and "stand_in" not in p.parts)
    for path in public:
        check_public_header(path)
        check_habits(path, LIBRARY_HABITS)
    for path in sources:
        room = room_of(include_name(path))
        if room is None:
            problem(path, 1, "lies in no room that scripts/check_source.py knows")
            continue
        check_rooms(path, room)
        if not is_test(path):
            check_libraries(path, room)
            if part_of(path) != "program" and not room.startswith("ros1"):
                check_habits(path, LIBRARY_HABITS)
        if path.stem.endswith("_kernels") and path.suffix == ".cpp":
            check_kernel(path)
    for path in public + sources:
        check_habits(path, HABITS)
        if path != ROOT / "program/main.cpp":
            check_habits(path, PROCESS_HABITS)
        if path.suffix == ".h":
            # Highway's *-inl.h are included once for each instruction set.
            if not path.stem.endswith("-inl") and path.name != "ldso.h":  # That is C.
                check_pragma_once(path)
            check_habits(path, HEADER_HABITS)
    headers = public + [p for p in sources if p.suffix == ".h"]
    check_room_circles()
    check_include_circles(headers)
    check_one_definition(headers)
    check_folders(sources)
    check_measures(public + sources)
    check_build_files()
    print("\n".join(problems) if problems else f"{len(public) + len(sources)} files are as they should be")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
