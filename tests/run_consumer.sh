#!/usr/bin/env bash
# run_consumer.sh BUILD-FOLDER WORK COMPILER OPTIONS...: installs the built library part by part, builds with it the
# projects of consumer/ (the engine alone) and consumer_io/ (its files as well) as any other project would, and runs
# them; then one that leaves results as the program does (consumer_output/). What a part does not need must neither be
# looked for nor linked.
set -euo pipefail
export LC_ALL=C
build=$1 work=$2/consumer compiler=$3
options=("${@:4}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$work" && mkdir -p "$work"
# A machine with Ninja alone has no make, which CMake would take by itself.
generator=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$build/CMakeCache.txt")

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# configure SOURCE BUILD OPTIONS...
configure() {
  cmake --no-warn-unused-cli -G "$generator" -S "$1" -B "$2" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_COMPILER="$compiler" "${@:3}"
}

# A machine without what only files and the program need: pkg-config and find_package do not find it.
cat >"$work/pkg-config" <<'SCRIPT'
#!/bin/sh
case "$*" in *libzip* | *liblz4* | *sqlite3* | *libzstd*) exit 1 ;; esac
exec pkg-config "$@"
SCRIPT
chmod +x "$work/pkg-config"
without=(-DPKG_CONFIG_EXECUTABLE="$work/pkg-config")
for package in yaml-cpp nlohmann_json BZip2 Boost CLI11 GTest benchmark; do
  without+=(-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON)
done
# What the engine must not be linked with, even by way of others.
foreign='opencv_(imgcodecs|videoio|highgui)|yaml|libzip|lz4|sqlite|zstd|bz2|boost|libav'
# What it is linked with: the standard library, Highway, the parts of OpenCV (features2d brings flann), and Ceres with
# what that brings (its log, sparse and dense linear algebra).
standard='stdc\+\+|m|gcc_s|c|pthread|[aut]san|ubsan'
ceres='ceres|glog|gflags|cholmod|cxsparse|spqr|suitesparseconfig|c?c?amd|c?colamd|metis'
ceres+='|lapack|(f77)?blas|openblas|atlas|gomp|tbb'
known="^(lib($standard|hwy|opencv_(core|imgproc|features2d|flann)|$ceres)\.so.*|ld-linux.*)$"

# The engine.
cmake --install "$build" --prefix "$work/engine" --component engine >"$work/install.log"
[[ ! -e $work/engine/bin && ! -e $work/engine/include/ldso/io && ! -e $work/engine/include/odometry ]] ||
  fail "the engine brings more than itself"
configure "$here/consumer" "$work/engine_build" -DCMAKE_PREFIX_PATH="$work/engine" "${without[@]}" "${options[@]}"
cmake --build "$work/engine_build" --verbose | tee "$work/engine_build.log"
grep -E -- '-o consumer( |$)' "$work/engine_build.log" >"$work/link_line" || fail "there is no link line"
if grep -E "$foreign" "$work/link_line"; then fail "these are linked"; fi
readelf -d "$work/engine_build/consumer" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' >"$work/needed"
if grep -Ev "$known" "$work/needed"; then fail "these libraries are linked with the engine"; fi
if ldd "$work/engine_build/consumer" | grep -E "$foreign"; then fail "these libraries are loaded with the engine"; fi
"$work/engine_build/consumer"
if configure "$here/consumer_io" "$work/no_io" -DCMAKE_PREFIX_PATH="$work/engine" "${options[@]}" 2>"$work/log"; then
  fail "a component that is not installed was found"
fi

# With its files, which need no program either.
cp -r "$work/engine" "$work/io"
cmake --install "$build" --prefix "$work/io" --component io >>"$work/install.log"
configure "$here/consumer_io" "$work/io_build" -DCMAKE_PREFIX_PATH="$work/io" -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON \
  "${options[@]}"
cmake --build "$work/io_build"
"$work/io_build/consumer" "$work/sequence"

# All of it. Only public headers are there, and they include nothing else of the project.
cmake --install "$build" --prefix "$work/all" >>"$work/install.log"
"$work/all/bin/ldso" --version

# A project that leaves results as the program does: the same files to the bit, which the program takes.
ldso=$work/all/bin/ldso
configure "$here/consumer_output" "$work/output_build" -DCMAKE_PREFIX_PATH="$work/all" "${options[@]}"
cmake --build "$work/output_build"
"$ldso" simulate room -o "$work/room" --frames 60 --size 320x240 --seed 3
"$ldso" run "$work/room" -o "$work/by_program" --quiet
for way in all one; do
  if [[ $way == all ]]; then
    "$work/output_build/consumer" "$work/room" "$work/by_$way"
    "$ldso" export "$work/by_$way" --format colmap
  else
    "$work/output_build/consumer" "$work/room" "$work/by_$way" one
    "$ldso" export "$work/by_$way" --format colmap --images none
  fi
  for file in trajectory.txt keyframes.txt map.ply loops.json; do
    cmp "$work/by_program/$file" "$work/by_$way/$file" || fail "$file of the library ($way) is not that of the program"
  done
  [[ -s $work/by_$way/export/colmap/sparse/0/points3D.txt ]] || fail "nothing was exported of what the library left"
done

if grep -rhoE '#include "[^"]+"' "$work/all/include" | grep -v '"ldso/'; then
  fail "public headers include private ones"
fi

# The engine is configured on a machine that has no more than it needs.
configure "$here/.." "$work/engine_only" -DLDSO_BUILD_APP=OFF -DLDSO_BUILD_IO=OFF -DLDSO_BUILD_TESTS=OFF "${without[@]}" \
  "${options[@]}"
if grep -E '^(yaml-cpp|nlohmann_json|CLI11|Boost|GTest|benchmark)_DIR|^(pkgcfg_lib_)?LibZip|^LDSO_N(ODE|PM)' \
  "$work/engine_only/CMakeCache.txt"; then
  fail "the engine alone looks for these"
fi
