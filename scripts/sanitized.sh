#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# sanitized.sh PROGRAM [ARGUMENTS...] : runs a program of a sanitizer's build, which stops at the first finding. The
# exit status is 77 (skipped) if the program is not built; ./dev test builds it. A GoogleTest filter must be the last
# argument; it is an error if it selects no test.
set -euo pipefail
[ -x "$1" ] || {
  echo "skipped: $1 is not built"
  exit 77
}
if [[ "${!#}" == --gtest_filter=* ]]; then
  filter=${!#}
  filter=${filter#--gtest_filter=}
  # Each pattern of a filter that only selects must select a test: a stale pattern would go unnoticed.
  patterns=("$filter")
  if [[ "$filter" != *-* ]]; then IFS=: read -ra patterns <<<"$filter"; fi
  for pattern in "${patterns[@]}"; do
    if [ "$("$1" --gtest_list_tests --gtest_filter="$pattern" | grep -c '^  ')" = 0 ]; then
      echo "no test of $1 is selected by $pattern"
      exit 1
    fi
  done
fi
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_string_checks=1}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1}
exec "$@"
