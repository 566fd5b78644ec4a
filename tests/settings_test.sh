#!/usr/bin/env bash
# settings_test.sh PROGRAM SEQUENCE WORK DOCS: what `ldso settings` prints can be set by its name, on the command line and
# in a file; docs/settings.md is what the program prints; docs/input-output.md tells all that run.json says.
LDSO=$1 SEQUENCE=$2 WORK=$3/settings DOCS=$4
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"

expect_exit 0 settings
expect_output '^  window\.iterations  +6  +whole, 1 to 100  +[A-Z].*\.$'
expect_output '^  selection\.strategy  +corners  +corners, gradient or random '
expect_output 'ldso settings --expert$'
! grep -q 'loops\.graph' "$WORK/log" || fail "settings for experts are shown to everyone"
expect_exit 0 settings --expert
expect_output '^loops\.graph: '
expect_output '^  loops\.graph\.kernel  +8  +at least 0\.001 '
expect_output '^  selection\.corner_radius  +5  +whole, 1 to 100 px '

"$LDSO" settings --markdown >"$WORK/settings.md"
diff "$DOCS/settings.md" "$WORK/settings.md" >"$WORK/log" ||
  fail "docs/settings.md is not what the program prints: ldso settings --markdown >docs/settings.md"

# Every setting: its default is taken, by name and by file, and a run's run.json has all of them.
"$LDSO" settings --expert --json >"$WORK/settings.json"
python3 - "$WORK/settings.json" "$WORK/all.yaml" "$WORK/changed.yaml" "$WORK/arguments" <<'PY'
import json, sys
settings = json.load(open(sys.argv[1]))
assert len(settings) > 100
text = lambda value: {True: "true", False: "false"}.get(value, value) if isinstance(value, bool) else value
def nested(pairs):
    groups = {}
    for key, value in pairs:
        group = groups
        *way, name = key.split(".")
        for step in way:
            group = group.setdefault(step, {})
        group[name] = value
    return groups
json.dump(nested((k, s["default"]) for k, s in settings.items()), open(sys.argv[2], "w"), indent=1)
changed = {"loops.graph.kernel": 9.5, "loops.matching.max_ratio": 0.75, "loops.confirmation.gap": 5}
assert all(settings[k]["default"] != v for k, v in changed.items())
json.dump(nested(changed.items()), open(sys.argv[3], "w"), indent=1)
open(sys.argv[4], "w").writelines(f"--set\n{k}={text(s['default'])}\n" for k, s in settings.items())
PY
mapfile -t arguments <"$WORK/arguments"
expect_exit 0 run "$SEQUENCE" -o "$WORK/all" --no-report --end 20 --config "$WORK/all.yaml" "${arguments[@]}"
expect_exit 0 run "$SEQUENCE" -o "$WORK/plain" --no-report --end 20
cmp "$WORK/all/trajectory.txt" "$WORK/plain/trajectory.txt" || fail "defaults that are given change the result"
expect_exit 0 run "$SEQUENCE" -o "$WORK/changed" --no-report --end 20 --config "$WORK/changed.yaml" \
  --set loops.matching.max_ratio=0.7
python3 - "$WORK" <<'PY'
import json, sys
work = sys.argv[1]
load = lambda name: json.load(open(f"{work}/{name}"))
def flat(group, prefix=""):
    for name, value in group.items():
        yield from flat(value, prefix + name + ".") if isinstance(value, dict) else [(prefix + name, value)]
defaults = {k: s["default"] for k, s in load("settings.json").items()}
plain = dict(flat(load("plain/run.json")["settings"]))
assert plain == defaults, set(plain.items()) ^ set(defaults.items())
changed = dict(flat(load("changed/run.json")["settings"]))
different = {k: v for k, v in changed.items() if v != defaults[k]}
assert different == {"loops.graph.kernel": 9.5, "loops.matching.max_ratio": 0.7, "loops.confirmation.gap": 5}, different
PY

# The table of run.json in the docs has every key that a run writes, and no other.
python3 - "$WORK/plain/run.json" "$DOCS/input-output.md" <<'PY'
import json, re, sys
written = set(json.load(open(sys.argv[1])))
rows = re.search(r"\| key \| what \|\n\|---\|---\|\n((?:\|.*\n)+)", open(sys.argv[2]).read()).group(1)
told = {key for row in rows.splitlines() for key in re.findall(r"`(\w+)`", row.split("|")[1])}
if_corrected = {"evaluation_odometry", "loop_variance_factors"}
assert written | if_corrected == told, (written | if_corrected) ^ told
PY

# Errors name file, line, range, unit, and the nearest name.
printf 'loops:\n  matching:\n    max_distance: 300\n' >"$WORK/bad.yaml"
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --config "$WORK/bad.yaml"
expect_output 'bad\.yaml:3: loops\.matching\.max_distance: 300 is out of range; allowed is 0 to 256 bits'
printf 'loops:\n  grahp:\n    kernel: 3\n' >"$WORK/bad.yaml"
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --config "$WORK/bad.yaml"
expect_output "bad\.yaml:[23]: unknown setting 'loops\.grahp'; did you mean 'loops\.graph'"
expect_exit 1 run "$SEQUENCE" -o "$WORK/out" --set kernel=3
expect_output "did you mean 'loops\.graph\.kernel'"
expect_exit 1 settings --expret
expect_output 'did you mean --expert'
[[ ! -e $WORK/out ]] || fail "refused settings have made the output folder"
