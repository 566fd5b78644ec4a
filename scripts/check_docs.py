#!/usr/bin/env python3
"""Checks the documentation: `check_docs.py` that the pages' links lead somewhere, that README leads to every page of docs/,
and that code which a page takes from a file still stands there; `--spelling` their spelling by hunspell (exit 77 without
it), with the project's own words in docs/words.txt; `--site FOLDER` the site that scripts/docs.sh made: its links, and that
it loads nothing from a network. Prints one line for each problem: file:line: what is wrong."""

import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOT_PAGES = {"build", "out", "node_modules", ".git", ".cache"}
WORDS = ROOT / "docs/words.txt"
SKIPPED = 77


def pages():
    """All Markdown pages of the project; docs/site/ holds what only the site shows."""
    for folder, names, files in os.walk(ROOT):
        names[:] = sorted(name for name in set(names) - NOT_PAGES if not name.startswith("."))
        for name in sorted(files):
            if name.endswith(".md") and pathlib.Path(folder) != ROOT / "docs/site":
                yield pathlib.Path(folder) / name


def without_code(text):
    """The text with code blanked out, so that lines keep their numbers."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group())
    text = re.sub(r"^```.*?^```", blank, text, flags=re.S | re.M)
    text = re.sub(r"(?<=\n\n) {4}[^\n]*(\n( {4}[^\n]*|[ ]*)(?=\n))*", blank, text)
    return re.sub(r"(`+).+?\1", blank, text, flags=re.S)


def anchors(text):
    """Names by which a page's headings can be linked to, as Markdown viewers make them."""
    result = set()
    for heading in re.findall(r"^#+ +(.*?) *$", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M), flags=re.M):
        result.add(re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-"))
    return result


def problem(path, line, text):
    return f"{path.relative_to(ROOT) if path.is_relative_to(ROOT) else path}:{line}: {text}"


def links(path):
    """(line, target) of each link of a page that does not leave the project."""
    text = without_code(path.read_text(encoding="utf-8"))
    for match in re.finditer(r"\]\(([^)\s]+)\)", text):
        if not re.match(r"[a-z]+:", match.group(1)):
            yield text.count("\n", 0, match.start()) + 1, match.group(1)


def check_links(path):
    for line, target in links(path):
        name, _, anchor = target.partition("#")
        linked = (path.parent / name).resolve() if name else path
        if not linked.exists():
            yield problem(path, line, f"{target}: there is no such file")
        elif anchor and anchor not in anchors(linked.read_text(encoding="utf-8")):
            yield problem(path, line, f"{target}: that page has no such heading")


def check_reach():
    """From README every page of docs/ is reached."""
    reached, waiting = set(), [ROOT / "README.md"]
    while waiting:
        path = waiting.pop()
        if path in reached:
            continue
        reached.add(path)
        for _, target in links(path):
            linked = (path.parent / target.partition("#")[0]).resolve()
            if linked.suffix == ".md" and linked.exists():
                waiting.append(linked)
    return [problem(path, 1, "no page that README leads to has a link to it")
            for path in sorted((ROOT / "docs").glob("*.md")) if path not in reached]


def check_snippets(path):
    """Code below a comment `<!-- from FILE -->` stands so in that file, apart from its indentation."""
    text = path.read_text(encoding="utf-8")
    for match in re.finditer(r"^<!-- from (\S+) -->\n```\w*\n(.*?)^```", text, flags=re.S | re.M):
        line = text.count("\n", 0, match.start()) + 1
        source = ROOT / match.group(1)
        if not source.exists():
            yield problem(path, line, f"{match.group(1)}: there is no such file")
            continue
        plain = lambda code: re.sub(r"^[ \t]+", "", code, flags=re.M)
        if plain(match.group(2)) not in plain(source.read_text(encoding="utf-8")):
            yield problem(path, line, f"this code does not stand in {match.group(1)}")


def prose(path):
    """What a person reads: no code, no addresses, no names of files."""
    text = without_code(path.read_text(encoding="utf-8"))
    text = re.sub(r"<!--.*?-->|<[^>\n]+>|https?://\S+|\]\([^)]*\)|arXiv:\S+", " ", text, flags=re.S)
    # Names in code and of files, and numbers with their units, are no words.
    return re.sub(r"\S*[_/\\=]\S*|[\w-]+\.(?:md|cff|cpp|h|txt|json|yaml|png|csv)\b|\b\d[\w.]*|['’]s\b", " ", text)


def check_spelling():
    if shutil.which("hunspell") is None:
        print("skipped: hunspell is not installed (scripts/install_packages.sh spelling)")
        return SKIPPED
    dictionary = subprocess.run(["hunspell", "-d", "en_GB", "-l"], input="", capture_output=True, text=True)
    if dictionary.returncode != 0:
        print("skipped: hunspell has no dictionary en_GB (scripts/install_packages.sh spelling)")
        return SKIPPED
    known = {line.split("#")[0].strip() for line in WORDS.read_text(encoding="utf-8").splitlines()} - {""}
    problems = []
    for path in pages():
        text = prose(path)
        answer = subprocess.run(["hunspell", "-i", "utf-8", "-d", "en_GB", "-l"], input=text, capture_output=True, text=True,
                                check=True)
        for word in sorted(set(answer.stdout.split())):
            if word not in known and word.lower() not in known:
                line = next(number for number, content in enumerate(text.split("\n"), 1) if word in content)
                problems.append(problem(path, line, f"{word}: a wrong word, or one for docs/words.txt"))
    return problems


class Page(html.parser.HTMLParser):
    """Links, names and loaded files of a page of the site."""

    def __init__(self, path):
        super().__init__()
        self.links, self.names, self.loaded = [], set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        line = self.getpos()[0]
        self.names |= {attributes.get("id"), attributes.get("name")} - {None}
        if tag == "a" and attributes.get("href"):
            self.links.append((line, attributes["href"]))
        loaded = attributes.get("src") or (tag == "link" and attributes.get("rel") != "canonical" and attributes.get("href"))
        if loaded:
            self.loaded.append((line, loaded))


def check_site(folder):
    read = {path: Page(path) for path in sorted(folder.rglob("*.html"))}
    problems = [] if read else [f"{folder}: there is no site"]
    for path, page in read.items():
        for line, target in page.loaded:
            if re.match(r"(https?:)?//", target):
                problems.append(problem(path, line, f"{target} is loaded from a network"))
        for line, target in page.links + page.loaded:
            name, _, anchor = urllib.parse.unquote(target).partition("#")
            if re.match(r"[a-z]+:|//", target):
                continue
            linked = (path.parent / name.partition("?")[0]).resolve() if name else path
            if not linked.exists():
                problems.append(problem(path, line, f"{target}: there is no such file"))
            elif anchor and linked in read and anchor not in read[linked].names:
                problems.append(problem(path, line, f"{target}: that page has no such place"))
    for style in folder.rglob("*.css"):
        if re.search(r"url\(['\"]?(https?:)?//|@import ['\"](https?:)?//", style.read_text(encoding="utf-8")):
            problems.append(problem(style, 1, "something is loaded from a network"))
    return problems


def main(arguments):
    if arguments[:1] == ["--spelling"]:
        problems = check_spelling()
    elif arguments[:1] == ["--site"]:
        problems = check_site(pathlib.Path(arguments[1]).resolve())
    else:
        problems = [found for path in pages() for check in (check_links, check_snippets) for found in check(path)] + check_reach()
    if problems == SKIPPED:
        return SKIPPED
    print("\n".join(problems) if problems else "nothing is wrong")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
