#!/usr/bin/env bash
# Builds our own code with AddressSanitizer and UndefinedBehaviorSanitizer and runs the rooms' tests and the golden drives
# (but for those marked UNSANITIZED in tests/, cmake/rooms.cmake). The fuzz targets are of the same build (tools/fuzz.sh).
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh asan-ubsan
ulimit -s 262144   # KiB: std::regex, in tests, calls itself for every character
export LSAN_OPTIONS=suppressions=$PWD/tools/lsan.supp:print_suppressions=0
exec ctest --test-dir build/asan-ubsan --output-on-failure -j"$(nproc)"
