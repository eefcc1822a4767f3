#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A batch of views as an array job of Slurm: every task renders a shard.
#
#   sbatch --array=1-16 render_batch.sh engine.glb views.json --resolution 1920,1080
#
# A task that ended early resumes when it is submitted again: SHARDS=16 sbatch --array=3 render_batch.sh ...
#SBATCH --job-name=frontmost
#SBATCH --cpus-per-task=4
#SBATCH --requeue
set -euo pipefail
model=$1
views=$2
shift 2
exec frontmost render "$model" --batch "$views" --shard "$SLURM_ARRAY_TASK_ID/${SHARDS:-$SLURM_ARRAY_TASK_COUNT}" \
  --threads "${SLURM_CPUS_PER_TASK:-0}" "$@"
