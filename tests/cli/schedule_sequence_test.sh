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

# The best bound: its rows, and other assumptions.
best=(--sensors ABC --interest A --beta 400ms "${times[@]}" --best-beta)
expect 0 '^best bound: AaBC with a share of interest of 0.5$' schedule sequence "${best[@]}"
says '^ +138\.900  AaBC '
says '^ +0\.000  ABC +138\.900 +0\.6011 +0\.6011 +0\.6011'
says '^  with ten times the process noise: AaBC$'
expect 0 'is the last one tried' schedule sequence "${best[@]}" --share 1
expect 0 'process noise of 25 m' schedule sequence "${best[@]}" --process-noise 25 --sigma 0.5
"$program" schedule sequence "${best[@]}" --json >"$work/best.json" || fail "a best bound as JSON fails"
python3 - "$work/best.json" <<'PY' || fail "a best bound is no JSON"
import json, sys
found = json.load(open(sys.argv[1]))
assert found["best"] == min(found["choices"], key=lambda c: c["rms_m"]), found
assert len(found["best_with"]) == 5 and len(found["choices"]) == 11, found
PY

# Modes of a detector in a cluster: table 4's three frames.
modes=(--sensors ABC --interest A --beta 0ms "${times[@]}" --cluster "$source/schedules/closed_loop_synchronised.yaml")
expect 0 '^mode AaBaCa for a bound of 200 ms: a frame of 240 ms, 48 cycles$' schedule sequence "${modes[@]}" \
  --task camera_pre.preprocess --mode 200ms --mode 300ms
says '^  a +10 +0 +50.000 +77.700 +80.000$'
says '^consistent with closed_loop_synchronised: '
says '^  AaaBaaCaa then ABC +A ' "; lists wait for their detections' worst cases$"
expect 0 '; lists may leave when their detections end$' schedule sequence "${modes[@]}" --task camera_pre.preprocess \
  --mode 200ms --best-case 27.7ms
"$program" schedule sequence "${modes[@]}" --task camera_pre.preprocess --mode 200ms --json >"$work/modes.json" ||
  fail "modes as JSON fail"
python3 - "$work/modes.json" <<'PY' || fail "modes are no JSON"
import json, sys
found = json.load(open(sys.argv[1]))
assert [m["frame_cycles"] for m in found["modes"]] == [30, 48], found
assert [a["cycle"] for a in found["modes"][0]["activations"]] == [0, 10, 20], found
assert len(found["chains"]) == 2 and len(found["chains"][0]["bounds"]) == 12, found
PY

# As keys of a cluster's file: the shipped cluster has them.
planned=(--sensors ABC --interest A --beta 0ms --mode 260ms --primary 59ms --secondary 39ms --cluster adaptive_loop_synchronised
  --task detector.detect --offset 3500)
expect 0 '^          AaBaCa:$' schedule sequence "${planned[@]}" --yaml
says '^        activation: .kind: modes, base_cycle: 0, repetition: 2, offset: 3500.$'
python3 - "$output" "$source/schedules/adaptive_loop_modes.yaml" <<'PY' || fail "adaptive_loop_modes has other modes than those printed"
import sys
assert sys.argv[1] in open(sys.argv[2]).read()
PY
expect 0 '^camera_b -> detector.detect -> fusion.fuse -> ' schedule sequence "${planned[@]}"
says '^  AaBaCa then ABC +C '
[[ $(grep -Ec '^  ABC +[ABC] ' <<<"$output") -eq 3 ]] || fail "a chain has bounds of other cameras than its own: $output"

mistake() {  # WORDS ARGS...
  expect 2 "$1" schedule sequence "${@:2}"
}
mistake '--sensors = AbC: must be different capital letters, as in ABC' --sensors AbC --beta 200ms "${times[@]}"
mistake '--sensors = ABA: must be different capital letters' --sensors ABA --beta 200ms "${times[@]}"
mistake '--interest = D: must be different letters among ABC' --sensors ABC --interest D --beta 200ms "${times[@]}"
mistake '--interest = AA: must be different letters among ABC' --sensors ABC --interest AA --beta 200ms "${times[@]}"
mistake '--beta = 0.2: must be 0..100 s with its unit, as in 200ms' --sensors ABC --beta 0.2 "${times[@]}"
mistake '--primary = 0ms: must be 0.000001..10 s with its unit' --sensors ABC --beta 200ms --primary 0ms --secondary 1ms
mistake '--secondary = fast: must be 0.000001..0.001 s' --sensors ABC --beta 200ms --primary 1ms --secondary fast
mistake '--slots.*text' --sensors ABC --beta 200ms "${times[@]}" --slots ceil
mistake '--interest: must name a sensor' --sensors ABC --beta 200ms "${times[@]}" --best-beta
mistake '--share = 2: must be a decimal number 0..1' "${best[@]}" --share 2
mistake '--sigma = nan: must be' "${best[@]}" --sigma nan
mistake '--share' --sensors ABC --beta 200ms "${times[@]}" --share 0.4
mistake '--task = camera_pre: must be a node and its task in' "${modes[@]}" --task camera_pre
mistake '--step = 7 ms: must be a multiple of the communication cycle, 5 ms' "${modes[@]}" \
  --task camera_pre.preprocess --step 7ms
mistake '--offset = 5000: must be 0..4999 macroticks' "${modes[@]}" --task camera_pre.preprocess --offset 5000
mistake 'those of two detections may be 7\.[0-9]+ ms apart' "${modes[@]}" --task camera_pre.preprocess --mode 200ms \
  --best-case 5ms
mistake '--best-case = 30ms: must be 0..0.0277 s with its unit' "${modes[@]}" --task camera_pre.preprocess \
  --best-case 30ms
mistake '--primary = 50 ms: must end .* before its steps of 50 ms do' --sensors ABC --beta 0ms --primary 50ms \
  --secondary 20ms --cluster closed_loop_synchronised --task camera_pre.preprocess
mistake '--cluster' "${modes[@]}"
mistake '--yaml' "${planned[@]}" --yaml --json
mistake '--yaml = camera_pre.preprocess: needs a task that reads a list of each of the 3 cameras' "${modes[@]}" \
  --task camera_pre.preprocess --yaml
mistake '--primary' --sensors ABC --beta 200ms --secondary 1ms

[[ $failures -eq 0 ]] && echo "schedule sequence: all as documented"
exit $((failures > 0))
