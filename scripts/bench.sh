#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# bench.sh FOLDER [ARGS]: describes this machine, then runs every benchmark program of FOLDER.
# bench.sh FOLDER zbuffer|abuffer|drawings [ARGS]: runs the tables of one method alone. Other words: stream [ARGS],
# models of growing length, streamed; shade MODEL..., pictures of models one after another, beside llvmpipe's; python,
# the module beside the library, and beside VTK and Open3D; web, the WebAssembly module beside the program, WebGL and
# three.js, if ./dev page has built it; gl, frames by OpenGL's calls, beside llvmpipe's.
set -euo pipefail
folder=$1
shift
echo "machine:  $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores"
echo "compiler: $(${CXX:-c++} --version | head -1)"
echo "commit:   $(git describe --always --dirty 2>/dev/null || echo none)"

case "${1:-}" in
  zbuffer | abuffer | drawings)
    program=$1_bench
    shift
    exec "$folder/$program" "$@"
    ;;
  stream)
    shift
    exec "$folder/stream_table" "$@"
    ;;
  shade)
    shift
    exec "$folder/shade_table" "$@"
    ;;
  web)
    shift
    node bench/web/speed.mjs build/web/web/frontmost.mjs build/release/frontmost out/page
    echo
    exec node bench/web/peers.mjs out/page
    ;;
  gl)
    shift
    exec python3 bench/opengl/beside.py "$folder/opengl_frames" "$@"
    ;;
  python)
    shift
    python=$(cat "$folder/python_executable")
    export PYTHONPATH=$folder/../python
    "$python" bench/python/module.py "$folder/library_views"
    display=()
    [ -n "${DISPLAY:-}" ] || ! command -v xvfb-run >/dev/null || display=(xvfb-run -a)
    exec "${display[@]}" "$python" bench/python/peers.py
    ;;
esac
"$folder/zbuffer_bench"
"$folder/abuffer_bench"
"$folder/drawings_bench"
for program in "$folder"/*_bench; do
  case "$(basename "$program")" in zbuffer_bench | abuffer_bench) continue ;; esac
  echo
  echo "== $(basename "$program")"
  "$program" --benchmark_counters_tabular=true --benchmark_enable_random_interleaving=true "$@"
done
