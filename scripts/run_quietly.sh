#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command and shows one line; all of its output only when it fails.
set -u
log=$(mktemp)
trap 'rm -f "$log"' EXIT
start=$(date +%s)
"$@" >"$log" 2>&1
status=$?
if [ "$status" = 0 ]; then
  echo "passed $* ($(($(date +%s) - start)) s)"
else
  cat "$log"
  echo "FAILED $* with $status"
  exit 1 # the others still run: one run tells of all faults
fi
