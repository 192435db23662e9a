#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 and runs the quick tests. The slow ones (cmake/modules.cmake), those by the wall clock
# (realtime) and the report in a browser run in .ci/run.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh release
# One more than there are processors: several tests mostly wait.
ctest --test-dir build/release --output-on-failure -j"$(($(nproc) + 1))" -LE 'slow|realtime|browser'
