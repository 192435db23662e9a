#!/usr/bin/env bash
# `ttfusion schedule check` and `show`: a cluster by itself, and on CAN FD.
#   schedule_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/shipped.sh"

schedule=$source/schedules/paper_synchronised.yaml
cluster=$work/schedules/broken.yaml
mutate schedules/paper_synchronised.yaml 's/gdNIT: [0-9]*/gdNIT: 100/' "$cluster"
"$program" schedule check "$cluster" --json 2>"$work/words" >"$work/check.json"
[[ $? -eq 2 ]] || fail "an inconsistent cluster as JSON does not exit with 2"
grep -q '^error: .*broken.yaml:[0-9]*: .*gdNIT' "$work/words" || fail "an inconsistent cluster as JSON has no words"
python3 - "$work/check.json" <<'PY' || fail "an inconsistent cluster is no JSON"
import json, sys
check = json.load(open(sys.argv[1]))
assert check["consistent"] is False and check["findings"], check
assert all(f["line"] > 0 and f["file"].endswith("broken.yaml") and f["text"].endswith(f["expected"]) for f in check["findings"]), check
PY
expect 0 'consistent' schedule check "$schedule"
mutate schedules/paper_synchronised.yaml 's/gdNIT: 386/gdNIT: 900/' "$cluster"
expect 2 'broken.yaml:[0-9]+: flexray.gdNIT = 900: .*2..805' schedule check "$cluster"
mutate schedules/paper_synchronised.yaml 's/gdNIT: 386/gdNIT: 380/' "$cluster"
expect 2 'gdNIT|gMacroPerCycle' schedule check "$cluster"
mutate schedules/paper_synchronised.yaml 's/step: laser_preprocessing/step: lazer_preprocessing/' "$cluster"
expect 2 'lazer_preprocessing' schedule check "$cluster"
expect 0 'laser_objects' schedule show "$schedule"
expect 0 '^wrote .*/schedule.svg$' schedule show "$schedule" -o "$work/schedule.svg"
[[ -s $work/schedule.svg ]] || fail "schedule show -o writes no picture"
expect 0 '' schedule show "$schedule" -o "$work/paper.svg" --width 18cm --font-size 7
grep -q '<svg [^>]*width="180.0000mm"' "$work/paper.svg" || fail "the picture of a schedule is not 180 mm wide"
expect 2 '--width = 18cm: goes with --out only' schedule show "$schedule" --width 18cm
mutate schedules/paper_synchronised.yaml 's/fragment_bytes: 8$/fragment_bytes: 12/' "$cluster"
expect 2 \
  'broken.yaml:[0-9]+: can.camera_can.messages\[0\] = 12 bytes: must fit a frame of this CAN, at most 8 bytes' \
  schedule show "$cluster"
expect 2 'png' schedule show "$schedule" -o "$work/schedule.bmp"
: >"$work/file"
expect 1 'error: .*/file/x.svg: cannot be written' schedule show "$schedule" -o "$work/file/x.svg"
expect_full schedule show "$schedule"

