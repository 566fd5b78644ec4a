#!/usr/bin/env bash
# make_man_pages.sh PROGRAM HELP2MAN FOLDER: ldso.1.gz and a page for each command, of what their --help says.
set -euo pipefail
export LC_ALL=C SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(date +%s)}
program=$1 help2man=$2 folder=$3
rm -rf "$folder" && mkdir -p "$folder"
version=$("$program" --version | awk '{ print $2 }')
stand_ins=$(mktemp -d)
trap 'rm -rf "$stand_ins"' EXIT

printf '[SEE ALSO]\n.BR ldso (1)\nlists the commands; a page for each is called ldso-COMMAND(1).\n' >"$stand_ins/more"

# page NAME TITLE ARGUMENTS...: help2man wants one program without arguments.
page() {
  local stand_in=$stand_ins/$1
  printf '#!/bin/sh\nexec "%s" %s "$@"\n' "$program" "${*:3}" >"$stand_in"
  chmod +x "$stand_in"
  "$help2man" --no-info --section=1 --manual="User Commands" --source="ldso $version" --name="$2" --include="$stand_ins/more" \
    --version-string="$1 $version" --output="$folder/$1.1" "$stand_in" </dev/null
  gzip -9nf "$folder/$1.1"
}

page ldso "monocular direct visual SLAM"
mapfile -t commands < <("$program" --help | awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/')
((${#commands[@]} > 0)) || { echo "make_man_pages.sh: ldso --help lists no commands" >&2; exit 1; }
for line in "${commands[@]}"; do
  read -r command title <<<"$line"
  page "ldso-$command" "${title,}" "$command"
done
