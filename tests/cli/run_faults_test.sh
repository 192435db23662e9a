#!/usr/bin/env bash
# `ttfusion run` of scenarios with faults: their effects, in words and as JSON; the examples of their pages.
#   run_faults_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/shipped.sh"

# A drive with faults reports their effects, in words and as JSON; one without does not mention faults.
tt=(--strategy tt --no-log --out "$work/f")
expect 0 'byzantine_clock +laser_pre' run "$source/scenarios/faulty_bus.yaml" "${tt[@]}"
says '^1 fault-free node to the end: fusion$' '^    discarded: no time measured +1$' 'No fault-free node was harmed'
expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy tt --no-log --out "$work/sound"
python3 - "$work/f/summary.json" "$work/sound/summary.json" <<'PY' || fail "the JSON does not say what the faults did"
import json, sys
faults = json.load(open(sys.argv[1]))["strategies"][0]["faults"]
assert [f["kind"] for f in faults][3] == "crash" and faults[3]["node"] == "camera_pre" and faults[3]["ends_s"] > 1.7, faults
assert all(f["acts"] > 0 and not f["harmed"] and f["harms"] == [] for f in faults), faults
assert any(c["check"] == "boundary" and c["cycles"] > 0 for c in faults[4]["checks"]), faults[4]
assert json.load(open(sys.argv[1]))["strategies"][0]["fault_free_nodes"] == ["fusion"]
assert "faults" not in json.load(open(sys.argv[2]))["strategies"][0]
PY

# In a cold drive no node is active at first, which is no harm. A node that never becomes active is harmed.
cold=$work/scenarios/cold_start.yaml
printf 'faults:\n  - {kind: noise, channels: A, length: 1 us, interval: 500 ms}\n' >>"$cold"
expect 0 'No fault-free node was harmed' run "$cold" "${tt[@]}"
sed -i 's/channels: A, length: 1 us, interval: 500 ms/length: 1 ms, interval: 0 ms/' "$cold"
expect 1 'HARMED by fault 0, .*never became normal active' run "$cold" "${tt[@]}"
# For a cluster that never started, the table shows failure, and no perfect values.
says '^uses of an image +0$' '^objects compared / missed / spurious +0 / - / -$' '^precision of the time base \[us\] +-$'
expect 1 '^error: with tt no node ever became active: laser_pre, camera_pre, fusion, feature, laser, camera$' \
  run "$cold" --no-log --out "$work/cold"

# Lost frames are counted, in any slot and of any sender.
drowned=$work/scenarios/paper_scenario1.yaml
printf 'faults:\n  - {kind: transient, from: 1 s, duration: 4 ms}\n' >>"$drowned"
expect 0 \
  'HARMED by fault 0, 1\.0[0-9]+ s: fusion: [0-9]+ frames lost on all channels, the first: slot [0-9]+ of [a-z_]+$' \
  run "$drowned" "${tt[@]}"

# The pages' examples of a scenario load as they stand, and so do their keys.
page_example() \
  { awk -v key="    $2:" '$0 == key { on = 1 } on && !/^    / { exit } on { print substr($0, 5) }' "$source/docs/$1"; }
for example in faults startup; do
  page=reference/faults
  [[ $example == faults ]] || page=schedules/flexray_constraints
  cp "$source/scenarios/paper_scenario1.yaml" "$work/scenarios/page.yaml"
  page_example $page.md $example >>"$work/scenarios/page.yaml"
  grep -q "^$example:" "$work/scenarios/page.yaml" || fail "docs/$page.md has no example of $example"
  [[ $example == startup ]] || sed -i 's/^duration: .*/duration: 3 s/' "$work/scenarios/page.yaml"
  expect 0 'precision of the time base' run "$work/scenarios/page.yaml" "${tt[@]}"
done
for keys in 'feature_service: {max_image_age: 100 ms}' 'tracker: {coast_after: 300 ms, delete_after: 1 s}'; do
  inner=${keys#*\{}
  for key in "${keys%%:*}" "${inner%%:*}"; do
    grep -q "\`$key\`" "$source/docs/reference/faults.md" || fail "docs/reference/faults.md does not name $key"
  done
  # A scenario has each key once.
  (sed '/^tracker:/,$d' "$work/scenarios/paper_scenario2.yaml" && echo "$keys") >"$work/scenarios/page.yaml"
  expect 0 'precision of the time base' run "$work/scenarios/page.yaml" "${tt[@]}"
done

# The guardians' interventions are reported, and are a check.
guarded=$work/scenarios/cold_start.yaml
cp "$source/scenarios/cold_start.yaml" "$guarded"
printf 'faults:\n  - {kind: babbling_idiot, node: feature, channels: B, interval: 1 ms, from: 2 s, duration: 50 ms}\n' >>"$guarded"
expect 0 '^0 +guardian +26 .*guardian B' run "$guarded" "${tt[@]}"
says '^0 +blocked +[0-9]+ +[0-9]+ +2\.0'
python3 - "$work/f/summary.json" <<'PY' || fail "the JSON does not say what the guardians did"
import json, sys
run = json.load(open(sys.argv[1]))["strategies"][0]
kept = run["faults"][0]["guardians"]
assert sum(k["signals"] for k in kept) == 50 and all(k["what"] == "blocked" and k["why"] for k in kept), kept
assert run["unattributed"] == {"checks": [], "guardians": [], "states": [], "harmed": False, "harms": []}, run["unattributed"]
PY

[[ $failures -eq 0 ]] && echo "run faults: all as documented"
exit $((failures > 0))
