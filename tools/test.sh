#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 and runs the tests; those labelled slow are left to .ci/run.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh release
# One more than there are processors: several tests mostly wait.
run() { ctest --test-dir build/release --output-on-failure -j"$(($(nproc) + 1))" "$@"; }
run -LE 'slow|realtime'
# Drives in real time fall apart when the machine stands still for longer than their window; a shared one does at times.
run -L realtime --repeat until-pass:3
