#!/usr/bin/env bash
# Configures and builds one preset (default: release). Arguments after it go to cmake --build.
#   tools/build.sh release --target ttfusion
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
[[ $# -gt 0 ]] && shift
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
cmake --preset "$preset" "${launcher[@]}" >/dev/null
cmake --build "build/$preset" "$@"
