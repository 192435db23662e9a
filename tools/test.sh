#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 and runs all tests.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh
tools/build.sh release
exec ctest --test-dir build/release --output-on-failure -j"$(nproc)"
