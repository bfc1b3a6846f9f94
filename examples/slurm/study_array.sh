#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A study on a cluster with Slurm: a job array with a shard for each task, and the merging of the shards.
#
#   sbatch --parsable --array=1-16 study_array.sh STUDY.toml OUT 16      prints the number of the job
#   sbatch --dependency=afterok:NUMBER study_array.sh merge OUT          joins the shards in OUT
#
# OUT is a folder that all nodes share. A task that is ended early, by a time limit, a failure of its node or scancel, is repeated with its
# number alone, --array=7 for the seventh: it goes on where its journal ends. Slurm repeats a task of a failed node itself (--requeue).
# PHALANX names the program; else it is the one in PATH. Processors of different types may round a sine differently in its last bit;
# shards of such machines are not merged. --constraint=TYPE keeps the tasks on nodes of one type.
#SBATCH --job-name=phalanx-study
#SBATCH --cpus-per-task=2
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
program=${PHALANX:-phalanx}

if [ $# -eq 2 ] && [ "$1" = merge ]; then
  exec "$program" study merge "$2" --out "$2"
fi
if [ $# -ne 3 ]; then
  echo "study_array.sh: it takes STUDY.toml OUT TASKS, or merge OUT; see its first lines" >&2
  exit 2
fi
: "${SLURM_ARRAY_TASK_ID:?study_array.sh: this is no task of an array; submit it with sbatch --array=1-$3}"
exec "$program" study "$1" --out "$2" --shard "$SLURM_ARRAY_TASK_ID/$3" --jobs "${SLURM_CPUS_PER_TASK:-1}"
