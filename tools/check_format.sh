#!/usr/bin/env bash
# Compares every source with .clang-format. Exit code 1 with the places that differ; --fix formats them.
set -euo pipefail
cd "$(dirname "$0")/.."
how=(--dry-run -Werror)
[[ ${1:-} == --fix ]] && how=(-i)
find . \( -path ./build -o -path ./out -o -path '*/node_modules' -o -path './.*' \) -prune -o \( -name '*.h' -o -name '*.cc' \) -print0 |
  xargs -0 -P "$(nproc)" -n 50 clang-format "${how[@]}"
