#!/usr/bin/env bash
# experiment_test.sh PROGRAM SEQUENCE WORK: plans are run, killed and resumed, shared by two runners, printed for others.
LDSO=$1 SEQUENCE=$2 WORK=$3/experiment
rm -rf "$WORK" && mkdir -p "$WORK"
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/test_tools.sh"

data=$WORK/my\ data  # a blank, as in real life
copy_sequence "$SEQUENCE" "$data/a"
copy_sequence "$SEQUENCE" "$data/b"
copy_sequence "$SEQUENCE" "$data/broken"
echo "no camera" >"$data/broken/camera.txt"
repeat_sequence "$SEQUENCE" "$data/long" 20

plan=$WORK/plan.yaml
cat >"$plan" <<'YAML'
title: A test
strategies: corners
loops: off
directions: [forward, backward]
repetitions: 2
threads: 1
datasets:
  mono:
    root: my data
    download: nowhere
    needs: [images.zip|images, camera.txt, times.txt]
    sequences:
      - {name: a, end: 16}
      - {name: b, start: 3, end: 19}
      - {name: broken, end: 16}
YAML
jobs=12

# results OUT: the jobs that have a result.
results() { find "$1/jobs" \( -name run.json -o -name failure.json \) -printf '%P\n' | sort; }
# stamps OUT: results with inode and time, which a second run would change.
stamps() { find "$1/jobs" \( -name run.json -o -name failure.json \) -printf '%P %i %T@\n' | sort; }
# wait_for SECONDS CONDITION...
wait_for() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < end)) || return 1
    sleep 0.05
  done
}
has_results() { [[ -d $1/jobs ]] && (($(results "$1" | wc -l) >= $2)); }
# job_of PID: a process that the runner has started.
job_of() {
  python3 - "$1" <<'PY'
import glob, sys
for path in glob.glob("/proc/[0-9]*/stat"):
    try:
        fields = open(path).read().rsplit(")", 1)[1].split()
    except OSError:
        continue
    if fields[1] == sys.argv[1] and fields[0] != "Z":
        print(path.split("/")[2])
PY
}
has_job() { [[ -n $(job_of "$1") ]]; }

echo "-- a killed runner: its jobs die with it, the next one runs what is missing"
out=$WORK/out
"$LDSO" experiment "$plan" -o "$out" --jobs 1 >"$WORK/log" 2>&1 &
runner=$!
wait_for 60 has_results "$out" 3 || fail "no three jobs in a minute"
wait_for 20 has_job "$runner" || true
job=$(job_of "$runner")
kill -s KILL "$runner"
wait "$runner" 2>/dev/null || true
[[ -z $job ]] || wait_for 5 test ! -d "/proc/$job" || fail "a job outlived its runner"
before=$(stamps "$out")
kept=$(wc -l <<<"$before")
((kept < jobs)) || fail "the runner was killed too late to test anything"
expect_exit 0 experiment run "$plan" -o "$out"
expect_output "^finished       8 jobs, 4 failed"
expect_output "^run here       $((jobs - kept))\$"
expect_output 'broken/corners_no_loops/forward_0: failed: .*camera.txt'
[[ $(results "$out" | wc -l) == "$jobs" ]] || fail "not every job has a result"
after=$(stamps "$out")
[[ -z $(comm -23 <(echo "$before") <(echo "$after")) ]] || fail "a finished job was run again"

echo "-- failures are results"
failure=$out/jobs/broken/corners_no_loops/forward_0
expect_json "$failure/failure.json" "['exit_code']" 1
expect_json "$failure/failure.json" "['signal']" None
[[ $(json "$failure/failure.json" "['reason']") == *camera.txt* ]] || fail "failure.json does not say why"
grep -q '^error: ' "$failure/log.txt" || fail "log.txt lacks the error"
expect_json "$failure/job.json" "['sequence']" broken
[[ ! -e $failure/run.json ]] || fail "a failed job has a run.json"
expect_exit 0 experiment status "$out"
expect_output '^a +4 +0 +0 +0$'
expect_output '^broken +0 +4 +0 +0$'
expect_output '^all +8 +4 +0 +0$'
expect_exit 0 experiment run "$plan" -o "$out"
expect_output '^run here       0$'
[[ $(stamps "$out") == "$after" ]] || fail "something was run again"
expect_exit 0 experiment run "$plan" -o "$out" --retry-failed --only 'broken/*forward_0'
expect_output '^run here       1$'

