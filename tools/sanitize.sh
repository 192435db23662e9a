#!/usr/bin/env bash
# Builds the program and the tests with clang++, warnings as errors, AddressSanitizer and UndefinedBehaviorSanitizer, and runs
# the tests. Those marked UNSANITIZED (cmake/modules.cmake) are left out. Those of DDS and of a launch by the wall clock have three
# tries, as in tools/slow_tests.sh. The golden drives must give the same bits as with g++.
# tools/fuzz.sh uses the same build.
#   tools/sanitize.sh [--slow]      --slow: also what is slow, and by the wall clock
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh asan-ubsan
ulimit -s 262144   # KiB: std::regex, in tests, calls itself for every character
export LSAN_OPTIONS=suppressions=$PWD/tools/lsan.supp:print_suppressions=0
run() { ctest --test-dir build/asan-ubsan --output-on-failure -j"$(($(nproc) + 1))" "$@"; }
run -LE 'realtime|slow'
run -R '^test_(dds_network|ros_network|launch_wall_clock)$' --repeat until-pass:3
[[ ${1:-} == --slow ]] || exit 0
run -LE realtime -L slow
run -L realtime --repeat until-pass:3
