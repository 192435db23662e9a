#!/usr/bin/env bash
# `ttfusion schedule synthesize --signals`: packings, their files, what stands, and one sentence for each mistake.
#   schedule_packing_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

signals=$source/examples/packing/signals.csv
grown=$source/examples/packing/grown_signals.csv
packed=(schedule synthesize --payload 8byte)
expect 0 '^5 static slots: proven to be the fewest' "${packed[@]}" --signals "$signals" -o "$work/packing.csv"
says '^chassis +15 +1\.598 +2 +2 +20\.1 ' '^wrote .*packing.csv: 5 slots$' '^body +1 +9 +25 +56 +118 +241 +486$'
[[ $(wc -l <"$work/packing.csv") -eq 45 ]] || fail "packing.csv has not a line for each signal"

# The same bytes again, from a packing as signals, too. Signals that stand do not move.
"$program" "${packed[@]}" --signals "$work/packing.csv" -o "$work/again.csv" >/dev/null 2>&1
cmp -s "$work/packing.csv" "$work/again.csv" || fail "a packing packed again is another one"
expect 0 '^44 signals stand at their places, 5 are new$' "${packed[@]}" --signals "$grown" --fixed "$work/packing.csv" \
  -o "$work/grown.csv"
head -45 "$work/grown.csv" | cmp -s - "$work/packing.csv" || fail "a signal that stands moved"
expect 0 'signal slip_warning is not among the signals .*; its place is free' "${packed[@]}" --signals "$signals" \
  --fixed "$work/grown.csv"

expect 0 '^3 static slots: proven' "${packed[@]}" --signals "$signals" --slot-multiplexing
expect 0 '^5 static slots, on both channels: proven' "${packed[@]}" --signals "$signals" --channels same -o "$work/same.csv"
grep -q '^rain,.*,AB$' "$work/same.csv" || fail "no signal is on both channels"
expect 0 '^3 static slots on the fuller channel: proven' "${packed[@]}" --signals "$signals" --channels independent
expect 0 '^2 of the 7 static slots given are free$' "${packed[@]}" --signals "$signals" --slots 7
expect 1 'need 5 static slots with numbers up to 5: slots must be 1..4, and no packing has fewer than 5$' \
  "${packed[@]}" --signals "$signals" --slots 4 -o "$work/none.csv"
[[ ! -e $work/none.csv ]] || fail "a packing without enough slots is written"
"$program" "${packed[@]}" --signals "$signals" --json >"$work/packing.json" || fail "a packing as JSON fails"
python3 - "$work/packing.json" <<'PY' || fail "a packing is no JSON"
import json, sys
found = json.load(open(sys.argv[1]))
assert (found["slots"], found["least_slots"], found["proven"]) == (5, 5, True), found
assert [part["slots"] for part in found["parts"]] == [2, 1, 1, 1], found
assert found["room"][3]["signals_by_repetition"][-1] == 486, found
PY

# A bus of it is consistent, and has the packing's slots.
expect 0 'bus.xml: 35 frames with signals, and 4 slots more: key slots, without signals$' "${packed[@]}" \
  --signals "$signals" --channels same --fibex "$work/bus.xml"
expect 0 '^signals: consistent$' schedule check "$work/bus.xml"
expect 0 '^signals: cycle of 5 ms, 5000 macroticks: static 9 x 35' schedule show "$work/bus.xml"

# Variants of a vehicle share one schedule. A further variant moves nothing.
variants=$source/examples/packing/variants.csv
expect 0 '^6 static slots: proven to be the fewest' "${packed[@]}" --signals "$variants" -o "$work/variants.csv" \
  --fibex "$work/variants.xml"
says '^as signals of one vehicle, all need 9 slots .*: the variants save 3$' '^sport +52 +3\.162 +6 +6 ' '^base +36 '
sed 's/^taxi_sign.*$/&\nflag,cab,5,,,30,parade\nanthem,horn,40,,,60,parade/' "$variants" >"$work/parade.csv"
expect 0 'in 4 variants in frames' "${packed[@]}" --signals "$work/parade.csv" --fixed "$work/variants.csv" -o "$work/parade_packed.csv"
says '^63 signals stand at their places, 2 are new$'
grep -v '^flag\|^anthem' "$work/parade_packed.csv" | cmp -s - "$work/variants.csv" || fail "a variant's signals move others"
expect 0 'bus_sport.xml: 39 frames with signals' "${packed[@]}" --signals "$variants" --fibex "$work/bus.xml"
for variant in sport estate base; do
  expect 0 '^variants: consistent$' schedule check "$work/bus_$variant.xml"
  expect 0 '^variants: cycle of 5 ms, 5000 macroticks: static 11 x' schedule show "$work/bus_$variant.xml"
done
"$program" "${packed[@]}" --signals "$variants" --json | python3 -c '
import json, sys
found = json.load(sys.stdin)
assert [one["slots"] for one in found["variants"]] == [6, 6, 5], found
assert (found["slots_as_one_vehicle"], found["slots"]) == (9, 6), found' || fail "variants are no JSON"

# The bus stands like the packing that it was made of. Those of variants stand together.
"$program" "${packed[@]}" --signals "$signals" -o "$work/packing.csv" --fibex "$work/stands.xml" >/dev/null 2>&1
expect 0 '^44 signals stand at their places, 5 are new$' "${packed[@]}" --signals "$grown" --fixed "$work/stands.xml" \
  -o "$work/grown_bus.csv"