echo "-- repetitions and directions differ"
expect_json "$out/jobs/b/corners_no_loops/forward_1/run.json" "['sequence']['start']" 4
expect_json "$out/jobs/b/corners_no_loops/backward_1/run.json" "['sequence']['end']" 18
expect_json "$out/jobs/b/corners_no_loops/backward_1/run.json" "['sequence']['reverse']" True
expect_json "$out/jobs/b/corners_no_loops/backward_1/run.json" "['settings']['loops']['enabled']" False

echo "-- a plan that asks for something else does not take these results for its own"
sed 's/^threads: 1/threads: 1\nsettings: {window.iterations: 3}/' "$plan" >"$WORK/other.yaml"
expect_exit 1 experiment run "$WORK/other.yaml" -o "$out"
expect_output '^error: .*12 of its jobs have ended that the plan now asks for otherwise'

echo "-- two runners at once: every job once"
shared=$WORK/shared
"$LDSO" experiment run "$plan" -o "$shared" --jobs 1 >"$WORK/log_1" 2>&1 &
first=$!
expect_exit 0 experiment run "$plan" -o "$shared" --jobs 1
wait "$first" || fail "the first of two runners failed"
cat "$WORK/log_1" >>"$WORK/log"
runs=$(awk '/^run here/ { n += $3 } END { print n }' "$WORK/log")
((runs == jobs)) || fail "two runners ran $runs jobs of $jobs"
[[ $(results "$shared" | wc -l) == "$jobs" ]] || fail "not every job has a result"

echo "-- a killed job is run again; Ctrl-C leaves no result"
sed '/name: [ab],/d; s/name: broken, end: 16/name: long/; s/repetitions: 2/repetitions: 1/; s/, backward//' "$plan" \
  >"$WORK/long.yaml"
long=$WORK/long/jobs/long/corners_no_loops/forward_0
has_begun() { grep -q '^frame 100/' "$long/log.txt" 2>/dev/null && has_job "$1"; }
set -m
"$LDSO" experiment run "$WORK/long.yaml" -o "$WORK/long" >"$WORK/log" 2>&1 &
runner=$!
set +m
wait_for 60 has_begun "$runner" || fail "the long job did not begin"
[[ -e $long/lock && ! -e $long/run.json ]] || fail "a running job has a run.json"
job=$(job_of "$runner")
kill -s KILL "$job"
another_job() { local now; now=$(job_of "$runner"); [[ -n $now && $now != "$job" ]]; }
wait_for 20 another_job || fail "the killed job was not run again"
[[ ! -e $long/failure.json ]] || fail "a killed job counts as failed"
wait_for 60 has_begun "$runner" || fail "the long job did not begin again"
expect_status() { "$LDSO" experiment status "$WORK/long" | grep -Eq "$1" || fail "the status is not '$1'"; }
expect_status '^long +0 +0 +1 +0$'
kill -s INT "$runner"
status=0
wait "$runner" || status=$?
((status == 130)) || fail "after Ctrl-C the runner ended with $status"
expect_output '^interrupted: finished jobs are kept'
expect_json "$long/run.json" "['interrupted']" True
expect_status '^long +0 +0 +0 +1$'

