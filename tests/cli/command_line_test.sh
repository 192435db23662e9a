#!/usr/bin/env bash
# The program as a user meets it: results, exit codes, and one clear sentence for each kind of bad input. Mistakes on the command
# line itself are in arguments_test.sh.
#   command_line_test.sh PROGRAM SOURCE_DIR SPLIT_LOG
set -u
program=$1
source=$2
split_log=$3
source "$(dirname "$0")/expect.sh"

# mutate FROM SED TO: a shipped file with one mistake.
mutate() {
  sed "$2" "$source/$1" >"$3"
  cmp -s "$source/$1" "$3" && fail "mutation '$2' of $1 changes nothing"
}

mkdir "$work/schedules" "$work/scenarios"
cp "$source"/schedules/*.yaml "$work/schedules"
cp "$source"/scenarios/*.yaml "$work/scenarios"

expect 0 "Example: ttfusion run" run --help
expect 2 "nothing.yaml: cannot be read" run "$work/nothing.yaml"

expect 0 'Examples: ttfusion keys scenario' keys --help
expect 0 '^world.objects\[\].speed: number 0..100 m/s, default 0$' keys scenario
expect 0 '^flexray.gdStaticSlot: whole number 4..661 macroticks, required$' keys
expect 2 '^error: command line: kind = voyage: must be one of scenario, cluster, experiment, track, faults$' keys voyage
expect 2 '^error: command line: --format = json-schema: goes with one kind' keys --format json-schema
expect 0 '^wrote .*/faults.json$' keys faults --format json-schema -o "$work/faults.json"
cmp -s "$work/faults.json" "$source/schemas/faults.schema.json" || fail "keys writes another schema than the one kept"
expect 0 '^wrote .*/keys$' keys --format markdown -o "$work/keys"
[[ -s $work/keys/scenario_sensors.md ]] || fail "keys --format markdown writes no page of the sensors"

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

late() { mutate scenarios/paper_scenario1.yaml "s/^seed: 1/seed: 1\ntracker:\n  late: $1/" "$drive"; }
late never
expect 2 'broken.yaml:5: tracker.late = never: must be one of rewind, augmented, clone, adjoint, al1' run "$drive"
late al1
expect 2 'broken.yaml:5: tracker.late = al1: must be rewind or clone with strategy tt' run "$drive" --out "$work/none"
late clone
expect 2 'broken.yaml:5: tracker.late = clone: must not be clone if a sensor measures freely' \
  run "$drive" --strategy adva --out "$work/none"
expect 2 'broken.yaml:5: tracker.late = clone: must not be clone if a sensor measures freely' \
  launch "$drive" --strategy adva --dry-run --out "$work/none"
late 'augmented\n  motion: ctrv'
expect 2 'broken.yaml:5: tracker.late = augmented: must be rewind unless motion is constant_velocity' run "$drive"
mutate scenarios/paper_scenario1.yaml 's/^reference: .*/&\nsensors:\n  laser2: {kind: laser, mounting: {y: 0.9}}/' "$drive"
for command in run 'launch --dry-run'; do
  expect 2 'broken.yaml:[0-9]+: sensors.laser2: must be a sensor of .*/paper_synchronised.yaml: laser or camera' \
    $command "$drive" --strategy tt --out "$work/none"
done
[[ ! -e $work/none ]] || fail "what is refused leaves a folder behind"

expect 0 '' run "$source/scenarios/two_lasers.yaml" --strategy tt --no-pictures --out "$work/named"
expect 0 '' diagram "$work/named/tt.mcap" --kind plane -o "$work/named.svg"
grep -q '#009e73' "$work/named.svg" || fail "the right laser of two_lasers.yaml is not green"

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
expect 0 'consistent' schedule check "$source/schedules/paper_synchronised.yaml"
mutate schedules/paper_synchronised.yaml 's/gdNIT: 386/gdNIT: 900/' "$cluster"
expect 2 'broken.yaml:[0-9]+: flexray.gdNIT = 900: .*2..805' schedule check "$cluster"
mutate schedules/paper_synchronised.yaml 's/gdNIT: 386/gdNIT: 380/' "$cluster"
expect 2 'gdNIT|gMacroPerCycle' schedule check "$cluster"
mutate schedules/paper_synchronised.yaml 's/step: laser_preprocessing/step: lazer_preprocessing/' "$cluster"
expect 2 'lazer_preprocessing' schedule check "$cluster"
expect 0 'laser_objects' schedule show "$source/schedules/paper_synchronised.yaml"
expect 0 '^wrote .*/schedule.svg$' schedule show "$source/schedules/paper_synchronised.yaml" -o "$work/schedule.svg"
[[ -s $work/schedule.svg ]] || fail "schedule show -o writes no picture"
mutate schedules/paper_unsynchronised.yaml 's/fragment_bytes: 8$/fragment_bytes: 12/' "$cluster"
expect 2 \
  'broken.yaml:[0-9]+: can.camera_can.messages\[0\] = 12 bytes: must fit a frame of this CAN, at most 8 bytes' \
  schedule show "$cluster"
