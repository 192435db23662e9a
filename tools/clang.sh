#!/usr/bin/env bash
# The second compiler: builds everything with clang++, warnings as errors, and runs the tests; the golden drives must give
# the bits they give with g++.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh clang --target all benchmarks
exec ctest --test-dir build/clang --output-on-failure -j"$(nproc)" -LE slow -E 'test_report|mcap_official_reader'
