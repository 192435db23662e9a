#!/usr/bin/env bash
# Builds tests with ThreadSanitizer and runs them. A race ends them, and this script with exit code 1.
#   tools/threads.sh [TEST...]      default: test_threads, the tests of all code with threads (tests/CMakeLists.txt)
set -euo pipefail
cd "$(dirname "$0")/.."
[[ $# -gt 0 ]] || set -- test_threads
tools/install_deps.sh
tools/build.sh tsan --target "$@"
export TSAN_OPTIONS=halt_on_error=1:suppressions=$PWD/tools/tsan.supp
ctest --test-dir build/tsan --output-on-failure -R "^($(IFS='|'; echo "$*"))$" --no-tests=error