expect 2 'png' schedule show "$source/schedules/paper_synchronised.yaml" -o "$work/schedule.bmp"

# The CANs as DBC, all or one.
expect 0 'BO_ 256 laser_scan: 64 laser' schedule export "$source/schedules/paper_synchronised.yaml" --format dbc
expect 0 '' schedule export "$source/schedules/paper_synchronised.yaml" --format dbc --can camera_can \
  -o "$work/camera.dbc"
[[ $(grep -c "^BO_ [0-9]* camera_" "$work/camera.dbc") -eq 3 && $(grep -c "^BO_ " "$work/camera.dbc") -eq 3 ]] ||
  fail "--can camera_can writes something else: a frame, its strobe and its trigger are there"
expect 2 '--can = no_can: must be one of' schedule export "$source/schedules/paper_synchronised.yaml" --format dbc \
  --can no_can
expect 2 'command line: --can = laser_can: goes with --format dbc only' \
  schedule export "$source/schedules/paper_synchronised.yaml" --format fibex --can laser_can

# A cluster to FIBEX and back: a bus description, of which all is checked that needs no tasks.
expect 0 '^wrote .*/cluster.xml$' schedule export "$source/schedules/paper_synchronised.yaml" --format fibex -o "$work/cluster.xml"
expect 0 '^wrote .*/imported.yaml$' schedule export "$work/cluster.xml" --format yaml -o "$work/imported.yaml"
grep -q 'slot: 22, channels: AB, sender: fusion, base_cycle: 1, repetition: 8, pdu: image, fragments: 13' \
  "$work/imported.yaml" || fail "the imported cluster lacks the image's slots"
for bus in imported.yaml cluster.xml; do
  expect 0 '^paper_synchronised describes no tasks, so these are not checked: activations and deadlines of tasks, ' \
    schedule check "$work/$bus"
  expect 0 'no tasks, sensors and CANs are described' schedule show "$work/$bus"
  expect 0 'note: paper_synchronised describes no tasks, so the file says of no node what it receives' \
    schedule export "$work/$bus" --format fibex -o "$work/again.xml"
  expect 0 '' schedule export "$work/again.xml" --format yaml -o "$work/again.yaml"
  diff <(grep -v '^#\|# receives' "$work/imported.yaml") <(grep -v '^#' "$work/again.yaml") ||
    fail "$bus is another one after it was exported again"
done
sed 's,<flexray:MAX-WITHOUT-CLOCK-CORRECTION-FATAL>4</[^>]*>,,; s,CORRECTION-PASSIVE>2<,CORRECTION-PASSIVE>5<,' \
  "$work/cluster.xml" >"$work/unstated.xml"
expect 0 'note: .*Fatal = 4: must be 5..15: .* \(assumed: the file does not state it\)' schedule check "$work/unstated.xml"
"$program" schedule check "$work/imported.yaml" --json | python3 -c '
import json, sys
s = json.load(sys.stdin)
assert s["consistent"] and not s["describes_tasks"] and s["not_checked"] == ["tasks", "flow", "loops"], s
' || fail "--json does not say what was not checked"
sed "s,\(adva: \).*,\1$work/imported.yaml," "$source/scenarios/paper_scenario1.yaml" >"$work/no_tasks.yaml"
expect 2 'imported.yaml:[0-9]+: nodes: must have tasks for a drive' \
  run "$work/no_tasks.yaml" --strategy adva --out "$work/no_tasks"
expect 2 'gdNIT|cannot be read' schedule export "$work/nothing.yaml" --format fibex
expect 2 '--format' schedule export "$work/cluster.xml"
expect 1 'cannot be written' schedule export "$work/cluster.xml" --format yaml -o "$work/no/such/folder.yaml"
sed 's/<flexray:N-I-T>386/<flexray:N-I-T>900/' "$work/cluster.xml" >"$work/broken.xml"
expect 2 'broken.xml:[0-9]+: .*N-I-T = 900: must be 2..805' schedule export "$work/broken.xml" --format yaml
sed 's,</fx:CHANNELS>,</fx:CHANNEL>,' "$work/cluster.xml" >"$work/broken.xml"
expect 2 'broken.xml:[0-9]+: is not well-formed XML' schedule export "$work/broken.xml" --format yaml
sed 's,<fx:MEDIUM>,<fx:NOVELTY/><fx:MEDIUM>,' "$work/cluster.xml" >"$work/novel.xml"
expect 0 'note: .*novel.xml:[0-9]+: fx:FIBEX/fx:ELEMENTS/fx:CLUSTERS/fx:CLUSTER/fx:NOVELTY: is not understood' \
  schedule export "$work/novel.xml" --format yaml -o "$work/novel.yaml"

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