echo "-- printed jobs, run by bash, give the same results; twice does nothing"
printed=$WORK/printed
"$LDSO" experiment run "$plan" -o "$printed" --print-jobs --only 'b/' --only broken/*/forward_0 >"$WORK/jobs.txt" 2>"$WORK/log"
[[ $(wc -l <"$WORK/jobs.txt") == 5 ]] || fail "not five jobs were printed"
expect_output '^5 of 5 jobs printed$'
lock=$printed/jobs/b/corners_no_loops/forward_0/lock
status=0
flock "$lock" bash -c "$(sed -n 1p "$WORK/jobs.txt")" 2>"$WORK/log" || status=$?
((status == 75)) || fail "a job that is run elsewhere ended with $status"
SLURM_ARRAY_TASK_ID=2 bash "$here/../experiments/slurm_array.sh" "$WORK/jobs.txt" >"$WORK/log" 2>&1 || fail "task 2"
[[ $(results "$printed") == b/corners_no_loops/backward_0/run.json ]] || fail "task 2 has not run job 2"
first=$(stamps "$printed")
status=0
bash "$here/../experiments/slurm_array.sh" "$WORK/jobs.txt" >"$WORK/log" 2>&1 || status=$?
((status == 1)) || fail "the array ended with $status although a job has failed"
expect_output '^ended with 1: .*broken'
[[ -z $(comm -23 <(echo "$first") <(stamps "$printed")) ]] || fail "a finished job was run again"
for file in $(cd "$out/jobs" && echo b/*/*/trajectory.txt b/*/*/keyframes.txt b/*/*/map.ply); do
  cmp "$out/jobs/$file" "$printed/jobs/$file" || fail "$file of a printed job differs"
done
# errors.json is the summary's own: a runner draws it at its end, printed jobs do not.
written() { (cd "$1/jobs/b" && find . -type f ! -name errors.json | sort); }
[[ $(written "$out") == $(written "$printed") ]] ||
  fail "printed jobs write other files"
expect_json "$printed/jobs/broken/corners_no_loops/forward_0/failure.json" "['exit_code']" 1
expect_exit 0 experiment run "$plan" -o "$printed" --print-jobs --only b/
expect_output '^0 of 4 jobs printed$'

echo "-- what is missing is said before anything is run"
sed -i 's/name: broken, end: 16/name: absent/; s/name: b,/name: lost,/' "$plan"
expect_exit 1 experiment run "$plan" -o "$WORK/missing"
expect_output '^error: .*2 of 3 sequences of the plan cannot be run'
expect_output 'absent: .*my data/absent \(there is no such folder\)'
expect_output 'lost: '
expect_output 'mono can be had here: nowhere'
[[ ! -e $WORK/missing ]] || fail "something was written although sequences are missing"
expect_exit 1 experiment run "$plan" -o "$WORK/missing" --root "$WORK/nowhere"
expect_output '3 of 3 sequences'
expect_exit 0 experiment run "$plan" -o "$WORK/missing" --skip-missing --only forward_0
expect_output '^warning: .*2 of 3 sequences'
expect_output '^finished       1 jobs$'

echo "-- plans that come with the program"
for plan_and_count in tum_mono:50 tum_mono_loops:50 euroc:11 kitti:11 runtime:6 demo:6 demo_small:3 nightly:6; do
  expect_exit 1 experiment run "${plan_and_count%:*}" -o "$WORK/missing"
  expect_output "^error: .* ${plan_and_count#*:} of ${plan_and_count#*:} sequences of the plan cannot be run"
done
mkdir -p "$WORK/beside/nightly" # a folder for its results
(
  cd "$WORK/beside"
  expect_exit 1 experiment run nightly -o nightly
  expect_output '^error: .* 6 of 6 sequences of the plan cannot be run'
)

echo "-- mistakes are named"
echo 'repetitons: 3' >>"$plan"
expect_exit 1 experiment run "$plan" -o "$WORK/missing"
expect_output "^error: .*plan.yaml:16: unknown key 'repetitons'; did you mean 'repetitions'\?"
expect_exit 1 experiment summarise -o x
expect_output 'there is no such file, nor a plan of that name'
