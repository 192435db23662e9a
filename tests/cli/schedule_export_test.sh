#!/usr/bin/env bash
# `ttfusion schedule export`: a cluster as DBC and FIBEX, back from FIBEX, and compared with a capture.
#   schedule_export_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/shipped.sh"
schedule=$work/schedules/paper_synchronised.yaml

# The CANs as DBC, all or one.
expect 0 'BO_ 256 laser_scan: 64 laser' schedule export "$schedule" --format dbc
expect 0 '' schedule export "$schedule" --format dbc --can camera_can \
  -o "$work/camera.dbc"
[[ $(grep -c "^BO_ [0-9]* camera_" "$work/camera.dbc") -eq 3 && $(grep -c "^BO_ " "$work/camera.dbc") -eq 3 ]] ||
  fail "--can camera_can writes something else: a frame, its strobe and its trigger are there"
expect 2 '--can = no_can: must be one of' schedule export "$schedule" --format dbc \
  --can no_can
expect 2 'command line: --can = laser_can: goes with --format dbc only' \
  schedule export "$schedule" --format fibex --can laser_can

# A cluster to FIBEX and back: a bus description, of which all is checked that needs no tasks.
expect 0 '^wrote .*/cluster.xml$' schedule export "$schedule" --format fibex -o "$work/cluster.xml"
expect 0 '^wrote .*/imported.yaml$' schedule export "$work/cluster.xml" --format yaml -o "$work/imported.yaml"
grep -q 'slot: 22, channels: AB, sender: fusion, base_cycle: 1, repetition: 8, pdu: image, fragments: 13' \
  "$work/imported.yaml" || fail "the imported cluster lacks the image's slots"
for bus in imported.yaml cluster.xml; do
  expect 0 '^paper_synchronised describes no tasks, so these are not checked: activations and deadlines of tasks, ' \
    schedule check "$work/$bus"
  ! grep -q 'age of a measurement' <<<"$output" || fail "a table of ages without a row: $output"
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
assert s["consistent"] and not s["describes_tasks"] and s["not_checked"] == ["tasks", "flow", "loops", "modes", "round"], s
' || fail "--json does not say what was not checked"
mutate scenarios/paper_scenario1.yaml "s,\(adva: \).*,\1$work/imported.yaml," "$work/no_tasks.yaml"
expect 2 'imported.yaml:[0-9]+: nodes: must have tasks for a drive' \
  run "$work/no_tasks.yaml" --strategy adva --out "$work/no_tasks"
expect 2 'gdNIT|cannot be read' schedule export "$work/nothing.yaml" --format fibex
expect 2 '--format' schedule export "$work/cluster.xml"
expect 2 'must be another file than the input' schedule export "$schedule" --format fibex -o "$schedule"
expect 1 'cannot be written' schedule export "$work/cluster.xml" --format yaml -o "$work/no/such/folder.yaml"
sed 's/<flexray:N-I-T>386/<flexray:N-I-T>900/' "$work/cluster.xml" >"$work/broken.xml"
expect 2 'broken.xml:[0-9]+: .*N-I-T = 900: must be 2..805' schedule export "$work/broken.xml" --format yaml
sed 's,</fx:CHANNELS>,</fx:CHANNEL>,' "$work/cluster.xml" >"$work/broken.xml"
expect 2 'broken.xml:[0-9]+: is not well-formed XML' schedule export "$work/broken.xml" --format yaml
sed 's,<fx:MEDIUM>,<fx:NOVELTY/><fx:MEDIUM>,' "$work/cluster.xml" >"$work/novel.xml"
expect 0 'note: .*novel.xml:[0-9]+: fx:FIBEX/fx:ELEMENTS/fx:CLUSTERS/fx:CLUSTER/fx:NOVELTY: is not understood' \
  schedule export "$work/novel.xml" --format yaml -o "$work/novel.yaml"

# A capture compared with the schedule, and with the imported one.
expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy tt --seed 3 --no-pictures --out "$work"
expect 0 '' export "$work/tt.mcap" --format pcapng -o "$work/drive.pcapng"
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
says 'disturbed.pcapng: at packet [0-9]+: header CRC error: slot 2 on A'
expect 1 '"header CRC error": 1' schedule check "$schedule" --against "$work/disturbed.pcapng" --json
expect 2 'README.md: is not a capture' schedule check "$schedule" --against "$source/README.md"
expect 2 'absent.pcapng: cannot be read' schedule check "$schedule" --against "$work/absent.pcapng"
expect 2 'no FlexRay frame' schedule check "$schedule" --against "$work/drive.pcapng" --from 1000
expect 2 '--against' schedule check "$schedule" --channels A

[[ $failures -eq 0 ]] && echo "schedule export: all as documented"
exit $((failures > 0))
