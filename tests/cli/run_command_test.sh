#!/usr/bin/env bash
# `ttfusion run`: mistakes in a scenario, results, and results that cannot be written.
#   run_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/shipped.sh"

expect 0 "Examples: ttfusion run" run --help
expect 2 "nothing.yaml: cannot be read" run "$work/nothing.yaml"

for seed in 12x 010x 4611686018427387905 99999999999999999999999; do
  expect 2 '--seed.*must be a whole number 0..4611686018427387904' run "$source/scenarios/paper_scenario1.yaml" \
    "--seed=$seed"
done

drive=$work/scenarios/broken.yaml
mutate scenarios/paper_scenario1.yaml 's|^name: .*|name: ../elsewhere|' "$drive"
expect 2 'name = ../elsewhere: must name a folder' run "$drive"
mutate scenarios/paper_scenario1.yaml 's/^seed: 1/seed: one/' "$drive"
expect 2 'broken.yaml:3: seed = one: must be a whole number' run "$drive"
mutate scenarios/paper_scenario1.yaml 's/^seed: 1/sede: 1/' "$drive"
expect 2 'broken.yaml:3: sede: is not a known key' run "$drive"
mutate scenarios/paper_scenario1.yaml 's/reference: true/reference: true\n      x: 3/' "$drive"
expect 2 'is given twice' run "$drive"
head -c 300 "$source/scenarios/paper_scenario1.yaml" >"$drive"
expect 2 'broken.yaml' run "$drive"
mutate scenarios/paper_scenario1.yaml 's/paper_synchronised.yaml/absent.yaml/' "$drive"
expect 2 'absent.yaml: must be a cluster file, but it cannot be read' run "$drive" --strategy tt --out "$work/none"

late() { mutate scenarios/paper_scenario1.yaml "s/^tracker:.*/tracker:\n  late: $1/; /^  motion: ctra/d" "$drive"; }
late never
expect 2 'broken.yaml:[0-9]+: tracker.late = never: must be one of rewind, augmented, clone, adjoint, al1' run "$drive"
late al1
expect 2 'broken.yaml:[0-9]+: tracker.late = al1: must be rewind or clone with strategy tt' run "$drive" --out "$work/none"
late clone
expect 2 'broken.yaml:[0-9]+: tracker.late = clone: must not be clone if a sensor measures freely' \
  run "$drive" --strategy adva --out "$work/none"
expect 2 'broken.yaml:[0-9]+: tracker.late = clone: must not be clone if a sensor measures freely' \
  launch "$drive" --strategy adva --dry-run --out "$work/none"
late 'augmented\n  motion: ctrv'
expect 2 'broken.yaml:[0-9]+: tracker.late = augmented: must be rewind unless motion is constant_velocity' run "$drive"
mutate scenarios/paper_scenario1.yaml 's/^reference: .*/&\nsensors:\n  laser2: {kind: laser, mounting: {y: 0.9}}/' "$drive"
for command in run 'launch --dry-run'; do
  expect 2 'broken.yaml:[0-9]+: sensors.laser2: must be a sensor of .*/paper_synchronised.yaml: laser or camera' \
    $command "$drive" --strategy tt --out "$work/none"
done
[[ ! -e $work/none ]] || fail "what is refused leaves a folder behind"

expect 0 '' run "$source/scenarios/two_lasers.yaml" --strategy tt --no-pictures --out "$work/named"
expect 0 '' diagram "$work/named/tt.mcap" --kind plane -o "$work/named.svg"
grep -q '#009e73' "$work/named.svg" || fail "the right laser of two_lasers.yaml is not green"

# A run, twice: the same bytes; another seed: other bytes.
expect 0 'position RMSE' run "$source/scenarios/paper_scenario2.yaml" --out "$work/a" --seed 3
expect 0 '"content_hash"' run "$source/scenarios/paper_scenario2.yaml" --out "$work/b" --seed 3 --json --no-pictures
expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --out "$work/c" --seed 4 --no-pictures
for strategy in buff adva tt; do
  cmp -s "$work/a/$strategy.mcap" "$work/b/$strategy.mcap" || fail "$strategy: same seed, other log"
  cmp -s "$work/a/$strategy.mcap" "$work/c/$strategy.mcap" && fail "$strategy: other seed, same log"
done
for file in index.html summary.json tt_timing.svg tt_timing.png tt_timing.pdf adva_plane.svg buff_over_time.pdf \
  comparison.png; do
  [[ -s $work/a/$file ]] || fail "run leaves no $file"
done
"$program" run "$source/scenarios/paper_scenario1.yaml" --strategy tt --no-log --json --out "$work/j" 2>/dev/null |
  python3 -c 'import json,sys; s=json.load(sys.stdin)["strategies"][0]; assert s["rmse_truth"]["position_m"] < 0.5, s; assert s["precision_us"] > 0' ||
  fail "--json is not the documented JSON"

# Another duration, as for a launch. The drive's own one changes nothing.
expect 2 "--duration = 1: must be a decimal number 1.5..3600 s \(.*paper_scenario1.yaml is evaluated from 1.5 s on\)" \
  run "$source/scenarios/paper_scenario1.yaml" --duration 1
