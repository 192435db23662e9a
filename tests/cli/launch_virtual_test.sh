#!/usr/bin/env bash
# `ttfusion launch --virtual-time`: processes leave the records of a single one, stopped or not, side by side
# or not. A killed process takes only its own records along.
#   launch_virtual_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/launching.sh"
launch_options=(--virtual-time)
drive=$source/scenarios/paper_scenario1.yaml

# hash_of FOLDER: of the drive that left its summary there.
hash_of() {
  python3 -c 'import json, sys; print(json.load(open(sys.argv[1] + "/summary.json"))["strategies"][0]["content_hash"])' "$1"
}

for scenario in paper_scenario1 faulty_bus turning_ego; do
  "$program" run "$source/scenarios/$scenario.yaml" --strategy tt --no-pictures --out "$work/run_$scenario" >/dev/null 2>&1 ||
    fail "run $scenario"
  launch "$work/$scenario" "$source/scenarios/$scenario.yaml" || fail "launch $scenario: $(cat "$work/$scenario.err")"
  [[ $(hash_of "$work/$scenario") == "$(hash_of "$work/run_$scenario")" ]] || fail "launch $scenario leaves other records than run"
done
# A detector whose modes change as it asks for it.
"$program" run "$source/scenarios/adaptive_detection_modes.yaml" --strategy adva --duration 4 --no-pictures --out "$work/run_modes" \
  >/dev/null 2>&1 || fail "run with modes"
launch "$work/modes" "$source/scenarios/adaptive_detection_modes.yaml" --strategy adva --duration 4 ||
  fail "launch with modes: $(cat "$work/modes.err")"
[[ $(hash_of "$work/modes") == "$(hash_of "$work/run_modes")" ]] || fail "a launch with modes leaves other records than run"
# Sensors that wait for their hosts' processes, from a cold start on, with lists over CAN and over FlexRay.
for cluster in paper_free_running paper_free_flexray; do
  sed "s#\.\./schedules/paper_unsynchronised#$source/schedules/$cluster#; s#\.\./schedules#$source/schedules#
       s#^clusters:#startup: {kind: cold}\n&#" "$drive" >"$work/$cluster.yaml"
  "$program" run "$work/$cluster.yaml" --strategy adva --no-pictures --out "$work/run_$cluster" >/dev/null 2>&1 || fail "run $cluster"
  launch "$work/$cluster" "$work/$cluster.yaml" --strategy adva || fail "launch $cluster: $(cat "$work/$cluster.err")"
  [[ $(hash_of "$work/$cluster") == "$(hash_of "$work/run_$cluster")" ]] || fail "launch $cluster leaves other records than run"
done
# A round of sixty cycles, with lists in every fifth.
"$program" schedule synthesize "$source/schedules/plans/paper_sixty_cycles.yaml" -o "$work/sixty_cycles.yaml" >/dev/null 2>&1 ||
  fail "no schedule of sixty cycles"
sed "s#tt: .*#tt: sixty_cycles.yaml#; s#\\.\\./schedules#$source/schedules#" "$drive" >"$work/sixty.yaml"
"$program" run "$work/sixty.yaml" --strategy tt --no-pictures --out "$work/run_sixty" >/dev/null 2>&1 || fail "run sixty cycles"
launch "$work/sixty" "$work/sixty.yaml" || fail "launch sixty cycles: $(cat "$work/sixty.err")"
[[ $(hash_of "$work/sixty") == "$(hash_of "$work/run_sixty")" ]] || fail "a launch of sixty cycles leaves other records than run"
# The world of another simulator.
python3 "$source/examples/osi_traces.py" queue "$work/queue.osi" || fail "no trace"
"$program" run "$drive" --strategy tt --no-pictures --truth "$work/queue.osi" --out "$work/run_queue" >/dev/null 2>&1 || fail "run queue"
launch "$work/queue" "$drive" --truth "$work/queue.osi" || fail "launch queue: $(cat "$work/queue.err")"
[[ $(hash_of "$work/queue") == "$(hash_of "$work/run_queue")" ]] || fail "a launch with a trace leaves other records than run"
python3 - "$work/paper_scenario1" <<'PY' || fail "the manifest of a launch is another"
import json, os, sys
folder = sys.argv[1]
manifest = json.load(open(os.path.join(folder, "manifest.json")))
assert manifest["state"] == "ended" and manifest["exit_code"] == 0 and manifest["virtual_time"] is True, manifest
assert len(manifest["nodes"]) == 7, manifest["nodes"]
for node in manifest["nodes"]:
    assert [process["exit"] for process in node["processes"]] == [0], node
    assert os.path.exists(os.path.join(folder, node["name"] + ".mcap")), node
