#!/usr/bin/env bash
# Makes the Debian packages libldso1, libldso-dev, ldso and python3-ldso, and a tarball of the program that runs from any
# folder, in out/packages. On Debian 12 or Ubuntu 24.04; they are for the system that they were made on.
#
#   scripts/package.sh [--try] [-DCMAKE_OPTION=...]...
#     --try  then installs and uses them in a new, minimal Debian 12 (scripts/try_packages.sh)
# lintian judges the packages if it is there; what it may say is listed in packaging/lintian.txt with the reason.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/build_tools.sh

usage() { sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit "$1"; }
must_try=0
options=()
while (($# > 0)); do
  case $1 in
    --try) must_try=1; shift ;;
    -h | --help) usage 0 ;;
    -D*) options+=("$1"); shift ;;
    *) echo "package.sh: unknown option $1" >&2; usage 2 >&2 ;;
  esac
done
step() { printf '\n== %s\n' "$*"; }
build=build/package packages=$PWD/out/packages
# The same sources give the same dates in the packages. The compiler is not told, lest ccache forget all it knows.
date=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)}

step "Building"
scripts/install_packages.sh build python package
install_node
# The system's own Python: the module is for no other.
SOURCE_DATE_EPOCH=$date configure release -B "$build" -DCMAKE_INSTALL_PREFIX=/usr -DLDSO_PACKAGES=ON -DLDSO_BUILD_TESTS=OFF \
  -DPython_EXECUTABLE=/usr/bin/python3 "${options[@]}"
cmake --build "$build" --parallel "$(build_jobs)"

step "Packages"
rm -rf "$packages" && mkdir -p "$packages"
export SOURCE_DATE_EPOCH=$date
(cd "$build" && cpack -G DEB -B "$packages") >"$packages/cpack.log" 2>&1 || { cat "$packages/cpack.log"; exit 1; }
rm -rf "$packages/_CPack_Packages"
packaging/make_tarball.sh "$build" "$packages"
ls -lh "$packages"/*.deb "$packages"/*.tar.gz

step "lintian"
if ! command -v lintian >/dev/null; then
  echo "not installed: left out"
else
  as_user=()
  if ((EUID == 0)); then as_user=(--allow-root); fi
  lintian "${as_user[@]}" --tag-display-limit 0 --fail-on none "$packages"/*.deb >"$packages/lintian.log" 2>&1 ||
    { cat "$packages/lintian.log"; exit 1; }
  if grep -E '^[EW]:' "$packages/lintian.log" | grep -Evf <(grep -Ev '^(#|$)' packaging/lintian.txt); then
    echo "package.sh: lintian says what packaging/lintian.txt does not know" >&2
    exit 1
  fi
  echo "$(grep -cE '^[EW]:' "$packages/lintian.log" || true) remarks, all of them exceptions of packaging/lintian.txt"
fi

if ((must_try)); then
  step "A new Debian 12"
  scripts/try_packages.sh "$packages"
fi
