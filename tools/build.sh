#!/usr/bin/env bash
# Configures and builds one preset (default: release). Arguments after it go to cmake --build.
#   tools/build.sh release --target ttfusion
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
[[ $# -gt 0 ]] && shift
launcher=()
# A miss costs no run of the preprocessor; compiled headers are cached too.
export CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
cmake --preset "$preset" "${launcher[@]}" >/dev/null
cmake --build "build/$preset" "$@"
