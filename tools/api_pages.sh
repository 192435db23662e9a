#!/usr/bin/env bash
# Writes pages of the headers that are installed (cmake/install.cmake), by Doxygen, and says how many public names have no
# comment, module by module. Needs `tools/install_deps.sh --api`. [FOLDER, default out/api]
set -euo pipefail
cd "$(dirname "$0")/.."
command -v doxygen >/dev/null || { echo "error: doxygen is not installed: tools/install_deps.sh --api" >&2; exit 2; }
out=${1:-out/api}
modules=(core timebase schedules fusion recording bus/wire nodes/foreign)
mkdir -p "$out"
(
  cat tools/Doxyfile
  echo "INPUT = ${modules[*]}"
  echo "OUTPUT_DIRECTORY = $out"
  echo "WARN_LOGFILE = $out/warnings.txt"
  echo "GENERATE_TAGFILE = $out/ttfusion.tag"
) | doxygen -

count() { grep -c "$@" || true; }
printf '%-16s %12s\n' module undocumented
for module in "${modules[@]}"; do
  printf '%-16s %12s\n' "$module" "$(grep "^\(.*/\)\?$module/" "$out/warnings.txt" | count 'is not documented')"
done
documented=$(count '<member kind=' "$out/ttfusion.tag")
undocumented=$(count 'is not documented' "$out/warnings.txt")
echo "$documented members are on the pages, $undocumented names have no comment of their own, $(
  count -v 'is not documented' "$out/warnings.txt") other warnings: $out/warnings.txt"
echo "wrote $out/html/index.html"
