#!/usr/bin/env bash
# A batch as a Slurm array: each task does its part of the recordings, all into one folder of results.
#
#   sbatch --array=1-64 --cpus-per-task=4 examples/batch/slurm.sh RECORDINGS RESULTS [OPTION...]
#
# Given again, the same command does what is not there yet: tasks that were killed or ran out of time, and a lot that has grown.
# SERVOID names the program if it is not on the PATH.
#SBATCH --job-name=servoid
#SBATCH --requeue
set -euo pipefail

if (($# < 2)); then
  echo "usage: sbatch --array=1-N slurm.sh RECORDINGS RESULTS [OPTION of servoid batch...]" >&2
  exit 2
fi
recordings=$1
results=$2
shift 2
: "${SLURM_ARRAY_TASK_ID:?is not set: submit this as an array, sbatch --array=1-N}"
# Parts count from 1, whatever the array begins with.
part=$((SLURM_ARRAY_TASK_ID - ${SLURM_ARRAY_TASK_MIN:-1} + 1))
exec "${SERVOID:-servoid}" batch "$recordings" --out "$results" --shard "$part/$SLURM_ARRAY_TASK_COUNT" \
  --workers "${SLURM_CPUS_PER_TASK:-1}" --quiet "$@"
