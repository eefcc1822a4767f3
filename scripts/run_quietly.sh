#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command and shows one line; shows all of its output only if it fails.
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
  exit 1 # other checks still run, so that one run reports all faults
fi
