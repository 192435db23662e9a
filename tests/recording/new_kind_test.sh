#!/usr/bin/env bash
# The compiler refuses a kind of record that is only in the list, at every place that must list all kinds:
#   new_kind_test.sh COMPILER SOURCES [FLAGS...]
set -euo pipefail
sources=$2
compiler=("$1" -std=c++20 -fsyntax-only "${@:3}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/recording/records"

# The list with one more row.
sed -e 's|^template <class Record> struct Kind {|struct Unheard {\n  Stamp stamp;\n};\n\n&|' \
    -e 's|^    Kind<OdometryTaken>.*|&\n    Kind<Unheard>{"/unheard"},|' \
    "$sources/recording/records/records.h" > "$work/recording/records/records.h"
compile() {  # UNIT...: together, with the list; of one the first error is enough
  local unit first=()
  [[ $# -gt 1 ]] || first=(-Wfatal-errors)
  for unit; do echo "#include \"$sources/recording/$unit.cc\""; done >"$work/units.cc"
  if "${compiler[@]}" "${first[@]}" -I"$work" -I"$sources" "$work/units.cc" 2>"$work/said"; then
    echo "$* compile with a kind that stands in the list alone"
    exit 1
  fi
}
refused() {  # UNIT WORDS: what the last compilation says of it
  grep -q "$2" "$work/said" || { echo "nothing is said of $2:"; cat "$work/said"; exit 1; }
  grep -q "recording/$1\.cc" "$work/said" || { echo "it is not said where, $1:"; cat "$work/said"; exit 1; }
  grep -q "Unheard" "$work/said" || { echo "it is not said which:"; cat "$work/said"; exit 1; }
  echo "refused by $1: $2"
}
undescribed="a kind of record whose fields are not described"
# The compiler says this once in a compilation, so each of these is one of its own.
for unit in log/encode log/decode; do
  compile $unit
  refused $unit "$undescribed"
done
compile merge/common_time merge/record_place
refused merge/common_time "$undescribed"
refused merge/record_place "each kind of record has one rank"
