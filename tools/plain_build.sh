#!/usr/bin/env bash
# Builds without presets: cmake -B FOLDER -DCMAKE_BUILD_TYPE=Release, with g++ or clang++.
#   tools/plain_build.sh [--changed] [--lean] [COMPILER] [TARGET...]      default: g++, everything
# --changed builds only if files that decide whether such a build succeeds differ from the commit on which it last passed in
# tools/long_checks.sh: CMake's own files, the program's list of sources, and sources that ask what is left out.
# --lean leaves out what can be: tests, benchmarks, DDS, MPI, and the optimiser, which takes most of the time. The
# program then says what it lacks.
set -euo pipefail
cd "$(dirname "$0")/.."
if [[ ${1:-} == --changed ]]; then
  shift
  since=$(tools/last_passed.sh plain_g++)
  since=${since:-HEAD~1}
  mapfile -t asking < <(git grep -l TTF_WITH_ -- '*.cc' '*.h')
  changed=$(git diff --name-only "$since" -- CMakeLists.txt CMakePresets.json cmake cli/CMakeLists.txt experiments/mpi cli/node_set \
    tools/plain_build.sh "${asking[@]}")
  [[ -n $changed ]] || { echo "plain build: nothing that decides about it has changed since $since"; exit 0; }
fi
lean=
[[ ${1:-} == --lean ]] && lean=lean- && shift
compiler=${1:-g++}
[[ $# -gt 0 ]] && shift
targets=()
[[ $# -gt 0 ]] && targets=(--target "$@")
folder=build/plain-$lean$compiler
export CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros
options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler")
command -v ccache >/dev/null && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
[[ -z $lean ]] ||
  options+=(-DTTF_BUILD_TESTS=OFF -DTTF_BUILD_BENCHMARKS=OFF -DTTF_WITH_DDS=OFF -DTTF_WITH_MPI=OFF
           -DCMAKE_CXX_FLAGS_RELEASE=-O0)
cmake -B "$folder" "${options[@]}" >/dev/null
cmake --build "$folder" -j"$(nproc)" "${targets[@]}"
"$folder/ttfusion" run scenarios/paper_scenario1.yaml --strategy tt --out "$folder/drive" >/dev/null
[[ -n $lean ]] || exit 0
"$folder/ttfusion" --version | grep -q "with no DDS, SocketCAN, no MPI"
code=0
"$folder/ttfusion" launch paper_scenario1 --virtual-time --out "$folder/launch" 2>"$folder/refused" || code=$?
[[ $code -eq 2 ]] && grep -q "it needs DDS, which this build leaves out" "$folder/refused"