# A drive with faults reports their effects, in words and as JSON; one without does not mention faults.
expect 0 'byzantine_clock +laser_pre' run "$source/scenarios/faulty_bus.yaml" --strategy tt --no-log --out "$work/f"
expect 0 '^1 fault-free node to the end: fusion$' run "$source/scenarios/faulty_bus.yaml" --strategy tt \
  --no-log --out "$work/f"
expect 0 '^    discarded: no time of measurement +1$' run "$source/scenarios/faulty_bus.yaml" --strategy tt \
  --no-log --out "$work/f"
expect 0 'No fault-free node was harmed' run "$source/scenarios/faulty_bus.yaml" --strategy tt --no-log --out "$work/f"
python3 - "$work/f/summary.json" "$work/a/summary.json" <<'PY' || fail "the JSON does not say what the faults did"
import json, sys
faults = json.load(open(sys.argv[1]))["strategies"][0]["faults"]
assert [f["kind"] for f in faults][3] == "crash" and faults[3]["node"] == "camera_pre" and faults[3]["ends_s"] > 1.7, faults
assert all(f["acts"] > 0 and not f["harmed"] and f["harms"] == [] for f in faults), faults
assert any(c["check"] == "boundary" and c["cycles"] > 0 for c in faults[4]["checks"]), faults[4]
assert json.load(open(sys.argv[1]))["strategies"][0]["fault_free_nodes"] == ["fusion"]
assert "faults" not in json.load(open(sys.argv[2]))["strategies"][0]
PY

# Without a comparison (judgement starts after the end) there is a dash and a null, instead of a perfect zero.
sed -e 's/^evaluate_from: .*/evaluate_from: 3 s/' \
  "$source/scenarios/paper_scenario1.yaml" >"$work/scenarios/unjudged.yaml"
expect 0 'position RMSE against truth \[m\] +-$' run "$work/scenarios/unjudged.yaml" --strategy tt \
  --no-log --out "$work/u"
expect 0 '  95 % band +-$' run "$work/scenarios/unjudged.yaml" --strategy tt --no-log --out "$work/u"
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
expect 1 'error: .*/file/x: cannot be created: Not a directory' \
  experiment "$source/experiments/fault_campaign.yaml" --out "$work/file/x"
expect 1 'error: .*/file/x.csv: cannot be written: Not a directory' export "$work/a/tt.mcap" --format csv \
  -o "$work/file/x.csv"
expect 1 'error: .*/file/x.svg: cannot be written' diagram "$work/a/tt.mcap" -o "$work/file/x.svg"
expect 1 'error: .*/file/x.svg: cannot be written' \
  schedule show "$source/schedules/paper_synchronised.yaml" -o "$work/file/x.svg"
mkdir -p "$work/w1/summary.json" "$work/w2/tt.mcap" "$work/w3/index.html" "$work/w4/tt_timing.png" "$work/picture.svg"
tt=(run "$source/scenarios/paper_scenario2.yaml" --strategy tt)
expect 1 'error: .*/w1/summary.json: cannot be written: Is a directory' "${tt[@]}" --no-log --out "$work/w1"
expect 1 'error: .*/w2/tt.mcap: cannot be created: Is a directory' "${tt[@]}" --out "$work/w2"
expect 1 'error: .*/w3/index.html: cannot be written' "${tt[@]}" --out "$work/w3"
expect 1 'error: .*/w4/tt_timing.png: cannot be written' "${tt[@]}" --out "$work/w4"
expect 1 'error: .*/picture.svg: cannot be written' diagram "$work/a/tt.mcap" -o "$work/picture.svg"
if [[ -c /dev/full ]]; then
  for command in "run $source/scenarios/paper_scenario2.yaml --strategy tt --no-log --out $work/w5" \
                 "schedule show $source/schedules/paper_synchronised.yaml"; do
    output=$("$program" $command 2>&1 >/dev/full)
    [[ $? -eq 1 ]] || fail "$command to a full device does not exit with 1"
    grep -q '^error: .*No space left on device' <<<"$output" || fail "$command to a full device says: $output"
  done
fi

# Diagrams from logs, whole and cut off.
expect 0 '^wrote .*/timing.pdf$' diagram "$work/a/tt.mcap" --from 1.5 --to 1.6 -o "$work/timing.pdf"
expect 2 'command line: --from = 1e300: must be a decimal number 0..1000000000 s' \
  diagram "$work/a/tt.mcap" --from 1e300 -o "$work/timing.pdf"