# A file that extends another: its findings name the file of a value. The derived values are shown and exported.
printf 'extends: paper_synchronised.yaml\nname: heir\nflexray: {gdNIT: ~}\n' >"$work/schedules/heir.yaml"
expect 0 '^heir: consistent$' schedule check "$work/schedules/heir.yaml"
expect 0 '^  flexray: gdNIT = 386$' schedule show "$work/schedules/heir.yaml"
expect 0 '^wrote .*/whole.yaml$' schedule export "$work/schedules/heir.yaml" --format yaml -o "$work/whole.yaml"
grep -q '^  gdNIT: 386$' "$work/whole.yaml" || fail "the whole file lacks the derived gdNIT"
grep -q '^# heir.yaml with all that it inherits and derives.$' "$work/whole.yaml" || fail "the whole file lacks its origin"
! grep -q '^extends' "$work/whole.yaml" || fail "the whole file extends another"
expect 0 '^heir: consistent$' schedule check "$work/whole.yaml"
# An experiment varies what the file inherits and leaves out. The rest follows.
cat >"$work/slots.yaml" <<'END'
kind: sweep
name: slots
question: Does a derived value follow?
scenario: scenarios/dynamics.yaml
seed: 1
replications: 1
paradigms: {tt: {strategy: tt, cluster: schedules/heir.yaml}}
axes: {slots: {settings: {38: {cluster.flexray.gNumberOfStaticSlots: "38"}, 40: {cluster.flexray.gdNIT: "386"}}}}
measures: [position_rmse_truth]
END
expect 0 '^40 +1 ' experiment "$work/slots.yaml" --out "$work/slots" --jobs 1
sed -i 's/"386"/"385"/' "$work/slots.yaml"
expect 2 'paper_synchronised.yaml:[0-9]+: flexray.gMacroPerCycle = 5000: must be 4999 macroticks' \
  experiment "$work/slots.yaml" --out "$work/wrong" --jobs 1
printf 'extends: paper_synchronised.yaml\nname: heir\nflexray: {gdBit: 0.2, gListenNoise: 99}\n' >"$work/schedules/heir.yaml"
expect 2 'heir.yaml:3: flexray.gListenNoise = 99: must be a whole number 2..16' schedule check "$work/schedules/heir.yaml"
printf 'extends: heir.yaml\n' >"$work/schedules/heir.yaml"
expect 2 'heir.yaml:1: extends = heir.yaml: must not lead back' schedule check "$work/schedules/heir.yaml"

# Chains from a picture to the actuator, with and without its dead time.
loop=$source/schedules/closed_loop_synchronised.yaml
expect 0 '^camera -> .* -> fusion.fuse -> feature.cruise -> actuator.act \(exact\)$' schedule check "$loop"
says "the actuator's dead time \(--scenario\)"
expect 0 '^    the actuator.s dead time +50.000 +50.000$' schedule check "$loop" --scenario "$source/scenarios/acc_braking_lead.yaml"
expect 2 '--scenario = .*: must have a vehicle with world.ego.actuator' schedule check "$loop" \
  --scenario "$source/scenarios/paper_scenario1.yaml"
"$program" schedule check "$loop" --json --scenario "$source/scenarios/acc_braking_lead.yaml" >"$work/loop.json" ||
  fail "a loop as JSON fails"
python3 - "$work/loop.json" <<'PY' || fail "the chains of a loop are wrong"
import json, sys
chains = json.load(open(sys.argv[1]))["chains"]
assert len(chains) == 6 and all(c["exact"] and c["dead_time_ms"] == 50 for c in chains), chains
for c in chains:
    best, worst = c["reduced_reaction_time_ms"]
    assert best < worst < c["reaction_time_worst_ms"], c
    assert abs(c["reaction_time_worst_ms"] - c["data_age_worst_ms"] - 50) < 1e-6, c
    assert abs(sum(p["worst_ms"] for p in c["contributions"]) + 50 - worst) < 1e-6, c
PY

# A detector looks at some pictures only: its chains have no bound from the event on.
loop=$source/schedules/adaptive_loop_synchronised.yaml
expect 0 '^  picture looked at to first command  ' schedule check "$loop"
says '^.ttfusion schedule sequence --cluster. has one for a table of detections.$'
"$program" schedule check "$loop" --json >"$work/loop.json" || fail "a loop with a detector as JSON fails"
python3 - "$work/loop.json" <<'PY' || fail "the chains through a detector have false bounds"
import json, sys
check = json.load(open(sys.argv[1]))
unknown = ["reaction_time_worst_ms", "reduced_data_age_worst_ms", "data_age_worst_ms"]
for c in check["chains"]:
    assert c["reduced_reaction_time_ms"][1] > 0, c
    assert all((c[key] is None) == c["sensor"].startswith("camera") for key in unknown), c