PY
# The nodes' own logs, together, are the log of the launch.
"$program" export "$work"/paper_scenario1/{laser,camera,laser_pre,camera_pre,gateway,fusion,feature}.mcap --format csv \
  -o "$work/nodes.csv" >/dev/null 2>&1 && "$program" export "$work/run_paper_scenario1/tt.mcap" --format csv -o "$work/run.csv" 2>/dev/null
cmp "$work/nodes.csv" "$work/run.csv" || fail "the nodes' logs, exported together, are not the run's"

# Two launches at once, one of them stopped now and then.
begin "$work/beside" "$drive"
beside=$!
begin "$work/stopped" "$drive"
stopped=$!
wait_begun "$work/stopped"
pids_of "$work/stopped"
for node in fusion laser gateway camera_pre fusion feature; do
  kill -STOP "${pid[$node]}" 2>/dev/null && sleep 0.2 && kill -CONT "${pid[$node]}"
done
wait "$beside" || fail "a launch beside another one: $(cat "$work/beside.err")"
wait "$stopped" || fail "a launch whose nodes are stopped: $(cat "$work/stopped.err")"
for folder in beside stopped; do
  [[ $(hash_of "$work/$folder") == "$(hash_of "$work/run_paper_scenario1")" ]] || fail "$folder: other records"
done

