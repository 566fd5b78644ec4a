#!/usr/bin/env bash
# tidy.sh [--changed [BASE] | FILES...]: clang-tidy 14 with the rules of .clang-tidy.
#
# Without arguments: all sources, many at a time (scripts/tidy_batches.py; half an hour on a core). FILES: one by one.
# --changed: those that differ from BASE (default: HEAD) and those that include a header that does. LDSO_TIDY_BUILD names
# a configured build folder (default: build/release; bench/ is looked at if it is part of that build).
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "tidy.sh: $*" >&2; exit 2; }
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || fail "install clang-tidy-14 first (scripts/packages.txt)"
[[ $("$tidy" --version) == *'version 14.'* ]] || echo "tidy.sh: the rules are written for version 14" >&2
build=${LDSO_TIDY_BUILD:-build/release}
if [[ ! -f $build/compile_commands.json ]]; then
  [[ $build == build/release ]] || fail "$build/compile_commands.json is missing: configure that folder first"
  cmake --preset release
fi

files=()
if [[ ${1:-} == --changed ]]; then
  mapfile -t changed < <({ git diff --name-only --diff-filter=d "${2:-HEAD}"; git ls-files -o --exclude-standard; } |
    grep -E '^(engine|io|tools|program|include|bench)/.*\.(h|cpp)$' | sort -u)
  headers=()
  for file in "${changed[@]}"; do
    case $file in
      *.cpp) files+=("$file") ;;
      io/*.h) headers+=(-e "#include \"$file\"") ;;
      *.h) headers+=(-e "#include \"${file#*/}\"") ;;
    esac
  done
  if ((${#headers[@]} > 0)); then
    mapfile -t including < <(grep -rlF --include='*.cpp' "${headers[@]}" engine io tools program bench)
    files+=("${including[@]}")
  fi
  mapfile -t files < <(printf '%s\n' "${files[@]}" | sort -u | sed '/^$/d')
elif (($# > 0)); then
  files=("$@")
else
  exec python3 scripts/tidy_batches.py "$build"
fi

failed=0
checked=0
for file in "${files[@]}"; do
  if ! grep -q "/$file\"" "$build/compile_commands.json"; then
    echo "$file is not part of the build in $build: skipped"
    continue
  fi
  checked=$((checked + 1))
  if ! output=$("$tidy" -p "$build" --quiet "$file" 2>/dev/null); then
    echo "$output"
    failed=$((failed + 1))
  fi
done
echo "clang-tidy: $checked files, $failed with findings"
((failed == 0))
