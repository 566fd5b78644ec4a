#!/usr/bin/env bash
# install_packages.sh SECTION...: installs what is missing of the sections of packages.txt (build, test, viewer, ...).
#
# Does nothing, and needs neither network nor root, if everything is there. LDSO_SKIP_PACKAGES=1 skips it altogether,
# for systems that have the libraries from elsewhere.
set -euo pipefail
export LC_ALL=C

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fail() { echo "install_packages.sh: $*" >&2; exit 1; }
(($# > 0)) || fail "which sections of packages.txt? build, python, test, viewer, browser, colmap, check, package, docs or spelling"
[[ ${LDSO_SKIP_PACKAGES:-0} == 1 ]] && exit 0

# packages_of SECTION: its names, one a line.
packages_of() {
  awk -v wanted="[$1]" '{ sub(/#.*/, ""); gsub(/[ \t\r]/, "") } /^\[/ { on = $0 == wanted; next } on && NF' \
    "$here/packages.txt"
}

wanted=()
for section in "$@"; do
  mapfile -t names < <(packages_of "$section")
  ((${#names[@]} > 0)) || fail "packages.txt has no section [$section]"
  wanted+=("${names[@]}")
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_packages.sh: this is neither Debian nor Ubuntu; going on as if these packages' counterparts were" \
    "installed: ${wanted[*]}" >&2
  exit 0
fi

is_installed() { [[ $(dpkg-query -W -f='${Status}' "$1" 2>/dev/null) == "install ok installed" ]]; }
missing=()
for package in "${wanted[@]}"; do
  is_installed "$package" || missing+=("$package")
done
((${#missing[@]} > 0)) || exit 0

install_command="apt-get install -y --no-install-recommends ${missing[*]}"
echo "missing packages: ${missing[*]}"
as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null ||
    fail "installing them takes root, and there is no sudo. Run as root: $install_command"
  as_root=(sudo)
  if ! sudo -n true 2>/dev/null && [[ ! -t 0 ]]; then
    fail "sudo wants a password, but there is no terminal to ask for it. Run as root: $install_command"
  fi
fi

apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q "$@"; }
apt update || fail "the package lists cannot be updated: is there a network?"
apt install -y --no-install-recommends "${missing[@]}" ||
  fail "not everything could be installed (see above). By hand, as root: $install_command"
for package in "${missing[@]}"; do
  is_installed "$package" || fail "$package is still missing after the installation"
done