expect 2 'must be after --from' diagram "$work/a/tt.mcap" --from 1.5 --to 1.5 -o "$work/timing.pdf"
expect 0 '' diagram "$work/a/tt.mcap" "$work/a/adva.mcap" --kind plane -o "$work/plane.svg"
expect 2 '--from = 50: must be before the end of the log' diagram "$work/a/tt.mcap" --from 50 -o "$work/none.svg"
expect 2 'tt.mcap: has no lateness: the run was not in real time' \
  diagram "$work/a/tt.mcap" --kind lateness -o "$work/none.svg"
expect 2 '--to = 1.5: does not go with --kind lateness' \
  diagram "$work/a/tt.mcap" --kind lateness --to 1.5 -o "$work/none.svg"
expect 2 '--frame = 3: goes with --kind boxes' diagram "$work/a/tt.mcap" --frame 3 -o "$work/none.svg"
head -c 100 "$work/a/tt.mcap" >"$work/empty.mcap"
expect 2 'empty.mcap: holds only the beginning of a log: 100 bytes, no manifest, no record' \
  diagram "$work/empty.mcap" -o "$work/none.svg"
: >"$work/nothing.mcap"
for file in empty nothing; do
  expect 2 "error: .*$file.mcap: (is not a log|holds only the beginning of a log)" export "$work/$file.mcap" --format csv \
    -o "$work/none.csv"
  [[ -e $work/none.csv ]] && fail "an export of nothing leaves a file"
done
expect 2 "holds only the beginning of a log" diagram "$work/empty.mcap" -o "$work/none.svg"
cp "$work/a/tt.mcap" "$work/itself.mcap"
expect 2 '--out = .*itself.mcap: must be another file than the input' \
  export "$work/itself.mcap" --format csv -o "$work/./itself.mcap"
cmp -s "$work/a/tt.mcap" "$work/itself.mcap" || fail "a refused export changed its input"
mkdir "$work/reported"
cp "$work/a/tt.mcap" "$work/reported/"
expect 2 '--out = .*tt.mcap: must end in .html' report "$work/reported" -o "$work/reported/./tt.mcap"
ln "$work/reported/tt.mcap" "$work/reported.html"
expect 2 '--out = .*.html: must be another file than the input' report "$work/reported" -o "$work/reported.html"
cmp -s "$work/a/tt.mcap" "$work/reported/tt.mcap" || fail "a refused report changed its input"
expect 2 'must be another file than the input' \
  schedule export "$work/schedules/paper_synchronised.yaml" --format fibex -o "$work/schedules/paper_synchronised.yaml"
head -c 200000 "$work/a/tt.mcap" >"$work/cut.mcap"
[[ $("$program" export "$work/cut.mcap" --format csv -o "$work/cut.csv" 2>&1 >/dev/null | grep -vc '^warning: \|^wrote ') -eq 0 ]] ||
  fail "a line of a warning is not called one"
expect 0 'warning: .*cut.mcap' diagram "$work/cut.mcap" -o "$work/cut.svg"
expect 2 'scenario|MCAP|mcap' diagram "$source/README.md" -o "$work/none.svg"

# Frames for other programs, and a capture compared with the schedule.
expect 0 'Examples: ttfusion export' export --help
expect 2 'pcapng' export "$work/a/tt.mcap" --format asc -o "$work/drive.asc"
expect 2 'README.md' export "$source/README.md" --format csv -o "$work/drive.csv"
expect 1 'absent/drive.csv: cannot be written' export "$work/a/tt.mcap" --format csv -o "$work/absent/drive.csv"
expect 0 '^wrote .*/drive.pcapng: [1-9][0-9]* FlexRay and [1-9][0-9]* CAN frames and 0 symbols' export "$work/a/tt.mcap" --format pcapng \
  -o "$work/drive.pcapng"
expect 0 '"can_frames": [1-9]' export "$work/a/tt.mcap" --format candump --json -o "$work/drive.log"
expect 0 'warning: .*cut.mcap' export "$work/cut.mcap" --format csv -o "$work/drive.csv"
expect 0 '"flows": [1-9]' export "$work/a/tt.mcap" --format perfetto --json -o "$work/drive.pftrace"
expect 0 'warning: .*cut.mcap' export "$work/cut.mcap" --format perfetto -o "$work/cut.pftrace"
protoc --decode=ttfusion.perfetto.Trace -I "$source/recording/exports" "$source/recording/exports/perfetto.proto" \
  <"$work/drive.pftrace" |
  grep -q 'name: "age of the newest measurement when used \[ms\]"' || fail "export --format perfetto leaves no trace"
