#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# bench.sh FOLDER [ARGS]: says what machine this is, then runs every benchmark program of FOLDER.
# bench.sh FOLDER zbuffer [ARGS]: the z-buffer's tables alone; stream [ARGS]: models of growing length, streamed.
set -euo pipefail
folder=$1
shift
echo "machine:  $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores"
echo "compiler: $(${CXX:-c++} --version | head -1)"
echo "commit:   $(git describe --always --dirty 2>/dev/null || echo none)"

if [ "${1:-}" = zbuffer ]; then
  shift
  exec "$folder/zbuffer_bench" "$@"
fi
if [ "${1:-}" = stream ]; then
  shift
  exec "$folder/stream_table" "$@"
fi
"$folder/zbuffer_bench"
for program in "$folder"/*_bench; do
  [ "$(basename "$program")" != zbuffer_bench ] || continue
  echo
  echo "== $(basename "$program")"
  "$program" --benchmark_counters_tabular=true --benchmark_enable_random_interleaving=true "$@"
done
