#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# quick.sh ANSWERS : builds for arm64. Under QEMU the program must give the answers of ANSWERS, this machine's build of
# it, and the tests of the rooms below must pass. The exit status is 77 (skipped) if a requirement is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
skip() {
  echo "skipped: there is no $1"
  exit 77
}
for tool in aarch64-linux-gnu-g++ qemu-aarch64; do command -v "$tool" >/dev/null || skip "$tool"; done
for folder in /usr/aarch64-linux-gnu/lib /usr/src/googletest; do [ -d "$folder" ] || skip "$folder"; done

export QEMU_LD_PREFIX=/usr/aarch64-linux-gnu
scripts/run_quietly.sh cmake --preset arm64
scripts/run_quietly.sh cmake --build build/arm64 -j "$(nproc)" --target frontmost_tests arm64_answers
mkdir -p build/arm64/told
"$1" >build/arm64/told/here
qemu-aarch64 build/arm64/tests/arm64/arm64_answers >build/arm64/told/arm64
[ "$(wc -l <build/arm64/told/here)" -ge 30 ]
echo "the answers, of this machine (<) and of arm64 (>)"
diff build/arm64/told/here build/arm64/told/arm64
# Left out are the tests of zbuffer that take a minute each, and the one that forks: QEMU does not let a program with
# threads fork.
programs=(build/arm64/tests/{zbuffer/zbuffer,view/view,surfaces/surfaces,base/base}_test)
printf '%s\n' "${programs[@]}" |
  xargs -P "$(nproc)" -I{} scripts/run_quietly.sh qemu-aarch64 {} --gtest_brief=1 --gtest_filter='-*AFlightAllocatesNothing*:*ReversedFloatIsTheDefault*:LargestImage.*:DepthBuffer/*:Repeats/*:ZBuffer/Cutouts*:Crew.AForked*'