# As other programs read it, by Perfetto's own numbers: valid, and complete by the export's own count.
said=$(python3 "$source/tests/cli/perfetto_reader.py" "$work/drive.pftrace") || fail "drive.pftrace: $said"
told=$("$program" export "$work/a/tt.mcap" --format perfetto --json -o "$work/drive.pftrace" 2>/dev/null |
  python3 -c 'import json, sys; t = json.load(sys.stdin); print("%d slices, %d instants, %d counts, %d flows" %
    (t["slices"], t["instants"], t["counter_values"], t["flows"]))')
[[ $said == *" tracks, $told" ]] || fail "the trace has $said, the export says $told"
cat "$work/drive.pftrace" "$work/drive.pftrace" >"$work/twice.pftrace"
python3 "$source/tests/cli/perfetto_reader.py" "$work/twice.pftrace" >"$work/said" && fail "two traces in one are sound"
python3 "$source/tests/cli/perfetto_reader.py" "$work/cut.pftrace" >"$work/said" || fail "cut.pftrace: $(cat "$work/said")"
expect 1 'absent/x.pftrace: cannot be written' export "$work/a/tt.mcap" --format perfetto -o "$work/absent/x.pftrace"
if [[ -c /dev/full ]]; then
  expect 1 '/dev/full: cannot be written: No space left' export "$work/a/tt.mcap" --format perfetto -o /dev/full
fi
[[ $(head -1 "$work/drive.csv") == time_ns,bus,channel,* ]] || fail "export --format csv leaves no header"
grep -Evq '^\([0-9]{10}\.[0-9]{6}\) [a-z_]+ [0-9A-F]{3}#(#1)?([0-9A-F]{2})*$' "$work/drive.log" &&
  fail "export --format candump leaves a line canplayer does not read"
schedule=$source/schedules/paper_synchronised.yaml
expect 0 'frames on AB in [0-9]+ cycles: as scheduled' schedule check "$schedule" --against "$work/drive.pcapng"
expect 0 '"consistent": true' schedule check "$schedule" --against "$work/drive.pcapng" --json
for bus in imported.yaml cluster.xml; do
  expect 0 'frames on AB in [0-9]+ cycles: as scheduled' schedule check "$work/$bus" --against "$work/drive.pcapng"
done
head -c 100000 "$work/drive.pcapng" >"$work/cut.pcapng"
expect 0 'warning: .*cut.pcapng: block before packet [0-9]+' schedule check "$schedule" --against "$work/cut.pcapng"
python3 - "$work/cut.pcapng" "$work/disturbed.pcapng" <<'END'
import sys
data = bytearray(open(sys.argv[1], "rb").read())
at = data.index(b"\x01\x00\x38\x02", 50000)   # the startup frame of slot 2 on A
data[at + 5] ^= 1
open(sys.argv[2], "wb").write(data)
END
expect 1 '^1 contradiction$|in [0-9]+ cycles: 1 contradiction$' schedule check "$schedule" \
  --against "$work/disturbed.pcapng"
expect 1 'disturbed.pcapng: at packet [0-9]+: header CRC error: slot 2 on A' \
  schedule check "$schedule" --against "$work/disturbed.pcapng"
expect 1 '"header CRC error": 1' schedule check "$schedule" --against "$work/disturbed.pcapng" --json
expect 2 'README.md: is not a capture' schedule check "$schedule" --against "$source/README.md"
expect 2 'absent.pcapng: cannot be read' schedule check "$schedule" --against "$work/absent.pcapng"
expect 2 'no FlexRay frame' schedule check "$schedule" --against "$work/drive.pcapng" --from 1000
expect 2 '--against' schedule check "$schedule" --channels A

# On real CAN FD: the failing rules, and the time scale at which all hold.
expect 1 'paper_synchronised on can-fd:1M/5M at time scale 1: 34 of 34 slots do not hold' schedule check "$schedule" \
  --medium can-fd:1M/5M
expect 1 '^ +1-5  AB +2 +232.2 +84.0$' schedule check "$schedule" --medium can-fd:1M/5M
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
expect 0 'all 34 slots hold' schedule check "$source/schedules/paper_synchronised.yaml" --medium can-fd:1M/5M \
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
  can-fd:9999/1M \
              can-fd:1m/5M can-fd:1M/5M/2M dds vcan0; do
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

# The logs of a run's processes are merged: their results equal those of the run's single log.
mkdir "$work/nodes"
"$split_log" "$work/a/tt.mcap" 5 "$work/nodes" || fail "split_log fails"
expect 0 'are merged' diagram --help
expect 0 'are merged' export --help
for kind in timing startup position plane; do
  expect 0 '' diagram "$work/a/tt.mcap" --kind $kind --from 1.5 --to 1.6 -o "$work/of_one.svg"
  expect 0 '' diagram "$work"/nodes/node{3,0,4,2,1}.mcap --kind $kind --from 1.5 --to 1.6 -o "$work/of_many.svg"
  cmp -s "$work/of_one.svg" "$work/of_many.svg" ||
    fail "the $kind diagram of a run's five logs is not that of its one log"
