#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# fuzz.sh SECONDS NAME : runs the fuzz target NAME from its corpus. New inputs go to out/fuzz/NAME, findings to
# out/fuzz/NAME-*; the corpus of the repository stays as it is.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p "out/fuzz/$2" "fuzz/corpus/$2"
exec scripts/sanitized.sh "build/asan/fuzz/fuzz_$2" -max_total_time="$1" -timeout=60 -rss_limit_mb=2048 \
  -print_final_stats=0 -verbosity=0 -artifact_prefix="out/fuzz/$2-" "out/fuzz/$2" "fuzz/corpus/$2"