# A cold start that takes longer than the drive: for one node a warning, for all a failure.
absent() {   # FOLDER WORD SENTENCE CODE WHO...: in words, in the summary and in the manifest
  local folder=$1
  grep -qx "$2: $3" "$folder.err" || fail "$folder does not say '$3': $(cat "$folder.err")"
  python3 - "$folder" "$3" "$4" "${@:5}" <<'PY' || fail "$folder: summary and manifest say something else"
import json, sys
folder, sentence, code, *who = sys.argv[1:]
summary, manifest = (json.load(open(f"{folder}/{name}.json")) for name in ("summary", "manifest"))
assert summary["not_in_operation_at_end"] == manifest["not_in_operation_at_end"], summary
assert [one["node"] for one in summary["not_in_operation_at_end"]] == who, summary
assert all(one["state"] in sentence for one in summary["not_in_operation_at_end"]), summary
assert manifest["exit_code"] == int(code) and manifest["state"] == "ended", manifest
assert manifest["why"] == (sentence if int(code) else ""), manifest
PY
}
cold() { sed "s#\.\./schedules#$source/schedules#; $2" "$source/scenarios/cold_start.yaml" >"$work/$1.yaml"; }
cold late_feature 's/feature: 4 ms/feature: 2995 ms/'
cold too_late 's/: [0-9]* [um]s$/: 2995 ms/; s/^duration:.*/duration: 3 s/; s/^evaluate_from:.*/evaluate_from: 1500 ms/'
launch "$work/late_feature" "$work/late_feature.yaml" || fail "a launch of which one node is late exits with $?"
sentence=$(sed -n 's/^warning: \(feature was not in operation at the end: [a-z ]*\)$/\1/p' "$work/late_feature.err")
absent "$work/late_feature" warning "${sentence:-feature was not}" 0 feature
launch "$work/too_late" "$work/too_late.yaml"
[[ $? -eq 1 ]] || fail "a launch at whose end nobody is there does not exit with 1: $(cat "$work/too_late.err")"
sentence=$(sed -n 's/^error: \(no node was in operation at the end: [a-z _,();]*\)$/\1/p' "$work/too_late.err")
absent "$work/too_late" error "${sentence:-nobody}" 1 laser_pre camera_pre fusion feature laser camera
grep -q '^warning: no current image was used from 1.5 s on' "$work/too_late.err" || fail "nobody says that nothing is compared"
[[ $(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["not_in_operation_at_end"])' "$work/beside/summary.json") == '[]' ]] ||
  fail "somebody is missing from a sound drive's end"

# A killed one: the others go on to the end; its log is readable.
begin "$work/killed" "$drive" --duration 8 --policy camera=optional
killed=$!
wait_begun "$work/killed"
pids_of "$work/killed"
sleep 0.3
kill -9 "${pid[camera]}"
wait "$killed" || fail "the survivors of a killed node: $(cat "$work/killed.err")"
grep -q 'camera: signal 9' "$work/killed.err" || fail "nobody says that camera was killed"
grep -qx 'warning: camera was not in operation at the end: signal 9 (Killed)' "$work/killed.err" ||
  fail "nobody says that camera was gone at the end: $(cat "$work/killed.err")"
"$program" diagram "$work/killed/camera.mcap" --kind timing --from 0 --to 0.05 -o "$work/killed.svg" >/dev/null 2>&1 ||
  "$program" export "$work/killed/camera.mcap" --format csv -o "$work/killed.csv" 2>/dev/null || fail "a killed node's log is not readable"
# Into the folder of another launch, with another strategy and node, and with files of the user.
mkdir "$work/required"
echo '{"strategy": "adva", "nodes": [{"name": "old one"}]}' >"$work/required/manifest.json"
left="adva.mcap adva_timing.svg adva_lateness.png adva_startup.pdf adva_plane.svg adva_over_time.svg schedule.svg index.html
  truth.mcap old%20one.mcap old%20one.2.mcap old%20one.txt"
users="notes.txt adva.txt buff.mcap mine.mcap adva_mine.svg"
for file in $left $users; do echo old >"$work/required/$file"; done
begin "$work/required" "$drive" --duration 60
required=$!
wait_begun "$work/required"
# While it runs, the folder is its own, and others are refused.
before=$(md5sum "$work/required/launch.log" "$work/required/laser.txt")
for arguments in "launch" "launch --dry-run" "node fusion"; do
  # shellcheck disable=SC2086
  expect 2 "--out = $work/required: must be another folder: a running launch uses it, process $required\$" \
    $arguments "$drive" --virtual-time --out "$work/required"
done
[[ $(md5sum "$work/required/launch.log" "$work/required/laser.txt") == "$before" ]] || fail "who was refused has written over the folder"
pids_of "$work/required"
kill -9 "${pid[fusion]}"
wait "$required"
code=$?
[[ $code -eq 137 ]] || fail "a launch whose fusion is killed exits with $code"
for file in $left; do [[ -e $work/required/$file ]] && fail "an earlier launch's $file is left"; done
for file in $users; do [[ -s $work/required/$file ]] || fail "the user's $file is gone"; done

# Interrupted, as by Ctrl-C, it stops in order and reports it.
begin "$work/interrupted" "$drive" --duration 600
interrupted=$!
wait_begun "$work/interrupted"
kill -INT "$interrupted"
wait "$interrupted"
code=$?
[[ $code -eq 130 ]] || fail "an interrupted launch exits with $code: $(cat "$work/interrupted.err")"
grep -q 'stopping: interrupted (SIGINT)' "$work/interrupted.err" || fail "an interrupted launch does not say so"
python3 - "$work/interrupted/manifest.json" <<'PY' || fail "the manifest of an interrupted launch is not complete"
import json, sys
manifest = json.load(open(sys.argv[1]))
assert manifest["state"] == "ended" and manifest["exit_code"] == 130, manifest
assert all(process["ended"] for node in manifest["nodes"] for process in node["processes"]), manifest
PY

[[ $failures -eq 0 ]] && echo "launch in virtual time: the records of a single process"
exit $((failures > 0))
