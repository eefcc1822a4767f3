#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# run.sh NEEDED SCRIPT ARGUMENTS... : runs a script in Node. 77, which means skipped, where a needed file or Node is not
# there; and, of tests in a browser, without that.
needed=$1
script=$2
skip() {
  echo "skipped: $1"
  exit 77
}
[ -e "$needed" ] || skip "$needed is not built"
command -v node >/dev/null || skip "there is no node"
case $script in */page.mjs | */touch.mjs | */access.mjs) [ -x /usr/bin/chromium ] || skip "there is no /usr/bin/chromium" ;; esac
shift
exec node "$@"
