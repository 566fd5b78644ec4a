#!/usr/bin/env bash
#SBATCH --job-name=ldso
#SBATCH --cpus-per-task=1
#SBATCH --mem=4G
#SBATCH --time=04:00:00
#SBATCH --output=slurm-%A_%a.log
#
# Runs the jobs of an experiment as a SLURM job array:
#
#   ldso experiment run PLAN --root /shared/data -o /shared/OUT --print-jobs > jobs.txt
#   sbatch --array=1-$(wc -l < jobs.txt)%100 experiments/slurm_array.sh jobs.txt
#
# --cpus-per-task should be the plan's `threads`. Where arrays may not be that large, give each task several lines:
#
#   sbatch --export=ALL,LDSO_JOBS_PER_TASK=10 --array=1-300 experiments/slurm_array.sh jobs.txt
#
# Without SLURM: `slurm_array.sh jobs.txt` runs all jobs one after the other, `SLURM_ARRAY_TASK_ID=3 slurm_array.sh
# jobs.txt` the third task. Jobs that have a result are passed over, so everything may be submitted again.
# Ends with 1 if a job has ended with an error or was killed; the others are run all the same.
set -euo pipefail

jobs=${1:?usage: slurm_array.sh FILE, the output of ldso experiment run ... --print-jobs}
per_task=${LDSO_JOBS_PER_TASK:-1}
mapfile -t lines <"$jobs"

first=0
count=${#lines[@]}
if [[ -n ${SLURM_ARRAY_TASK_ID:-} ]]; then
  first=$(((SLURM_ARRAY_TASK_ID - 1) * per_task))
  count=$per_task
fi

status=0
for line in "${lines[@]:first:count}"; do
  code=0
  bash -c "$line" || code=$?
  # 2: no frame could be tracked, which is a result.
  if ((code != 0 && code != 2)); then
    echo "ended with $code: $line" >&2
    status=1
  fi
done
exit "$status"
