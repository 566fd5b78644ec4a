#!/usr/bin/env bash
# check_format.sh [--fix]: are all C++ sources as clang-format would have them? Version 14 decides, others format
# differently; without it the check is skipped (exit code 77).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

formatter=
for candidate in clang-format-14 clang-format; do
  if command -v "$candidate" >/dev/null && [[ $("$candidate" --version) == *'version 14.'* ]]; then
    formatter=$candidate
    break
  fi
done
if [[ -z $formatter ]]; then
  echo "clang-format 14 is not installed: skipped"
  exit 77
fi

mapfile -t files < <(find include engine io tools program python tests bench fuzz -name '*.h' -o -name '*.cpp' | sort)
if [[ ${1:-} == --fix ]]; then
  "$formatter" -i "${files[@]}"
  exit 0
fi
mapfile -t bad < <("$formatter" --dry-run "${files[@]}" 2>&1 | sed -n 's/^\([^ :]*\):[0-9:]* warning: .*/\1/p' | sort -u)
if ((${#bad[@]} > 0)); then
  printf 'not formatted: %s\n' "${bad[@]}"
  echo "scripts/check_format.sh --fix formats them"
  exit 1
fi
echo "${#files[@]} files are formatted"