short=(run "$source/scenarios/paper_scenario2.yaml" --strategy tt --no-pictures)
expect 0 'paper_scenario2: 1.6 s with tt' "${short[@]}" --duration 1.6 --out "$work/short"
grep -q '"duration_s": 1.6' "$work/short/summary.json" || fail "the summary has another duration than the drive"
expect 0 'paper_scenario2: 3 s with tt' "${short[@]}" --duration 3 --seed 3 --out "$work/whole"
cmp -s "$work/a/tt.mcap" "$work/whole/tt.mcap" || fail "a given duration that is the scenario's makes another log"

# Several scenarios: folders of their own, one table, the results of each by itself.
both=("$source/scenarios/paper_scenario1.yaml" "$source/scenarios/paper_scenario2.yaml")
expect 0 '^ +paper_scenario1 +paper_scenario2$' run "${both[@]}" --strategy tt --no-pictures --seed 3 --out "$work/both"
says '^measure +tt +tt$' '^paper_scenario1: A car ahead' "^wrote $work/both/paper_scenario1$" "^wrote $work/both/paper_scenario2$"
cmp -s "$work/a/tt.mcap" "$work/both/paper_scenario2/tt.mcap" || fail "a scenario beside another one has another log"
"$program" run "${both[@]}" --no-log --json --duration 1.6 --out "$work/all" 2>/dev/null | python3 -c 'import json, sys
reported = json.load(sys.stdin)
assert [one["scenario"] for one in reported] == ["paper_scenario1", "paper_scenario2"], reported
assert [len(one["strategies"]) for one in reported] == [3, 3]' || fail "--json of two scenarios is no list of both"
expect 0 '' run "${both[@]}" --no-log --duration 1.6 --out "$work/all"
awk 'length > 100' <<<"$output" | grep -v '^paper_scenario' && fail "a table of two scenarios is wider than 100 columns"
[[ $(grep -c '^measure ' <<<"$output") -eq 2 ]] || fail "two scenarios with three strategies are not two blocks"
expect 2 'paper_scenario1.yaml: name = paper_scenario1: must differ from that of .*paper_scenario1.yaml: each has a folder' \
  run "${both[0]}" "${both[0]}" --out "$work/none"
expect 2 '--input = x.txt: goes with one scenario' run "${both[@]}" --input x.txt --out "$work/none"
expect 2 'absent.yaml: cannot be read' run "${both[0]}" "$work/absent.yaml" --out "$work/none"
[[ ! -e $work/none ]] || fail "a set of scenarios that is refused leaves a folder behind"

# Without a comparison (judgement starts after the end) there is a dash and a null, instead of a perfect zero.
sed -e 's/^evaluate_from: .*/evaluate_from: 3 s/' \
  "$source/scenarios/paper_scenario1.yaml" >"$work/scenarios/unjudged.yaml"
expect 0 'position RMSE against truth \[m\] +-$' run "$work/scenarios/unjudged.yaml" --strategy tt \
  --no-log --out "$work/u"
says '  95 % band +-$'
python3 - "$work/u/summary.json" <<'PY' || fail "where nothing was compared, the JSON has no null"
import json, sys
s = json.load(open(sys.argv[1]))["strategies"][0]
assert s["objects"]["compared"] == 0, s
assert set(s["rmse_truth"].values()) == {None}, s
assert s["rmse_reference"] == {"position_m": None, "velocity_mps": None, "compared": 0}, s
assert s["nees"]["mean"] is None and s["nees"]["band_95"] == [None, None], s
assert s["age_when_used"] == {"count": 0, "mean_ms": None, "worst_ms": None}, s
PY

# A failure to write is reported, and the run has failed.
: >"$work/file"
expect 1 'error: .*/file/x: cannot be created: Not a directory' run "$source/scenarios/paper_scenario2.yaml" \
  --out "$work/file/x"
mkdir -p "$work/w1/summary.json" "$work/w2/tt.mcap" "$work/w3/index.html" "$work/w4/tt_timing.png"
tt=(run "$source/scenarios/paper_scenario2.yaml" --strategy tt --duration 1.6)
expect 1 'error: .*/w1/summary.json: cannot be written: Is a directory' "${tt[@]}" --no-log --out "$work/w1"
expect 1 'error: .*/w2/tt.mcap: cannot be created: Is a directory' "${tt[@]}" --out "$work/w2"
# The folders of several scenarios are tried before the first drive.
mkdir "$work/several"
touch "$work/several/paper_scenario2"
expect 1 'error: .*/several/paper_scenario2: cannot be created: ' \
  run "$source"/scenarios/paper_scenario{1,2}.yaml --strategy tt --out "$work/several"
[[ ! -e $work/several/paper_scenario1 ]] || fail "a drive went before a folder that cannot be created"
expect 1 'error: .*/w3/index.html: cannot be written' "${tt[@]}" --out "$work/w3"
expect 1 'error: .*/w4/tt_timing.png: cannot be written' "${tt[@]}" --out "$work/w4"
expect_full "${tt[@]}" --no-log --out "$work/w5"

# Errors in a scenario are found before an earlier run's log is overwritten.
mkdir "$work/kept" && echo "an earlier log" >"$work/kept/tt.mcap"
sed "s#\.\./schedules#$source/schedules#; 0,/node: camera_pre/s//node: camera_per/" \
  "$source/scenarios/faulty_bus.yaml" >"$work/typo.yaml"
expect 2 'camera_per: must be a node' run "$work/typo.yaml" --strategy tt --out "$work/kept"
[[ $(cat "$work/kept/tt.mcap") == "an earlier log" ]] || fail "a run that was refused has written over a log"

[[ $failures -eq 0 ]] && echo "run command: all as documented"
exit $((failures > 0))
