#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 and runs the tests; those labelled slow (cmake/rooms.cmake) are left to .ci/run, as
# is the report in a browser.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh release
# One more than there are processors: several tests mostly wait.
run() { ctest --test-dir build/release --output-on-failure -j"$(($(nproc) + 1))" "$@"; }
run -LE 'slow|realtime|browser'
# Drives in real time fall apart when the machine stands still for longer than their window; a shared one does at times.
run -L realtime -LE slow --repeat until-pass:3
