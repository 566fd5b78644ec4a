#!/usr/bin/env bash
# report_test.sh PROGRAM SEQUENCE WORK HAS_VIEWER: every run leaves a report, whatever became of it, unless told not to.
LDSO=$1 SEQUENCE=$2 WORK=$3/report_command_line HAS_VIEWER=$4
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
report=$WORK/out/report.html

# expect_report PATTERN: the report contains the extended regular expression.
expect_report() { grep -Eq -- "$1" "$report" || fail "the report does not contain '$1'"; }

expect_exit 0 run "$SEQUENCE" -o "$WORK/out" --quiet --set selection.candidates=1400
expect_report 'class="chip good">complete<'
expect_report '>ATE \(rmse\)<'
expect_report 'selection.candidates</td><td class="left">1400</td>'
expect_report 'keyframe/optimize'
if [[ $HAS_VIEWER == ON ]]; then
  expect_report 'id="recording">[A-Za-z0-9+/]{1000}'
else
  expect_report 'was built without its viewer'
fi
if grep -Eq '(src|href)="?(https?:)?//' "$report"; then fail "the report asks others for something"; fi

# What cannot be read is said to be so.
copy_sequence "$SEQUENCE" "$WORK/damaged"
: >"$(own_image "$WORK/damaged" 30)"
expect_exit 0 run "$WORK/damaged" -o "$WORK/out" --quiet
expect_report '<td>30</td><td>30</td><td>1</td><td class="left">skipped: .*the image file is empty'
expect_report '<li>frame 30 is skipped'

expect_exit 2 run "$SEQUENCE" -o "$WORK/out" --end 3 --quiet
expect_report 'class="chip bad">nothing tracked<'
expect_report 'No frame could be tracked'

expect_exit 0 run "$SEQUENCE" -o "$WORK/out" --end 20 --no-report --quiet
[[ ! -e $report ]] || fail "--no-report left the report of another run"
