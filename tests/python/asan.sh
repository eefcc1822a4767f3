#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# asan.sh BUILD PYTHON PROGRAM: runs the module's tests with AddressSanitizer's runtime loaded before Python.
set -euo pipefail
build=$1 python=$2 program=$3
cmake --build "$build" --target frontmost_python_checked -j "$(nproc)" >"$build/python_checked.log" 2>&1 ||
  { cat "$build/python_checked.log" && exit 1; }
# Debian's Python links no C++ library, so that is loaded too: the runtime then knows C++ exceptions.
runtime=$(g++ -print-file-name=libasan.so)
runtime+=" $(g++ -print-file-name=libstdc++.so)"
export ASAN_OPTIONS=detect_leaks=0:detect_stack_use_after_return=1 PYTHONMALLOC=malloc PYTHONDONTWRITEBYTECODE=1
export FRONTMOST_SANITIZED=1 FRONTMOST_CLI=$program PYTHONPATH=$build/python/checked
LD_PRELOAD=$runtime exec "$python" -m pytest -q -p no:cacheprovider tests/python
