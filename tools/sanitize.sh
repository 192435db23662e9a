#!/usr/bin/env bash
# Builds our own code with AddressSanitizer and UndefinedBehaviorSanitizer and runs the tests of it.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/build.sh asan-ubsan
exec ctest --test-dir build/asan-ubsan --output-on-failure -j"$(nproc)"
