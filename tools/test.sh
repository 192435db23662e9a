#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 and runs the tests; those labelled slow are left to .ci/run.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh release
# One more than there are processors: several tests mostly wait.
exec ctest --test-dir build/release -LE slow --output-on-failure -j"$(($(nproc) + 1))"
