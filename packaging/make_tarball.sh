#!/usr/bin/env bash
# make_tarball.sh BUILD-FOLDER FOLDER: ldso-VERSION-MACHINE.tar.gz, the program with all libraries that it is linked with
# but those of the C library: it runs from wherever it is unpacked, on every Linux whose C library is not older.
set -euo pipefail
export LC_ALL=C
build=$1 folder=$2
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=ldso-$version-$(uname -m)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree=$work/$name

cmake --install "$build" --prefix "$tree" --component program --strip >/dev/null
mkdir -p "$tree/lib"
cp LICENSE README.md CHANGELOG.md "$tree/"

# What belongs to the C library has to be that of the running kernel's system.
c_library='/(ld-linux[^/]*|lib(c|m|mvec|dl|rt|pthread|resolv|util|nsl|anl|BrokenLocale|thread_db|nss_[a-z]+))\.so[^/]*$'
ldd "$tree/bin/ldso" | awk '$3 ~ /^\// { print $3 }' | grep -Ev "$c_library" >"$work/libraries"
if ldd "$tree/bin/ldso" | grep -q 'not found'; then echo "make_tarball.sh: libraries are missing" >&2; exit 1; fi
while read -r library; do
  cp -L "$library" "$tree/lib/"
  # Whose they are, and under which terms: a licence for each Debian package they come from.
  owner=$(dpkg-query -S "$(realpath "$library")" 2>/dev/null | sed 's/:.*//;q') || true
  [[ -z $owner || ! -r /usr/share/doc/$owner/copyright ]] || cp -L "/usr/share/doc/$owner/copyright" "$work/$owner.copyright"
done <"$work/libraries"
mkdir -p "$tree/licences"
mv "$work"/*.copyright "$tree/licences/"

# RPATH, not RUNPATH: it holds for the libraries' libraries as well.
patchelf --force-rpath --set-rpath '$ORIGIN/../lib' "$tree/bin/ldso"
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-0}" -c "$name" |
  gzip -6n >"$folder/$name.tar.gz"
