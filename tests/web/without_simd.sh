#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# without_simd.sh PROGRAM : builds the module for engines without vectors; its hashes must equal the program's. The exit
# status is 77 (skipped) without emscripten or Node.
set -euo pipefail
cd "$(dirname "$0")/../.."
for tool in /usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake node; do
  if ! command -v "$tool" >/dev/null && ! [ -e "$tool" ]; then
    echo "skipped: there is no $tool"
    exit 77
  fi
done
scripts/run_quietly.sh cmake --preset web-plain
scripts/run_quietly.sh cmake --build build/web-plain -j "$(nproc)" --target frontmost_web
exec node tests/web/hashes.mjs build/web-plain/web/frontmost.mjs "$1"
