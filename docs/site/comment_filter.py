#!/usr/bin/env python3
"""Doxygen's filter for the public headers: what the comments say by their place, told in Doxygen's words.

A C++ header's first comment becomes the description of the file, and its declarations a group, so that a page can show them
header by header. In ldso.h plain comments become those of what they stand above, or behind. Lines of a
comment that are indented are code."""

import pathlib
import re
import sys


def group_of(path):
    """ldso_io_dataset_h for include/ldso/io/dataset.h."""
    return re.sub(r"\W", "_", str(path)[str(path).rindex("include/") + len("include/"):])


def with_code(lines, language):
    """Lines of a comment without their marks; the indented ones between \\code and \\endcode."""
    result, inside = [], False
    for line in lines:
        is_code = line.startswith("  ") or (inside and not line.strip())
        if is_code != inside:
            result.append(f"\\code{{.{language}}}" if is_code else "\\endcode")
            inside = is_code
        result.append(line)
    return result + (["\\endcode"] if inside else [])


def cpp_header(text, path):
    lines = text.split("\n")
    end = 1
    while lines[end].startswith("//"):
        end += 1
    about = with_code([re.sub(r"^// ?", "", line) for line in lines[1:end]], "cpp")
    name = str(path)[str(path).rindex("include/") + len("include/"):]
    head = ["/// \\file", *(f"/// {line}" for line in about), "", f"/// \\defgroup {group_of(path)} {name}"]
    body = "\n".join(lines[end:])
    body = re.sub(r"^namespace ldso \{$", f"namespace ldso {{\n/// \\\\addtogroup {group_of(path)}\n/// \\\\{{\n", body, flags=re.M)
    body = re.sub(r"^\}  // namespace ldso$", "/// \\\\}\n}  // namespace ldso", body, flags=re.M)
    return "\n".join([lines[0], *head, body])


def c_header(text):
    end = text.index("*/")
    about = with_code([re.sub(r"^(/\*| \*) ?", "", line) for line in text[:end].rstrip().split("\n")], "c")
    head = "\n".join(["/** \\file", *(f" * {line}" for line in about), " */"])
    body = re.sub(r"^/\* ", "/** ", text[end + 2:], flags=re.M)
    body = re.sub(r"(;|,)( +)/\* (.*)\*/$", r"\1\2/**< \3*/", body, flags=re.M)
    return head + body


def main():
    path = pathlib.Path(sys.argv[1])
    text = path.read_text()
    sys.stdout.write(c_header(text) if path.name == "ldso.h" else cpp_header(text, path))


if __name__ == "__main__":
    main()