for a in check["ages"]:
    assert (a["newest_at_any_use_worst_ms"] is None) == a["sensor"].startswith("camera"), a
PY

# Its modes bound them.
loop=$source/schedules/adaptive_loop_modes.yaml
expect 0 '^modes of detector.detect: A camera_a B camera_b C camera_c$' schedule check "$loop"
says '^mode AaBaCa: AaBaCa, a frame of 300 ms, 60 cycles$' '^  ABC then AaBaCa +A ' '^How often .* bounds from the event on follow by mode\.$'
expect 0 '^ +mode ABC: 36 cycles: camera_a at 0, camera_b at 12, camera_c at 24$' schedule show "$loop"
"$program" schedule check "$loop" --json >"$work/modes.json" || fail "a cluster with modes as JSON fails"
python3 - "$work/modes.json" <<'PY' || fail "modes have false bounds"
import json, sys
(task,) = json.load(open(sys.argv[1]))["modes"]
assert task["task"] == "detector.detect" and [m["frame_cycles"] for m in task["modes"]] == [36, 60], task
assert [len(c["bounds"]) for c in task["chains"]] == [4, 4, 4], task
for c in task["chains"]:
    for b in c["bounds"]:
        assert b["reduced_reaction_time_ms"][1] < b["reaction_time_in_region_ms"] <= b["reaction_time_ms"], b
        assert c["chain"].startswith(b["camera"]), c
PY

# On real CAN FD: the failing rules, and the time scale at which all hold.
expect 1 'paper_synchronised on can-fd:1M/5M at time scale 1: 34 of 34 slots do not hold' schedule check "$schedule" \
  --medium can-fd:1M/5M
says '^ +1-5  AB +2 +232.2 +84.0$'
expect 1 '^smallest time scale at which all hold: 2.764286$' schedule check "$schedule" --medium can-fd:1000k/5000000
expect 0 'at time scale 2.764286: all 34 slots hold$' schedule check "$schedule" --medium can-fd:1M/5M \
  --time-scale 2.764286
expect 1 'at time scale 2.764285: 5 of 34 slots do not hold$' schedule check "$schedule" --medium can-fd:1M/5M \
  --time-scale 2.764285
expect 1 '^ +21-24  AB +1 +168.6 +84.0  dynamic$' schedule check "$source/schedules/flexray_demo.yaml" \
  --medium can-fd:1M/5M
mutate schedules/paper_synchronised.yaml 's/late: 500 us/late: 168599 ns/' "$cluster"
expect 1 '^every frame of 168.6 us comes too late: real_time.late is 168.599 us' schedule check "$cluster" \
  --medium can-fd:1M/5M --time-scale 3
expect 0 'all 34 slots hold' schedule check "$schedule" --medium can-fd:1M/5M \
  --time-scale 3
"$program" schedule check "$source/schedules/flexray_demo.yaml" --medium can-fd:0.5M/8M --time-scale 2.5 \
  --json >"$work/medium.json"
[[ $? -eq 1 ]] || fail "slots that do not hold, as JSON, do not exit with 1"
python3 - "$work/medium.json" <<'PY' || fail "slots that do not hold are no JSON"
import json, sys
check = json.load(open(sys.argv[1]))
assert check["holds"] is False and check["time_scale"] == 2.5 and check["smallest_time_scale"] == 4.3175, check
assert (check["nominal_bit_rate"], check["data_bit_rate"], check["slots"]) == (500000, 8000000, 14), check
static = [slot for slot in check["not_holding"] if slot["segment"] == "static"]
assert [slot["slot"] for slot in static] == list(range(1, 11)), static
assert static[0] == {"slot": 1, "segment": "static", "channels": "AB", "can_frames": 2, "needs_us": 215.875, "has_us": 125.0}, static
assert check["late_us"] is None and check["window_holds"] is True, check
PY
for medium in "" can-fd can-fd: can-fd:1M can-fd:1M/ can-fd:/5M can-fd:2M/5M can-fd:1M/8000001 can-fd:1M/0.9M \
  can-fd:9999/1M can-fd:1m/5M can-fd:1M/5M/2M dds vcan0; do
  expect 2 "--medium( = .*)?: must be can-fd:NOMINAL/DATA in bit/s, as in can-fd:1M/5M" schedule check "$schedule" \
    --medium "$medium"
