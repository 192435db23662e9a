#!/usr/bin/env bash
# The second compiler and the sanitizers: builds the program and the tests that sanitizers can find something in (but those
# marked UNSANITIZED, cmake/rooms.cmake) with clang++, warnings as errors, AddressSanitizer and UndefinedBehaviorSanitizer, and
# runs them. The golden drives must give the bits they give with g++. The fuzz targets are of the same build (tools/fuzz.sh).
#   tools/sanitize.sh [--slow]      --slow: also what is slow, and by the wall clock
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh asan-ubsan
ulimit -s 262144   # KiB: std::regex, in tests, calls itself for every character
export LSAN_OPTIONS=suppressions=$PWD/tools/lsan.supp:print_suppressions=0
run() { ctest --test-dir build/asan-ubsan --output-on-failure -j"$(($(nproc) + 1))" "$@"; }
run -LE 'realtime|slow'
[[ ${1:-} == --slow ]] || exit 0
run -LE realtime -L slow
run -L realtime --repeat until-pass:3
