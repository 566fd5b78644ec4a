#!/usr/bin/env bash
# command_line_test.sh PROGRAM SEQUENCE WORK: commands, options and settings that nobody knows, or with bad values, get a
# message with the nearest name.
LDSO=$1 SEQUENCE=$2 WORK=$3/command_line
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

expect_exit 0 --version
expect_output '^ldso [0-9]+\.[0-9]+\.[0-9]+'
expect_exit 0 --help
expect_output 'run'
expect_exit 0 run --help
expect_output '--stride'

expect_exit 1
expect_output '^error: '
expect_exit 1 rnu "$SEQUENCE"
expect_output '^error: unknown command rnu; did you mean run\?'
expect_exit 1 --versoin
expect_output 'unknown option --versoin; did you mean --version\?'
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --strid 2
expect_output 'unknown option --strid; did you mean --stride\?'
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --revers=yes
expect_output 'did you mean --reverse\?'
expect_exit 1 run "$SEQUENCE" --output "$WORK/out"
expect_output 'unknown option --output; did you mean --out\?'
expect_exit 1 run "$SEQUENCE" another -o "$WORK/out"
expect_output 'too many arguments: another'
expect_exit 1 run "$SEQUENCE"
expect_output '^error: .*--out is required'
expect_exit 1 run -o "$WORK/out"
expect_output '^error: sequence is required'
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --stride two
expect_output '^error: .*--stride'
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --threads 0
expect_output 'setting threads: 0 is out of range; allowed is 1 to 256'

expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --set selection.strategi=random
expect_output 'selection\.strategy'
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --set selection.strategy=corner
expect_output 'corners, gradient or random'
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --set selection.candidates
expect_output 'write --set key=value'
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --set keyframes.window_max=1000
expect_output 'setting keyframes\.window_max: 1000 is out of range'
printf 'selection:\n  candidate: 800\n' >"$WORK/settings.yaml"
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --config "$WORK/settings.yaml"
expect_output 'settings\.yaml.*candidate'
[[ ! -e $WORK/out ]] || fail "a refused command line has made the output folder"
