#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# run.sh NEEDED SCRIPT ARGUMENTS... : runs a script in Node. The exit status is 77 (skipped) if a needed file or Node is
# missing, or, for tests in a browser, the browser.
needed=$1
script=$2
skip() {
  echo "skipped: $1"
  exit 77
}
[ -e "$needed" ] || skip "$needed is not built"
command -v node >/dev/null || skip "there is no node"
case $script in */page.mjs | */touch.mjs | */access.mjs) [ -x /usr/bin/chromium-headless-shell ] || skip "there is no /usr/bin/chromium-headless-shell" ;; esac
shift
exec node "$@"
