#!/usr/bin/env bash
# Builds our own code with AddressSanitizer and UndefinedBehaviorSanitizer and runs the rooms' tests. (Whole drives and
# pictures are left to the release build: they measure memory, or spend their time in libraries.)
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
cmake --preset asan-ubsan -DTTF_BUILD_BENCHMARKS=OFF >/dev/null
cmake --build build/asan-ubsan
exec ctest --test-dir build/asan-ubsan --output-on-failure -j"$(nproc)" \
  -E 'test_sim|test_report|command_line|mcap_official_reader'
