#!/usr/bin/env bash
# Makes the documentation site of docs/ and the comments of the interfaces, in out/docs; it is read without a network.
#
#   scripts/docs.sh [--build FOLDER]
#     --build FOLDER  take program and Python module of this build folder instead of building them (build/release)
set -euo pipefail
export LC_ALL=C.UTF-8
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/build_tools.sh

fail() { echo "docs.sh: $*" >&2; exit 1; }
usage() { sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit "$1"; }
build=
while (($# > 0)); do
  case $1 in
    --build) build=${2:?--build takes a folder}; shift 2 ;;
    -h | --help) usage 0 ;;
    *) echo "docs.sh: unknown option $1" >&2; usage 2 >&2 ;;
  esac
done
step() { printf '\n== %s\n' "$*"; }
work=build/docs site=out/docs

scripts/install_packages.sh docs
if [[ -z $build ]]; then
  step "Building program and module"
  scripts/install_packages.sh build python
  install_node
  configure release
  build release --target ldso_app ldso_python
  build=build/release
fi
ldso=$build/ldso
[[ -x $ldso ]] || fail "$ldso: there is no program"
# Sphinx imports the module to read its docstrings: by the Python that Sphinx itself runs on.
python=/usr/bin/python3
PYTHONPATH=$build/python "$python" -c 'import ldso' || fail "$python cannot import the module of $build/python"

step "Sources"
# Laid out as in the repository, so that the pages' links to each other hold.
rm -rf "$work" && mkdir -p "$work/sources" "$work/doxygen"
pages=$PWD/$work/sources
git ls-files -co --exclude-standard -- '*.md' | grep -v '^docs/site/' | while read -r page; do
  install -D -m 644 "$page" "$pages/$page"
done
cp -r docs/pictures "$pages/docs/"
cp LICENSE CITATION.cff "$pages/"
cp -r docs/site/. "$pages/"
rm "$pages"/Doxyfile* "$pages"/comment_filter.py

# What each command says of itself.
{
  printf '# Commands\n\nAs `ldso COMMAND --help` prints them.\n'
  "$ldso" --help | awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { print $1 }' | while read -r command; do
    printf '\n## ldso %s\n\n```text\n' "$command"
    "$ldso" "$command" --help
    printf '```\n'
  done
} >"$pages/docs/commands.md"

step "Comments of the headers"
for part in Doxyfile Doxyfile_c; do
  (cat "docs/site/$part" && echo "OUTPUT_DIRECTORY = $work/doxygen/$part") | doxygen - 2>&1 | tee -a "$work/doxygen.log"
  mkdir -p "$work/doxygen/$part"
done

step "Pages"
rm -rf "$site"
LDSO_SOURCES=$PWD LDSO_DOXYGEN=$PWD/$work/doxygen/Doxyfile/xml LDSO_DOXYGEN_C=$PWD/$work/doxygen/Doxyfile_c/xml \
  PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1 \
  "$python" -m sphinx -q -W --keep-going -b html -j "$(build_jobs)" -d "$work/doctrees" "$pages" "$site"
"$python" scripts/check_docs.py --site "$site"
echo "the site: $(realpath "$site")/index.html"