cmp -s "$work/grown.csv" "$work/grown_bus.csv" || fail "a bus that stands is another packing than its signals"
expect 0 '^63 signals stand at their places, 0 are new$' "${packed[@]}" --signals "$source/examples/packing/variants.csv" \
  --fixed "$work/variants_sport.xml" --fixed "$work/variants_estate.xml" --fixed "$work/variants_base.xml" -o "$work/variants_again.csv"
cmp -s "$work/variants.csv" "$work/variants_again.csv" || fail "the buses of variants stand elsewhere than their signals"

# A slot that stands beyond those given leaves none of them free.
sed 's/^rain,\(.*\),[0-9]*,\([0-9]*\),\([0-9]*\),A$/rain,\1,20,\2,\3,A/' "$work/packing.csv" >"$work/far.csv"
expect 1 'need 6 static slots with numbers up to 20: slots must be 1..8, and no packing that keeps the places that stand' \
  "${packed[@]}" --signals "$signals" --fixed "$work/far.csv" --slots 8
"$program" "${packed[@]}" --signals "$signals" --fixed "$work/far.csv" --slots 8 2>/dev/null | grep -q 'given are free' &&
  fail "slots are free though they do not suffice"

# Signals without a place are named, and the others are packed.
expect 1 'signals.csv:17: signal tyre_pressure has no place: its 32 bits must fit a frame of 16 bits$' \
  schedule synthesize --signals "$signals" --payload 16bit -o "$work/narrow.csv"
grep -q '^tyre_pressure,chassis,320,0,320,32,,,,$' "$work/narrow.csv" || fail "a signal without a place has one"
printf 'signal,node,period_ms,release_ms,deadline_ms,bits\nlate,a,5,5,5,1\n' >"$work/late.csv"
expect 1 'late.csv:2: signal late has no place: a cycle of 5 ms must begin' schedule synthesize --signals "$work/late.csv"

printf 'signal,node,period_ms,bits\na,a,10,32\n' >"$work/slow.csv"
printf 'signal,node,period_ms,bits\na,a,0.08,32\nb,b,0.08,32\nc,c,0.08,32\n' >"$work/fast.csv"

mistake() {  # WORDS ARGS...
  expect 2 "$1" schedule synthesize "${@:2}"
}
mistake 'plan: must name a plan, or --signals the signals to pack'
mistake '--payload = 3 words: must be 1..2032bit or 1..254byte' --signals "$signals" --payload '3 words'
mistake '--payload = 255byte: must be' --signals "$signals" --payload 255byte
mistake '--cycle = 5: must be 0.01..16 ms with its unit' --signals "$signals" --cycle 5
mistake '--cycles = 48: must be 1, 2, 4, 8, 16, 32 or 64' --signals "$signals" --cycles 48
mistake 'period_ms = 320: must be a decimal number 5..160 ms' --signals "$signals" --cycles 32
mistake '--fibex = .*bus.xml: goes without --slot-multiplexing' --signals "$signals" --fibex "$work/bus.xml" \
  --payload 8byte --slot-multiplexing
mistake '--fibex = .*: goes with --channels one or same' --signals "$signals" --fibex "$work/bus.xml" --payload 8byte \
  --channels independent
mistake 'slots = [0-9]*: must fit the cycle of 80 macroticks' --signals "$work/fast.csv" --cycle 0.08ms --fibex "$work/bus.xml"
mistake '--fibex = .*: must be another file than that of --out' --signals "$signals" --payload 8byte \
  -o "$work/twice.xml" --fibex "$work/./twice.xml"
sed 's/^rain,\(.*\),[0-9]*,\([0-9]*\),\([0-9]*\),A$/rain,\1,0,\2,\3,A/' "$work/packing.csv" >"$work/zero.csv"
mistake 'zero.csv: slot = 0: must be 1 or more with --fibex' --signals "$signals" --payload 8byte \
  --fixed "$work/zero.csv" --fibex "$work/bus.xml"
printf 'signal,node,period_ms,bits,variants\na,a,5,8,base|\n' >"$work/half.csv"
mistake 'half.csv:2: variants = base|: must be names as in base|sport' --signals "$work/half.csv"
mistake '--fibex = .*bus_sport.xml: must be another file' --signals "$variants" --payload 8byte \
  -o "$work/bus_sport.xml" --fibex "$work/bus.xml"
mistake 'stands.xml:[0-9]*: gPayloadLengthStatic = 4: must be 2, for the 32 bits of --payload' --signals "$grown" \
  --fixed "$work/stands.xml"
mistake 'stands.xml:[0-9]*: cycle = 5 ms: must be 10 ms, as --cycle says' --signals "$work/slow.csv" --cycle 10ms \
  --payload 8byte --fixed "$work/stands.xml"
sed 's/^<fx:FIBEX .*/<fx:NONE>/' "$work/stands.xml" >"$work/damaged.xml"
mistake 'damaged.xml' --signals "$grown" --payload 8byte --fixed "$work/damaged.xml"
mistake '--out' --signals "$grown" --fixed "$work/packing.csv" --fixed "$work/stands.xml" -o "$work/stands.xml"
mistake '--channels' --signals "$signals" --channels two
mistake '--fixed' --fixed "$work/packing.csv"
mistake '--out' --signals "$signals" -o "$signals"
sed 's/^rain,\(.*\),[0-9]*,A$/rain,\1,63,A/' "$work/packing.csv" >"$work/moved.csv"
mistake 'moved.csv:4[0-9]: signal = rain: must have its 4 bits within the 64 of a frame' --signals "$signals" \
  --payload 8byte --fixed "$work/moved.csv"
mistake 'absent.csv' --signals "$work/absent.csv"
expect_full schedule synthesize --signals "$signals" --payload 8byte

[[ $failures -eq 0 ]] && echo "schedule synthesize --signals: all as documented"
exit $((failures > 0))
