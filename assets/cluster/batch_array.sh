#!/usr/bin/env bash
# swarf batch on a cluster with Slurm: each job a task of an array, then one call for the table.
#
#   batch_array.sh jobs.toml night [options of sbatch for the tasks: --time=2:00:00 --cpus-per-task=8 ..]
#
# `night` is the folder of the results: every node must see it, the programs and swarf under the same paths. A task
# uses the cores that it is given. Jobs whose results are there already are tasks of a second; given again after a
# breakdown, the command runs what is missing. Waits for nothing: squeue shows the array and the table's job, which
# runs when all tasks have ended, whatever came of them, and whose exit code is that of the batch.
# SWARF names the program (default: swarf). The job's numbers are printed: "array 12, table 13".
set -euo pipefail
if [ $# -lt 2 ]; then
  sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
swarf=${SWARF:-swarf}
jobs=$(realpath -- "$1")
night=$(realpath -m -- "$2")
shift 2

# The table as it stands now: it checks jobs.toml before anything is submitted, and says how many jobs it holds.
code=0
table=$("$swarf" batch "$jobs" -o "$night" --summary --json) || code=$?
case $code in 0 | 1 | 130) ;; *) exit "$code" ;; esac
count=$(grep -c '^      "name":' <<<"$table")

words=$(printf '%q ' "$swarf" batch "$jobs" -o "$night")
array=$(sbatch --parsable --job-name=swarf --array="1-$count" --output="$night/slurm_%a.log" "$@" \
  --wrap "exec $words --only \$SLURM_ARRAY_TASK_ID -q")
summary=$(sbatch --parsable --job-name=swarf-table --dependency="afterany:$array" --output="$night/slurm_table.log" \
  --wrap "exec $words --summary --junit $(printf '%q' "$night/batch.xml")")
echo "array $array, table $summary"
