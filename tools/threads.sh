#!/usr/bin/env bash
# Builds test_threads with ThreadSanitizer and runs it. The program has the tests of all code with threads: sweeps, campaigns,
# runners, media, the log writer (tests/CMakeLists.txt). A race ends it.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh tsan --target test_threads
export TSAN_OPTIONS=halt_on_error=1
ctest --test-dir build/tsan --output-on-failure -R '^test_threads$' --no-tests=error
