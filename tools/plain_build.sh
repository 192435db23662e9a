#!/usr/bin/env bash
# Builds without presets: cmake -B FOLDER -DCMAKE_BUILD_TYPE=Release, with g++ or clang++.
#   tools/plain_build.sh [COMPILER] [TARGET...]      default: g++, everything
set -euo pipefail
cd "$(dirname "$0")/.."
compiler=${1:-g++}
[[ $# -gt 0 ]] && shift
targets=()
[[ $# -gt 0 ]] && targets=(--target "$@")
folder=build/plain-$compiler
export CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
cmake -B "$folder" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" "${launcher[@]}" >/dev/null
cmake --build "$folder" -j"$(nproc)" "${targets[@]}"
"$folder/ttfusion" run scenarios/paper_scenario1.yaml --strategy tt --out "$folder/drive" >/dev/null