done
for format in pcapng candump csv perfetto; do
  expect 0 '' export "$work/a/tt.mcap" --format $format -o "$work/of_one"
  expect 0 '' export "$work"/nodes/*.mcap --format $format -o "$work/of_many"
  cmp -s "$work/of_one" "$work/of_many" || fail "the $format export of a run's five logs is not that of its one log"
done
expect 0 '' diagram "$work"/nodes/*.mcap "$work/a/adva.mcap" --kind plane -o "$work/of_many.svg"
expect 0 '' diagram "$work/a/tt.mcap" "$work/a/adva.mcap" --kind plane -o "$work/of_one.svg"
cmp -s "$work/of_one.svg" "$work/of_many.svg" || fail "two runs side by side differ by how many logs one of them has"
expect 2 'adva.mcap: cluster = paper_unsynchronised: must be paper_synchronised as in .*tt.mcap: only logs of one drive' \
  diagram "$work/a/tt.mcap" "$work/a/adva.mcap" -o "$work/none.svg"
expect 2 'c/tt.mcap: seed = 4: must be 3 as in .*a/tt.mcap' export "$work/a/tt.mcap" "$work/c/tt.mcap" --format csv \
  -o "$work/none"
expect 2 'b/tt.mcap: holds the same records as .*a/tt.mcap: give each log once' \
  diagram "$work/a/tt.mcap" "$work/b/tt.mcap" --kind plane -o "$work/none.svg"
expect 2 'holds the same records as' export "$work/a/tt.mcap" "$work/nodes/node2.mcap" --format csv -o "$work/none"
expect 2 'must be another file than the input' export "$work"/nodes/node{0,1}.mcap --format csv \
  -o "$work/nodes/node1.mcap"
printf 'damage' | dd of="$work/nodes/node1.mcap" bs=1 seek=60000 conv=notrunc status=none
expect 0 'warning: .*node1.mcap: the chunk at byte' export "$work"/nodes/*.mcap --format csv -o "$work/of_many"
expect 0 '' export "$work/a/tt.mcap" --format csv -o "$work/of_one"
LC_ALL=C comm -13 <(LC_ALL=C sort "$work/of_one") <(LC_ALL=C sort "$work/of_many") >"$work/added"
[[ ! -s "$work/added" ]] || fail "a damaged log adds frames"
[[ $(wc -l <"$work/of_many") -lt $(wc -l <"$work/of_one") ]] || fail "a damaged chunk costs no frame"

# In a cold drive no node is active at first, which is no harm. A node that never becomes active is harmed.
sed "s#\.\./schedules#$source/schedules#" "$source/scenarios/cold_start.yaml" >"$work/cold_faulty.yaml"
printf 'faults:\n  - {kind: noise, channels: A, length: 1 us, interval: 500 ms}\n' >>"$work/cold_faulty.yaml"
expect 0 'No fault-free node was harmed' run "$work/cold_faulty.yaml" --strategy tt --no-log --out "$work/cold_faulty"
sed -i 's/channels: A, length: 1 us, interval: 500 ms/length: 1 ms, interval: 0 ms/' "$work/cold_faulty.yaml"
expect 1 'HARMED by fault 0, .*never became normal active' \
  run "$work/cold_faulty.yaml" --strategy tt --no-log --out "$work/cold_faulty"
expect 1 '^error: with tt no node ever became active: laser_pre, camera_pre, fusion, feature, laser, camera$' \
  run "$work/cold_faulty.yaml" --no-log --out "$work/cold_faulty"
# For a cluster that never started, the table shows failure, and no perfect values.
for row in 'uses of an image +0' 'objects compared / missed / spurious +-' 'precision of the time base \[us\] +-'; do
  expect 1 "^$row$" run "$work/cold_faulty.yaml" --strategy tt --no-log --out "$work/cold_faulty"
done
# Lost frames are counted, in any slot and of any sender.
sed "s#\.\./schedules#$source/schedules#" "$source/scenarios/paper_scenario1.yaml" >"$work/drowned.yaml"
printf 'faults:\n  - {kind: transient, from: 1 s, duration: 4 ms}\n' >>"$work/drowned.yaml"
expect 0 \
  'HARMED by fault 0, 1\.0[0-9]+ s: fusion: [0-9]+ frames lost on all channels, the first: slot [0-9]+ of [a-z_]+$' \
  run "$work/drowned.yaml" --strategy tt --no-log --out "$work/drowned"

# The pages' examples of a scenario load as they stand, and so do their keys.
page_example() \
  { awk -v key="    $2:" '$0 == key { on = 1 } on && !/^    / { exit } on { print substr($0, 5) }' "$source/docs/$1"; }
for example in faults startup; do
  grep -v '^faults:' "$work/scenarios/paper_scenario1.yaml" >"$work/scenarios/page.yaml"
  page_example $example.md $example >>"$work/scenarios/page.yaml"
  grep -q "^$example:" "$work/scenarios/page.yaml" || fail "docs/$example.md has no example of $example"
  [[ $example == startup ]] || sed -i 's/^duration: .*/duration: 3 s/' "$work/scenarios/page.yaml"
  expect 0 'precision of the time base' run "$work/scenarios/page.yaml" --strategy tt --no-log --out "$work/page"
