"""How long functions and files are, and whether long files of the engine have a test beside them: check_source.py holds
the limits below. Run by itself it prints the figures and the longest of each."""

import pathlib
import re

# Lines from the first of the signature to the closing brace, tests left out.
MOST_FUNCTION_LINES = 60
MOST_FUNCTION_LINES_P99 = 45
# Lines of a file, tests left out.
MOST_FILE_LINES_P90 = 250
# An engine's .cpp of more lines has a _test.cpp beside it.
LONGEST_WITHOUT_TEST = 100
# What is over a limit still, by file (functions) or by the test that is missing. An entry that is not needed any more is
# a problem as well.
STILL_OPEN = set()

BLANKED = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*',
    re.S | re.M)


def blank(text):
    """Without comments, texts and preprocessor lines, but with all line breaks. Marks between digits (1'000) stay."""
    text = re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "", text)
    return BLANKED.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)


def is_scope(head):
    """Whether functions are defined inside of what this opens."""
    return re.search(r"\b(namespace|class|struct|union)\b", head.split("(")[0]) is not None or head.startswith("extern")


def is_function(head):
    if "(" not in head:
        return False
    return re.search(r"(?<![=!<>+\-*/|&^%])=(?!=)", re.sub(r"operator\s*\S+?\s*\(", "(", head).split("(")[0]) is None


def is_member_initializer(head):
    """`a{1}` in a constructor's `: a{1}, b(2) {`: a brace behind a name, where only `)`, `}` or words such as const and
    noexcept come before a body."""
    return re.search(r"\)[^:]*(?<!:):(?!:).*[\w>]\s*$", head, re.S) is not None


def skip_block(text, i):
    depth = 0
    while i < len(text):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        i += 1
        if depth == 0:
            break
    return i


def functions(text):
    """(line, lines, head) of each function with a body, lambdas left out."""
    text = blank(text)
    found, start, parentheses, i = [], 0, 0, 0
    while i < len(text):
        c = text[i]
        parentheses += {"(": 1, ")": -1}.get(c, 0)
        head = text[start:i].strip()
        if c == "{" and (parentheses > 0 or is_member_initializer(head)):
            i = skip_block(text, i)
            continue
        if c == "{" and not (is_scope(head) and not is_member_initializer(head)):
            end = skip_block(text, i)
            if is_function(head):
                first = start + len(text[start:i]) - len(text[start:i].lstrip())
                line = text.count("\n", 0, first) + 1
                found.append((line, text.count("\n", first, end) + 1, " ".join(head.split())))
                start = end
            i = end
            continue
        if c in "{};" and parentheses == 0:
            start = i + 1
        elif c == ":" and re.search(r"^(public|private|protected)$", head):
            start = i + 1
        i += 1
    return found


def quantile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


def measure(paths):
    """Lines of all functions, as (lines, path, line, name), and of all files, as (lines, path)."""
    all_functions, files = [], []
    for path in paths:
        text = path.read_text(encoding="utf-8")
        files.append((text.count("\n"), path))
        for line, lines, head in functions(text):
            name = re.search(r"([\w:~]+|operator\s*\S+?)\s*\(", head)
            all_functions.append((lines, path, line, name.group(1) if name else head))
    return all_functions, files


def problems(paths, root):
    """(path, line, text) of what is over the limits. `paths`: all sources but tests."""
    all_functions, files = measure(paths)
    found, open_now = [], set()

    def over(file, path, line, text):
        name = file.relative_to(root).as_posix()
        open_now.add(name)
        if name not in STILL_OPEN:
            found.append((path, line, text))

    for lines, path, line, name in all_functions:
        if lines > MOST_FUNCTION_LINES:
            over(path, path, line, f"{name}() has {lines} lines: at most {MOST_FUNCTION_LINES}")
    p99 = quantile([f[0] for f in all_functions], 0.99)
    if p99 > MOST_FUNCTION_LINES_P99:
        _, path, line, _ = max(all_functions, key=lambda f: f[0])
        found.append((path, line, f"one function in a hundred has {p99} lines or more: {MOST_FUNCTION_LINES_P99} at most"))
    p90 = quantile([f[0] for f in files], 0.9)
    if p90 > MOST_FILE_LINES_P90:
        found.append((max(files)[1], 1, f"one file in ten has {p90} lines or more: {MOST_FILE_LINES_P90} at most"))
    for lines, path in files:
        test = path.with_name(path.stem + "_test.cpp")
        is_long = path.suffix == ".cpp" and lines > LONGEST_WITHOUT_TEST and root / "engine" in path.parents
        if is_long and not path.stem.endswith("_reference") and not test.is_file():
            over(test, path, 1, f"has {lines} lines and no {test.name} beside it")
    for name in sorted(STILL_OPEN - open_now):
        found.append((pathlib.Path(__file__).resolve(), 1, f"{name} is within the limits: it is not open any more"))
    return found


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    paths = [p for part in ("include", "engine", "io", "tools", "program") for p in sorted((root / part).rglob("*"))
             if p.suffix in (".h", ".cpp") and not p.stem.endswith("_test") and not p.stem.startswith("test_")]
    all_functions, files = measure(paths)
    for what, rows in (("functions", all_functions), ("files", files)):
        lines = [r[0] for r in rows]
        print(f"{len(rows)} {what}, lines: median {quantile(lines, 0.5)}, p90 {quantile(lines, 0.9)}, "
              f"p99 {quantile(lines, 0.99)}, most {max(lines)}")
        for row in sorted(rows, key=lambda r: -r[0])[:12]:
            print("  ", row[0], row[1].relative_to(root), *row[2:])
    for path, line, text in problems(paths, root):
        print(f"{path.relative_to(root)}:{line}: {text}")


if __name__ == "__main__":
    main()
