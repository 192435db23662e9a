#!/usr/bin/env bash
# Counts the instructions of the hot paths (tests/bench/hot_paths.cc) with valgrind's callgrind and compares them with
# tests/bench/instruction_counts. Exit code 1 if one differs by more than 3 %. The machine's load does not change the counts.
#   tools/instruction_counts.sh            says what has changed
#   tools/instruction_counts.sh --update   keeps what was counted, and makes docs/fusion/late_measurements.md of it
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh release --target ttf_hot_paths
program=$PWD/build/release/tests/bench/ttf_hot_paths
kept=$PWD/tests/bench/instruction_counts
counted=$PWD/build/instruction_counts
made_with='g++-12 libc6 libeigen3-dev libfmt9 libstdc++6'

# One path a line: its name and its count.
count() {
  local said
  said=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='counted*' "$program" "$1" 2>&1) ||
    { echo "$said" >&2; return 1; }
  echo "$1 $(sed -n 's/.*Collected : \([0-9]*\).*/\1/p' <<<"$said")"
}
export -f count
export program
{
  "$program" --list | xargs -P "$(nproc)" -I{} bash -c 'count {}' | LC_ALL=C sort
  # Other compilers make other counts.
  echo "made_with $(dpkg-query -W -f '${Package} ${Version}\n' $made_with | sha256sum | cut -c 1-16)"
} >"$counted"

if [[ ${1:-} == --update ]]; then
  cp "$counted" "$kept"
  cat "$kept"
  tools/build.sh release --target late_page
  build/release/tests/fusion/oosm/late_page "$PWD"
  exit
fi
if [[ $(grep ^made_with "$kept") != $(grep ^made_with "$counted") ]]; then
  echo "$kept was made with other versions of $made_with: its counts are not compared"
  exit
fi
paths() { grep -v ^made_with "$1"; }
LC_ALL=C join -a 1 -a 2 -e none -o 0,1.2,2.2 <(paths "$kept") <(paths "$counted") | awk '
  $2 == "none" || $3 == "none" { printf "%-30s %12s -> %12s\n", $1, $2, $3; bad = 1; next }
  { change = 100 * ($3 - $2) / $2; printf "%-30s %12d -> %12d  %+6.1f %%\n", $1, $2, $3, change }
  change > 3 || change < -3 { bad = 1 }
  END { exit bad }' || {
    echo "hot paths cost other instructions than $kept says; if that is right: tools/instruction_counts.sh --update" >&2
    exit 1
  }