done
for keys in 'feature_service: {max_image_age: 100 ms}' 'tracker: {coast_after: 300 ms, delete_after: 1 s}'; do
  inner=${keys#*\{}
  for key in "${keys%%:*}" "${inner%%:*}"; do
    grep -q "\`$key\`" "$source/docs/faults.md" || fail "docs/faults.md does not name $key"
  done
  (cat "$work/scenarios/paper_scenario2.yaml" && echo "$keys") >"$work/scenarios/page.yaml"
  expect 0 'precision of the time base' run "$work/scenarios/page.yaml" --strategy tt --no-log --out "$work/page"
done

# The guardians' interventions are reported, and are a check.
sed "s#\.\./schedules#$source/schedules#" "$source/scenarios/cold_start.yaml" >"$work/guarded.yaml"
printf 'faults:\n  - {kind: babbling_idiot, node: feature, channels: B, interval: 1 ms, from: 2 s, duration: 50 ms}\n' >>"$work/guarded.yaml"
expect 0 '^0 +guardian +26 .*guardian B' run "$work/guarded.yaml" --strategy tt --no-log --out "$work/guarded"
expect 0 '^0 +blocked +[0-9]+ +[0-9]+ +2\.0' run "$work/guarded.yaml" --strategy tt --no-log --out "$work/guarded"
python3 - "$work/guarded/summary.json" <<'PY' || fail "the JSON does not say what the guardians did"
import json, sys
run = json.load(open(sys.argv[1]))["strategies"][0]
kept = run["faults"][0]["guardians"]
assert sum(k["signals"] for k in kept) == 50 and all(k["what"] == "blocked" and k["why"] for k in kept), kept
assert run["unattributed"] == {"checks": [], "guardians": [], "states": [], "harmed": False, "harms": []}, run["unattributed"]
PY

# Errors in a scenario are found before an earlier run's log is overwritten.
mkdir "$work/kept" && echo "an earlier log" >"$work/kept/tt.mcap"
sed "s#\.\./schedules#$source/schedules#; 0,/node: camera_pre/s//node: camera_per/" \
  "$source/scenarios/faulty_bus.yaml" >"$work/typo.yaml"
expect 2 'camera_per: must be a node' run "$work/typo.yaml" --strategy tt --out "$work/kept"
[[ $(cat "$work/kept/tt.mcap") == "an earlier log" ]] || fail "a run that was refused has written over a log"

# A fault campaign: the table, the same from merged shards; a replay in words; refused input.
campaign=$work/schedules/campaign.yaml
sed -e 's#^cluster: .*#cluster: flexray_demo.yaml#' -e 's/^faults: .*/faults: 24/' \
  "$source/experiments/fault_campaign.yaml" >"$campaign"
expect 0 'Example' experiment --help
expect 0 'variant guardian \(guardian and two channels\)' experiment "$campaign" --jobs 2 --out "$work/campaign"
expect 0 '"holds": true' experiment "$campaign" --jobs 1 --json
expect 0 '' experiment "$campaign" --shard 1/2 --out "$work/shard1"
expect 0 '' experiment "$campaign" --shard 2/2 --out "$work/shard2"
expect 0 'holds' experiment "$campaign" --merge "$work/shard1" "$work/shard2" --out "$work/merged"
cmp -s "$work/campaign/results.csv" "$work/merged/results.csv" || fail "shards put together give other results"
awk -F, -v OFS=, '$2 == "guardian" && $7 == "yes" && !done { $12 = "frame_lost"; done = 1 } 1' \
  "$work/merged/results.csv" >"$work/campaign/results.csv"
expect 1 'does not hold' experiment "$campaign" --merge "$work/campaign"
expect 1 'ttfusion experiment .*campaign.yaml --replay [0-9]+' experiment "$campaign" --merge "$work/campaign"
expect 2 'campaign.yaml: --merge: lacks shard 2/2: give the folders of all shards' experiment "$campaign" \
  --merge "$work/shard1"
expect 0 '' experiment "$campaign" --shard 3/5 --out "$work/shard3"
expect 2 'lacks shard 1/5, 2/5, 4/5, 5/5' experiment "$campaign" --merge "$work/shard3"
expect 2 '--merge = [0-9]+: is a (missing|repeated) fault' experiment "$campaign" --merge "$work/shard1" \
  "$work/shard3"
expect 0 'fault 3: [a-z_]+ ' experiment "$campaign" --replay 3
for fault in 2 3 8; do
  "$program" experiment "$campaign" --replay $fault >"$work/replay.txt"
  awk '/^variant/ { last = -1 } / ms  cycle / { told++; if ($1 < last) bad = 1; last = $1 } END { exit bad || told < 20 }' \
    "$work/replay.txt" || fail "the replay of fault $fault is not in the order of time"
done
expect 2 '--replay = 24: must be 0..23' experiment "$campaign" --replay 24
expect 2 '--shard = 3/2: must be i/n' experiment "$campaign" --shard 3/2
sed -e 's/guardian: true/guardian: true, why: not/' "$campaign" >"$work/schedules/broken.yaml"
expect 2 'broken.yaml:[0-9]+: variants.guardian.why: is not a known key' experiment "$work/schedules/broken.yaml"
sed -e 's/^kind: .*/kind: voyage/' "$campaign" >"$work/schedules/broken.yaml"
expect 2 'kind = voyage: must be sweep or fault_campaign' experiment "$work/schedules/broken.yaml"
sed -e 's/^expect:/classes: {crash: 1}\nexpect:/' "$campaign" >"$work/schedules/crashes.yaml"
expect 0 'crash +24 ' experiment "$work/schedules/crashes.yaml"

# Recorded input, and a broken line in it.
printf 'L\t1.0\t0.1\t1000000\t1.0\t0.1\t5.0\t0.0\t0.0\t0.0\n' >"$work/short.txt"
expect 2 'paper_scenario1.yaml: clusters = .*: takes no recording, so --input would be ignored' \
  run "$source/scenarios/paper_scenario1.yaml" --input "$work/short.txt" --out "$work/none"
[[ -e $work/none/buff.mcap ]] && fail "a refused recording leaves a log"
# A car at 5 m/s, seen in turn: rows 50 ms and SECOND us apart, COUNT of them.
rows() {
  awk -v second="$1" -v count="$2" 'BEGIN {
    at = 0
    for (i = 0; i < count; ++i) {
      x = 10 + 5e-6 * at
      truth = sprintf("%d\t%.4f\t0\t5\t0\t0\t0", at, x)
      printf i % 2 ? "R\t%.4f\t0\t5\t%s\n" : "L\t%.4f\t0\t%s\n", x, truth
      at += i % 2 ? second : 50000
    }
  }'
}
recorded=(run "$source/scenarios/laser_radar_recorded.yaml" --strategy adva --no-pictures)
rows 55000 100 >"$work/off.txt"
expect 2 'off.txt:3: t_us = 105000: must be within 1 ms of an instant at which .*laser_radar.yaml has laser measure: every 100 ms' \
  "${recorded[@]}" --input "$work/off.txt" --out "$work/none"
