#!/usr/bin/env bash
# Feeds arbitrary bytes to the parsers: builds the targets of fuzz/ with libFuzzer (Clang) and runs one after the other.
#
#   scripts/fuzz.sh [--seconds N] [--runs N] [--corpus DIR] [--no-build] [TARGET...]
#     --seconds N   for each target (default: 60)
#     --runs N      at most so many executions of each (default: as many as the time allows)
#     --corpus DIR  where inputs that reach new code are kept, a folder each target (default: out/fuzz/corpus); a later
#                   run begins with them
#     --no-build    the targets are there already
#     TARGET        as the files in fuzz/ are called; all if none is named
# An input that a target does not survive is saved in out/fuzz/findings/TARGET, the output in out/fuzz/TARGET.log. The
# exit code is 1 if there was one. To see it again: build/clang/fuzz/fuzz_TARGET FILE.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/build_tools.sh

usage() { sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit "$1"; }
seconds=60 runs=-1 corpus=out/fuzz/corpus must_build=1
targets=()
while (($# > 0)); do
  case $1 in
    --seconds) seconds=${2:?--seconds takes a number}; shift 2 ;;
    --runs) runs=${2:?--runs takes a number}; shift 2 ;;
    --corpus) corpus=${2:?--corpus takes a folder}; shift 2 ;;
    --no-build) must_build=0; shift ;;
    -h | --help) usage 0 ;;
    -*) usage 1 ;;
    *) targets+=("$1"); shift ;;
  esac
done

if ((must_build)); then configure clang; fi
# Those that can be built here: without Node there is no server.
if ((${#targets[@]} == 0)); then mapfile -t targets <build/clang/fuzz/targets.txt; fi
if ((must_build)); then build clang --target "${targets[@]/#/fuzz_}"; fi

# Nothing that is tried needs more memory than this (MB): what takes more believes what a file says of itself.
memory=(-malloc_limit_mb=256 -rss_limit_mb=2560)
export OPENCV_LOG_LEVEL=SILENT OPENCV_FFMPEG_LOGLEVEL=-8
export ASAN_OPTIONS=${ASAN_OPTIONS:-quarantine_size_mb=16}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1:halt_on_error=1}

# fuzz TARGET: prints a line about it; fails if it found something.
fuzz() {
  local name=$1 log=out/fuzz/$1.log options=("${memory[@]}" -timeout=20 -close_fd_mask=1 -print_funcs=0)
  mkdir -p "$corpus/$name" "out/fuzz/findings/$name"
  [[ -f fuzz/$name.dict ]] && options+=("-dict=fuzz/$name.dict")
  local status=0
  "build/clang/fuzz/fuzz_$name" "${options[@]}" -max_total_time="$seconds" -runs="$runs" -print_final_stats=1 \
    -artifact_prefix="out/fuzz/findings/$name/" "$corpus/$name" "fuzz/seeds/$name" >"$log" 2>&1 || status=$?
  printf '%-16s %12s executions, %6s/s%s\n' "$name" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
    "$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")" \
    "$( ((status == 0)) || echo ": FINDING, see $log")"
  return "$((status != 0))"
}

failed=0
for target in "${targets[@]}"; do
  fuzz "$target" || failed=1
done
exit "$failed"
