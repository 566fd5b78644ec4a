#!/usr/bin/env python3
"""tidy_batches.py BUILD [FILES...]: clang-tidy over many sources in a fraction of the time of one by one.

Nearly all the time goes to the headers of Eigen and GoogleTest. So sources of a folder that have the same flags are
included in one file and looked at together, if they compile together; those that do not (they define the same names)
go into further batches. Highway kernels, which include themselves, are looked at one by one. BUILD is a configured
folder; without FILES: all sources of the parts and bench/. Prints findings; ends with 1 if there are any.
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys

MOST = 14  # Files a batch; more would take more memory than time is gained.
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
COMPILER = shutil.which("clang++-14") or "clang++"
TIDY = shutil.which("clang-tidy-14") or "clang-tidy"


def flags_of(command):
    """What a source is compiled with, without the compiler, its launcher, the source and the object."""
    words = shlex.split(command)
    first = next(i for i, word in enumerate(words) if word.startswith("-"))
    flags = []
    skip = False
    for word in words[first:]:
        if not skip and word not in ("-o", "-c"):
            flags.append(word)
        skip = word in ("-o", "-c")
    return tuple(flags)


def groups(build, wanted):
    """Lists of files by folder, flags, and whether they are tests."""
    found = {}
    seen = set()
    for entry in json.load(open(os.path.join(build, "compile_commands.json"))):
        path = entry["file"]
        name = os.path.relpath(path, ROOT)
        if not name.startswith(("engine/", "io/", "tools/", "program/", "bench/")) or path in seen or (wanted and name not in wanted):
            continue
        seen.add(path)
        alone = name if "foreach_target" in open(path).read() else ""
        room = "/".join(os.path.dirname(name).split("/")[:3])
        found.setdefault((room, flags_of(entry["command"]), name.endswith("_test.cpp"), alone), []).append(path)
    return found


def write_batch(path, files):
    with open(path, "w") as out:
        out.writelines(f'#include "{file}"\n' for file in files)


def compatible(path, files, flags):
    """Those of `files` that compile together; at least the first one."""
    while len(files) > 1:
        write_batch(path, files)
        command = [COMPILER, "-fsyntax-only", "-ferror-limit=0", "-w", path, *flags]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode == 0:
            break
        bad = set(re.findall(r"^(\S+?\.cpp):\d+:\d+: (?:fatal )?error", run.stderr, re.M)) & set(files[1:])
        files = [file for file in files if file not in (bad or {files[-1]})]
    return files


def tidy(source, flags):
    """Findings in the source, in what it includes of this project, and whether there are any."""
    # Names of other sources of a batch are no shadowed ones.
    command = [TIDY, "--quiet", f"--config-file={ROOT}/.clang-tidy", f"--header-filter={ROOT}/(include|src|bench)/.*",
               "--checks=-bugprone-suspicious-include", source, "--", *flags, "-Wno-shadow"]
    run = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    return run.stdout, run.returncode != 0


def main():
    build, wanted = os.path.abspath(sys.argv[1]), set(sys.argv[2:])
    scratch = os.path.join(build, "tidy_batch.cpp")
    checked, findings = 0, 0
    for (_, flags, _, _), pending in groups(build, wanted).items():
        while pending:
            batch = compatible(scratch, pending[:MOST], flags)
            output, bad = tidy(scratch if len(batch) > 1 else batch[0], flags)
            checked += len(batch)
            findings += bad
            pending = [file for file in pending if file not in batch]
            if output.strip():
                print(output, flush=True)
            print(f"{checked} files", file=sys.stderr, flush=True)
    if os.path.exists(scratch):
        os.remove(scratch)
    print(f"clang-tidy: {checked} files, {findings} batches with findings")
    return findings > 0


sys.exit(main())