done
expect 2 '--medium = can:1M: must be can-fd: a frame of classic CAN holds 8 bytes' schedule check "$schedule" \
  --medium can:1M
expect 2 '--time-scale = 0.05: must be a decimal number 0.1..1000' schedule check "$schedule" --medium can-fd:1M/5M \
  --time-scale 0.05
expect 2 '--time-scale: goes with --medium only' schedule check "$schedule" --time-scale 2
expect 2 '--against: must not be given with --medium' \
  schedule check "$schedule" --medium can-fd:1M/5M --against "$work/drive.pcapng"
expect 0 'schedule check .* --medium can-fd:1M/5M --time-scale 3' schedule check --help

# Lists on CANs with errors.
expect 0 '^paper_fitted: all lists are sent in time with errors on a CAN 10 ms apart or more$' \
  schedule check "$source/schedules/paper_fitted.yaml" --can-errors 10ms
says '^laser_scan +laser_can +34.000 +15.676 +16.075$' '^camera_frame +camera_can +34.000 +5.396 +5.562$'
expect 1 '^laser_scan +laser_can +34.000 +15.676 +-  late$' schedule check "$source/schedules/paper_fitted.yaml" \
  --can-errors 0.2ms
says '^paper_fitted: not all lists are sent in time with errors on a CAN 0.2 ms apart or more$'
# Names of any length leave the columns in line.
sed -i 's/laser_scan/scan_of_the_laser_in_front/; s/laser_can/can_of_the_laser_in_front/' "$work"/schedules/paper_{synchronised,fitted}.yaml
expect 0 '^scan_of_the_laser_in_front +can_of_the_laser_in_front ' schedule check "$work/schedules/paper_fitted.yaml" \
  --can-errors 10ms
awk 'NR > 1 { bad += last && length != last; last = length } END { exit bad > 0 }' <<<"$output" || fail "columns are out of line: $output"
cp "$source"/schedules/paper_{synchronised,fitted}.yaml "$work/schedules"
"$program" schedule check "$source/schedules/paper_fitted.yaml" --can-errors 10ms --json >"$work/errors.json" ||
  fail "CANs with errors fail as JSON"
python3 - "$work/errors.json" <<'PY' || fail "CANs with errors are wrong as JSON"
import json, sys
check = json.load(open(sys.argv[1]))
assert check["holds"] is True and check["errors_apart_ms"] == 10, check
laser, camera = check["lists"]
assert laser["list"] == "laser_scan" and laser["in_time"] and laser["without_errors_ms"] < laser["with_errors_ms"], laser
PY
expect 2 '--can-errors = 10: must be the least time between two errors with its unit, as in 10ms: 1us..1000s' \
  schedule check "$source/schedules/paper_fitted.yaml" --can-errors 10
expect 2 'must not be given with' schedule check "$source/schedules/paper_fitted.yaml" --can-errors 10ms --medium can-fd:1M/5M

# The whole file, on standard output and as a file, is what the export writes.
"$program" schedule export paper_fitted --format yaml >"$work/exported.yaml" || fail "a cluster file is not exported"
"$program" schedule show paper_fitted --explicit >"$work/shown.yaml" || fail "show --explicit fails"
cmp -s "$work/exported.yaml" "$work/shown.yaml" || fail "show --explicit shows another cluster than the export"
expect 0 'wrote' schedule show paper_fitted --explicit -o "$work/whole.yaml"
expect 2 'whole.svg' schedule show paper_fitted --explicit -o "$work/whole.svg"

[[ $failures -eq 0 ]] && echo "schedule command: all as documented"
exit $((failures > 0))
