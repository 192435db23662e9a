#!/usr/bin/env bash
# Compares every source with .clang-format. Exit code 1 with the places that differ.
#   tools/check_format.sh [--fix] [--changed]      --fix: formats them; --changed: of those alone that differ from the last commit
set -euo pipefail
cd "$(dirname "$0")/.."
how=(--dry-run -Werror)
list=(find . \( -path ./build -o -path ./out -o -path '*/node_modules' -o -path './.*' \) -prune -o \( -name '*.h' -o -name '*.cc' \) -print0)
changed() {
  git diff -z --name-only --diff-filter=d HEAD -- '*.h' '*.cc'
  git ls-files -z --others --exclude-standard -- '*.h' '*.cc'
}
for argument; do
  case $argument in
    --fix) how=(-i) ;;
    --changed) list=(changed) ;;
    *) echo "error: $argument: must be --fix or --changed" >&2; exit 2 ;;
  esac
done
"${list[@]}" | xargs -0 -r -P "$(nproc)" -n 50 clang-format "${how[@]}"
