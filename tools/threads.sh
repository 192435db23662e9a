#!/usr/bin/env bash
# Builds tests with ThreadSanitizer and runs them. A race ends them, and this script with exit code 1.
#   tools/threads.sh [--changed] [TEST...]      default: test_threads, the tests of all code with threads (tests/CMakeLists.txt)
# --changed: only the tests that are touched (tools/touched.py) by the changes since the long checks last passed `threads`.
set -euo pipefail
cd "$(dirname "$0")/.."
since=
[[ ${1:-} != --changed ]] || { since=$(tools/last_passed.sh threads) && shift; }
[[ $# -gt 0 ]] || set -- test_threads
tools/install_deps.sh
tools/build.sh tsan --target help >/dev/null   # configured, nothing built
mapfile -t touched < <(tools/touched.py build/tsan "$since" "$@")
[[ ${#touched[@]} -gt 0 ]] || { echo "threads: nothing of $* has changed since $since"; exit 0; }
set -- "${touched[@]}"
tools/build.sh tsan --target "$@"
export TSAN_OPTIONS=halt_on_error=1:suppressions=$PWD/tools/tsan.supp
ctest --test-dir build/tsan --output-on-failure -R "^($(IFS='|'; echo "$*"))$" --no-tests=error
