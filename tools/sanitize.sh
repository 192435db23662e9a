#!/usr/bin/env bash
# Builds the program and the tests with clang++, warnings as errors, AddressSanitizer and UndefinedBehaviorSanitizer, and runs
# the tests. Those marked UNSANITIZED (cmake/modules.cmake) are left out, and those that run nothing of the build. Those of DDS and of
# a launch by the wall clock have three tries, as in tools/slow_tests.sh. The golden drives must give the same bits as with g++.
# tools/fuzz.sh uses the same build.
#   tools/sanitize.sh [--changed | --slow]
# --changed: only the tests that are touched (tools/touched.py) by the changes since the long checks last passed all of them.
# --slow: the slow tests instead, and all by the wall clock.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
since=
[[ ${1:-} != --changed ]] || since=$(tools/last_passed.sh sanitizers)
ulimit -s 262144   # KiB: std::regex, in tests, calls itself for every character
export LSAN_OPTIONS=suppressions=$PWD/tools/lsan.supp:print_suppressions=0
at_once=-j$(($(nproc) + 1))
sanitized() { tools/touched_tests.sh asan-ubsan "$since" "$@"; }
if [[ ${1:-} == --slow ]]; then
  sanitized '-LE realtime -L slow' "$at_once"
  sanitized '-L realtime' --repeat until-pass:3
else
  sanitized '-LE realtime|slow' "$at_once"
  sanitized '-R ^test_(dds_network|ros_network|launch_wall_clock)$' "$at_once" --repeat until-pass:3
fi
