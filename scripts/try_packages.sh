#!/usr/bin/env bash
# try_packages.sh FOLDER: installs and uses the packages of the folder in a new, minimal Debian 12, as their users would
# (packaging/use_packages.sh). The system is made by debootstrap in out/chroot, LDSO_CHROOT names another place: BASE/base,
# which is kept, and BASE/try, a copy of it that every try begins with anew. Root is needed; LDSO_DEBIAN_MIRROR names a mirror.
set -euo pipefail
export LC_ALL=C
packages=$(realpath "${1:?the folder of the packages}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
chroots=$(realpath -m "${LDSO_CHROOT:-out/chroot}")
base=$chroots/base root=$chroots/try
fail() { echo "try_packages.sh: $*" >&2; exit 1; }
((EUID == 0)) || fail "making a system and entering it takes root: sudo scripts/try_packages.sh $1"

scripts/install_packages.sh package
if [[ ! -e $base/complete ]]; then
  rm -rf "$base" && mkdir -p "$base"
  debootstrap --variant=minbase bookworm "$base" ${LDSO_DEBIAN_MIRROR:+"$LDSO_DEBIAN_MIRROR"}
  touch "$base/complete"
fi
if mountpoint -q "$root/proc"; then umount "$root/proc"; fi
rm -rf "$root"
cp -a "$base" "$root"
cp /etc/resolv.conf "$root/etc/resolv.conf"
# README's commands are typed by a person, who says yes.
echo 'APT::Get::Assume-Yes "true";' >"$root/etc/apt/apt.conf.d/90yes"

mkdir -p "$root/try/docs"
cp "$packages"/*.deb "$packages"/*.tar.gz README.md "$root/try/"
cp docs/python.md "$root/try/docs/"
cp -r packaging/use_packages.sh c/example tests/consumer tests/consumer_output "$root/try/"
mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root chroot "$root" bash /try/use_packages.sh
