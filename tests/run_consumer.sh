#!/usr/bin/env bash
# run_consumer.sh BUILD-FOLDER WORK COMPILER: installs the built library, builds the project in consumer/ with it as any
# other project would, and runs that.
set -euo pipefail
build=$1 work=$2/consumer compiler=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$work" && mkdir -p "$work"

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
# Only the public headers are there, and they include nothing else of the project.
[[ ! -e $work/prefix/include/odometry ]]
if grep -rhoE '#include "[^"]+"' "$work/prefix/include" | grep -v '"ldso/'; then
  echo "FAILED: public headers include private ones" >&2
  exit 1
fi

# A machine with Ninja alone has no make, which CMake would take by itself.
generator=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$build/CMakeCache.txt")
cmake -G "$generator" -S "$here/consumer" -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" "${@:4}"
cmake --build "$work/build"
"$work/build/consumer"
