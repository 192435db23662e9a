#!/usr/bin/env bash
# The compiler refuses a kind of record that is only in the list, at every place that must know all kinds:
#   new_kind_test.sh COMPILER SOURCES GENERATED [FLAGS...]
set -euo pipefail
compiler=$1 sources=$2 generated=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/recording/records" "$work/recording/log"

# The list with one more row, and a payload for it; without the payload, no part of the log compiles.
sed -e 's|^template <class Record> struct Kind {|struct Unheard {\n  Stamp stamp;\n};\n\n&|' \
    -e 's|^    Kind<OdometryTaken>.*|&\n    Kind<Unheard>{"/unheard"},|' \
    "$sources/recording/records/records.h" > "$work/recording/records/records.h"
sed 's|^template <class Record> using Payload =|template <> struct PayloadOf<records::Unheard> : PayloadOf<records::MediumCounts> {};\n&|' \
    "$sources/recording/log/codec.h" > "$work/recording/log/codec.h"
for unit in log/encode log/decode merge/record_place merge/common_time; do
  echo "#include \"recording/$unit.cc\""
done > "$work/all.cc"

try() { "$compiler" -std=c++20 -fsyntax-only "$@" -I"$sources" -I"$generated" "$work/all.cc" 2> "$work/said"; }
try "$@" || { echo "does not compile as it is:"; cat "$work/said"; exit 1; }
if try "$@" -I"$work"; then echo "compiles with a kind that stands in the list alone"; exit 1; fi
for words in "a kind of record that the log does not encode" "a kind of record that the log does not decode" \
             "a kind of record that has no place among the others" "a kind of record whose times the merge does not know"; do
  grep -q "$words" "$work/said" || { echo "nothing is said of $words:"; cat "$work/said"; exit 1; }
  echo "refused: $words"
done
grep -q "Unheard" "$work/said" || { echo "it is not said which:"; cat "$work/said"; exit 1; }
