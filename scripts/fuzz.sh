#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# fuzz.sh NAME SECONDS LIMIT : runs the fuzz target NAME from its corpus for SECONDS seconds. An input that takes longer
# than LIMIT seconds is a finding. New inputs go to out/fuzz/NAME, findings to out/fuzz/NAME-*; the repository's corpus
# does not change.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p "out/fuzz/$1" "fuzz/corpus/$1"
# libFuzzer's own exit status for a finding is 77, which CTest would take for a skipped test.
exec scripts/sanitized.sh "build/asan/fuzz/fuzz_$1" -error_exitcode=1 -max_total_time="$2" -timeout="$3" \
  -rss_limit_mb=2048 -print_final_stats=0 -verbosity=0 -artifact_prefix="out/fuzz/$1-" "out/fuzz/$1" "fuzz/corpus/$1"
