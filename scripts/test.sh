#!/usr/bin/env bash
# Builds everything and runs all tests: those of the rooms, whole sequences end to end, and the checks of the sources.
#
#   scripts/test.sh [--preset P] [--rooms "NAMES"] [--short] [--build-only] [options for ctest, e.g. -R image]
#     --preset P      release (the default), debug, ci: warnings are errors, asan: address and undefined-behaviour
#                     sanitizer, clang: both of it by Clang, tsan, clang-tsan: thread sanitizer
#     --rooms "NAMES" only the tests of these rooms, e.g. "util io"; nothing else is built
#     --short         without the tests that take long: whole sequences with bounds on accuracy, browsers
#     --build-only    builds and runs nothing
# The last lines are ctest's: how many tests passed and which failed.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/build_tools.sh

usage() { sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit "$1"; }
preset=release
rooms=
ctest_options=()
build_only=0
while (($# > 0)); do
  case $1 in
    --preset) preset=${2:?--preset takes a name}; shift 2 ;;
    --build-only) build_only=1; shift ;;
    --short) ctest_options+=(-LE long); shift ;;
    --rooms) rooms=${2:?--rooms takes names}; shift 2 ;;
    -h | --help) usage 0 ;;
    *) ctest_options+=("$1"); shift ;;
  esac
done

targets=()
if [[ -n $rooms ]]; then
  read -ra names <<<"$rooms"
  targets=(--target "${names[@]/%/_test}")
  ctest_options+=(-R "^($(tr ' ' '|' <<<"${names[*]}"))/")
fi

scripts/install_packages.sh build python test
install_node
configure "$preset"
build "$preset" "${targets[@]}"
if ((build_only)); then exit 0; fi

# Sanitizers: stop at the first report, and keep the thread sanitizer's shadow memory clear of randomized addresses.
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1:halt_on_error=1}
export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1:second_deadlock_stack=1:suppressions=\"$PWD/scripts/tsan.supp\"}
wrapper=()
if [[ $preset == *tsan ]] && setarch "$(uname -m)" -R true 2>/dev/null; then
  wrapper=(setarch "$(uname -m)" -R)
fi
exec "${wrapper[@]}" ctest --test-dir "build/$preset" --parallel "${LDSO_TEST_JOBS:-2}" --output-on-failure \
  --no-tests=error "${ctest_options[@]}"
