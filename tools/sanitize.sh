#!/usr/bin/env bash
# Builds our own code with AddressSanitizer and UndefinedBehaviorSanitizer and runs the rooms' tests and the golden drives.
# (The tests of the pictures and of the official log reader are left to the release build: they spend their time in
# libraries. So are the long drives, which measure memory, and thousands of start-ups.)
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh asan-ubsan
export LSAN_OPTIONS=suppressions=$PWD/tools/lsan.supp:print_suppressions=0
exec ctest --test-dir build/asan-ubsan --output-on-failure -j"$(nproc)" -E 'test_sim|test_report|mcap_official_reader|startup_thousands'
