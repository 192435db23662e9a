#!/usr/bin/env bash
# Runs the tests that tools/test.sh leaves out: the slow ones, then, one at a time, those that run by the wall clock. A
# machine that stalls for longer than their arrival window makes the latter fail: each has three tries.
#   tools/slow_tests.sh [--changed]
# --changed: only the tests that are touched (tools/touched.py) by the changes since the long checks last passed all of them.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
since=
[[ ${1:-} != --changed ]] || since=$(tools/last_passed.sh slow)
tools/touched_tests.sh release "$since" '-L slow -LE realtime' -j"$(($(nproc) + 1))"
tools/touched_tests.sh release "$since" '-L realtime' --repeat until-pass:3
