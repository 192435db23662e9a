#!/usr/bin/env bash
# Runs the tests that tools/test.sh leaves out: the slow ones, then, one at a time, those that run by the wall clock. A
# machine that stalls for longer than their arrival window makes the latter fail: each has three tries.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh release
run() { ctest --test-dir build/release --output-on-failure "$@"; }
run -L slow -LE realtime -j"$(($(nproc) + 1))"
run -L realtime --repeat until-pass:3