[[ -e $work/none/adva.mcap ]] && fail "a recording off the schedule leaves a log"
rows 50000 100 >"$work/five_seconds.txt"
expect 0 'laser: 50 rows, 50 lists played' "${recorded[@]}" --input "$work/five_seconds.txt" --out "$work/r"
expect 0 'the recording ended at 4.95 s of 25 s' "${recorded[@]}" --input "$work/five_seconds.txt" --out "$work/r"
expect 0 '"ends_early": true' "${recorded[@]}" --input "$work/five_seconds.txt" --out "$work/r" --json
recording=${TTF_RECORDINGS:-$source/../shared/data}/laser_radar/measurements.txt
if [[ -r $recording ]]; then
  expect 0 'position RMSE' run "$source/scenarios/laser_radar_recorded.yaml" --input "$recording" --out "$work/r" \
    --no-pictures
  sed '7s/[0-9]/x/' "$recording" >"$work/broken.txt"
  expect 2 'broken.txt:7' run "$source/scenarios/laser_radar_recorded.yaml" --input "$work/broken.txt" --out "$work/r"
else
  echo "recorded input: skipped, there is no recording $recording;" \
    "set TTF_RECORDINGS to the folder that holds laser_radar/measurements.txt"
fi
expect 2 '--input' run "$source/scenarios/laser_radar_recorded.yaml" --out "$work/r"

[[ $failures -eq 0 ]] && echo "command line: all as documented"
exit $((failures > 0))
