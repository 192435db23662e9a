#!/usr/bin/env bash
# `ttfusion schedule sequence`: table 4's frames, the result as JSON, and one sentence for each mistake.
#   schedule_sequence_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

times=(--primary 46.3ms --secondary 27.7ms)
expect 0 '^ABC: a frame of 138.9 ms, 138.9 ms above the bound of 0 ms$' \
  schedule sequence --sensors ABC --interest A --beta 0ms "${times[@]}"
expect 0 '^AaBaCa: a frame of 222 ms, 22 ms above the bound of 200 ms$' \
  schedule sequence --sensors ABC --interest A --beta 200ms "${times[@]}"
says '^A +4 +55\.500 +19\.634$'
says '^best order of these detections: this one$'
expect 0 '^AaaBaaCaa: a frame of 305.1 ms, ' schedule sequence --sensors ABC --interest A --beta 300ms "${times[@]}"
expect 0 '^AaBCa: ' schedule sequence --sensors ABC --interest A --beta 200ms "${times[@]}" --slots floor
expect 0 '^ABaCa: ' schedule sequence --sensors ABC --interest A --beta 200ms "${times[@]}" --slots floor --order reversed
expect 0 '^FfRfLf: ' schedule sequence --sensors FRL --interest F --beta 200ms "${times[@]}"
expect 0 '^best order of these detections: AbCacBc, with a deviation of 8.405 ms instead of 53.683 ms$' \
  schedule sequence --sensors ABC --interest ABC --beta 222.1ms "${times[@]}"
expect 0 'more than 1000000 orders' schedule sequence --sensors ABCDE --interest ABC --beta 0.5s "${times[@]}"
"$program" schedule sequence --sensors ABC --interest B --beta 200ms "${times[@]}" --json >"$work/sequence.json" ||
  fail "a sequence as JSON fails"
python3 - "$work/sequence.json" <<'PY' || fail "a sequence is no JSON"
import json, sys
frame = json.load(open(sys.argv[1]))
assert (frame["sequence"], frame["frame_ms"], frame["bound_ms"]) == ("AbBbCb", 222, 200), frame
assert [s["detections"] for s in frame["sensors"]] == [1, 4, 1], frame
assert frame["best"] == {"sequence": "AbBbCb", "deviation_ms": frame["deviation_ms"]}, frame
PY

mistake() {  # WORDS ARGS...
  expect 2 "$1" schedule sequence "${@:2}"
}
mistake '--sensors = AbC: must be different capital letters, as in ABC' --sensors AbC --beta 200ms "${times[@]}"
mistake '--sensors = ABA: must be different capital letters' --sensors ABA --beta 200ms "${times[@]}"
mistake '--interest = D: must be different letters among ABC' --sensors ABC --interest D --beta 200ms "${times[@]}"
mistake '--interest = AA: must be different letters among ABC' --sensors ABC --interest AA --beta 200ms "${times[@]}"
mistake '--beta = 0.2: must be 0..100 s with its unit, as in 200ms' --sensors ABC --beta 0.2 "${times[@]}"
mistake '--primary = 0ms: must be 0.000001..10 s with its unit' --sensors ABC --beta 200ms --primary 0ms --secondary 1ms
mistake '--secondary = fast: must be 0.000001..10 s' --sensors ABC --beta 200ms --primary 1ms --secondary fast
mistake '--slots.*text' --sensors ABC --beta 200ms "${times[@]}" --slots ceil
mistake '--primary' --sensors ABC --beta 200ms --secondary 1ms

[[ $failures -eq 0 ]] && echo "schedule sequence: all as documented"
exit $((failures > 0))
