#!/usr/bin/env bash
# The compiler refuses a kind of record that is only in the list, at every place that must know all kinds:
#   new_kind_test.sh COMPILER SOURCES [FLAGS...]
set -euo pipefail
compiler=$1 sources=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/recording/records"

# The list with one more row.
sed -e 's|^template <class Record> struct Kind {|struct Unheard {\n  Stamp stamp;\n};\n\n&|' \
    -e 's|^    Kind<OdometryTaken>.*|&\n    Kind<Unheard>{"/unheard"},|' \
    "$sources/recording/records/records.h" > "$work/recording/records/records.h"
refused() {  # UNIT WORDS FLAGS...
  local unit=recording/$1.cc words=$2
  shift 2
  if "$compiler" -std=c++20 -fsyntax-only "$@" -I"$work" -I"$sources" "$sources/$unit" 2> "$work/said"; then
    echo "$unit compiles with a kind that stands in the list alone"
    exit 1
  fi
  grep -q "$words" "$work/said" || { echo "nothing is said of $words:"; cat "$work/said"; exit 1; }
  grep -q "Unheard" "$work/said" || { echo "it is not said which:"; cat "$work/said"; exit 1; }
  echo "refused by $unit: $words"
}
for unit in log/encode log/decode merge/common_time; do
  refused "$unit" "a kind of record whose fields are not described" "$@"
done
refused merge/record_place "each kind of record has one rank" "$@"
