#!/usr/bin/env bash
# The second compiler and the sanitizers: builds everything with clang++, warnings as errors, AddressSanitizer and
# UndefinedBehaviorSanitizer in our own code, and runs the tests but for those marked UNSANITIZED (cmake/rooms.cmake). The
# golden drives must give the bits they give with g++. The fuzz targets are of the same build (tools/fuzz.sh).
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh asan-ubsan --target all benchmarks
ulimit -s 262144   # KiB: std::regex, in tests, calls itself for every character
export LSAN_OPTIONS=suppressions=$PWD/tools/lsan.supp:print_suppressions=0
run() { ctest --test-dir build/asan-ubsan --output-on-failure -j"$(($(nproc) + 1))" "$@"; }
run -LE realtime
run -L realtime --repeat until-pass:3
