#!/usr/bin/env bash
# `ttfusion launch` and `ttfusion node` in real time over DDS, on any kernel under any load: lateness is not
# asserted. Drives are stretched, so that a cluster survives an ordinary kernel's delays.
#   launch_live_test.sh PROGRAM SOURCE_DIR LOG_FACTS
set -u
program=$1
source=$2
log_facts=$3
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/launching.sh"
launch_options=(--no-topics)
drive=$source/scenarios/paper_scenario1.yaml
nodes="laser camera laser_pre camera_pre gateway fusion feature"

# check WHAT SCRIPT ARGS...: a Python script with assertions about JSON files.
check() {
  local what=$1 script=$2
  shift 2
  python3 -c "import json, sys
def read(path): return json.load(open(path))
def reached(facts, node): return [state['to'] for state in facts['states'] if state['node'] == node]
$script" "$@" || fail "$what"
}

facts() {   # FOLDER: of its nodes' logs, into FOLDER.json
  "$log_facts" "$1"/*_pre.mcap "$1"/{laser,camera,gateway,fusion,feature}.mcap $(ls "$1"/*.2.mcap 2>/dev/null) >"$1.json" ||
    fail "the logs of $1 cannot be read together"
}

# ---- every strategy, side by side, in separate sessions
pids=()
for strategy in tt buff adva; do
  begin "$work/$strategy" "$drive" --strategy "$strategy" --time-scale 8 --duration 1.6
  pids+=($!)
done
for one in "${pids[@]}"; do wait "$one" || fail "a launch exits with $?: $(cat "$work"/*.err)"; done
for strategy in tt buff adva; do
  folder=$work/$strategy
  grep -q 'lateness \[us\], in real time' "$folder.out" || fail "$strategy: no table of lateness: $(cat "$folder.out")"
  grep -q 'cut off' "$folder.err" && fail "$strategy: a log is not complete: $(cat "$folder.err")"
  grep -Eq '^verdict: .*matter|^verdict: nothing was late' "$folder.out" || fail "$strategy: no verdict: $(cat "$folder.out")"
  grep -Eq 'launch +\| [0-9]+ of 1.6 s: [0-7] of 7 nodes up' "$folder/launch.log" || fail "$strategy: no word while it runs"
  facts "$folder"
  "$log_facts" "$folder/$strategy.mcap" >"$folder.merged.json" || fail "$strategy.mcap cannot be read"
  check "$strategy: what a launch leaves is another" '
folder, strategy, schema = sys.argv[1:]
facts, merged, summary = read(folder + ".json"), read(folder + ".merged.json"), read(folder + "/summary.json")
assert facts["clock"] == merged["clock"] == "wall", facts["clock"]
assert all(log["whole"] for log in facts["logs"] + merged["logs"]), facts["logs"]
assert len(facts["last_s"]) == 7 and min(facts["last_s"].values()) > 1.4, facts["last_s"]
assert facts["corrections"] and sorted(map(str, facts["corrections"])) == sorted(map(str, merged["corrections"]))
assert facts["truths"] == 0 and merged["truths"] > 0, merged["truths"]
import jsonschema
jsonschema.validate(summary, read(schema), cls=jsonschema.Draft7Validator)
real_time = summary["strategies"][0]["real_time"]
assert real_time["time_scale"] == 8 and len(real_time["nodes"]) == 7, real_time
for node in real_time["nodes"]:
    assert all(node["lateness_us"][of]["count"] > 0 for of in ("wake_ups", "floor")), node
    sends = node["node"] not in ("laser", "camera")
    assert all((node["lateness_us"][of]["count"] > 0) == sends for of in ("departures", "arrivals")), node
    assert (node["largest_offset_correction_us"] is not None) == sends, node
    assert node["withheld_by_the_sender"] + node["sender_away"] + node["lost_on_the_way"] == node["frames_lost"], node
    # The log has the last report of the node about the medium; all frames came from this host.
    said = next(one["said"] for one in read(folder + "/manifest.json")["health"] if one["node"] == node["node"])
    assert all(node["medium"][key] == said["medium"][key] for key in ("sent", "received")), (node, said)
    assert node["lateness_us"]["transits"]["count"] == node["medium"]["received"], node
    assert node["medium"]["received"] > 0 or not sends, node
    assert said["drops"] == sum(said["medium"][key] for key in ("lost", "not_sent", "dropped")), said
assert len(real_time["precision_us"]) == 1 and real_time["precision_us"][0]["count"] > 50, real_time["precision_us"]
# At any lateness, clocks are synchronised: otherwise the drive of 1.6 s would drift them apart by 2 ms.
assert real_time["precision_us"][0]["p50"] < 200, real_time["precision_us"]
manifest = read(folder + "/manifest.json")
assert summary["verdict"]["sentence"] and isinstance(summary["verdict"]["matters"], bool), summary["verdict"]
assert manifest["exit_code"] == 0 and manifest["virtual_time"] is False and manifest["time_scale"] == 8, manifest' \
    "$folder" "$strategy" "$source/keys/schemas/summary.schema.json"
done
# The example of --help: all logs in the folder, the merged one among its parts.
expect 0 'warning: .*/tt.mcap: is ignored: it holds the records of the other 8 logs' \
  diagram "$work"/tt/*.mcap --from 1 --to 1.04 -o "$work/all.svg"
expect 0 '' diagram "$work/tt/tt.mcap" --from 1 --to 1.04 -o "$work/merged.svg"
cmp "$work/all.svg" "$work/merged.svg" || fail "the picture of all logs in the folder is not the merged log's"
expect 0 'tt.mcap: is ignored' export "$work"/tt/*.mcap --format csv -o "$work/all.csv"
expect 0 '' export "$work/tt/tt.mcap" --format csv -o "$work/merged.csv"
cmp "$work/all.csv" "$work/merged.csv" || fail "the frames of all logs in the folder are not the merged log's"
expect 0 'tt.mcap: is ignored' diagram "$work"/tt/*.mcap --kind position -o "$work/all.svg"
expect 2 'fusion.mcap: holds the same records as .*tt.mcap: give each log once, and a merged log without its parts' \
  diagram "$work"/tt/{tt,fusion}.mcap --from 1 --to 1.04 -o "$work/none.svg"
logs=$(for node in $nodes; do echo "$work/tt/$node.mcap"; done)
# shellcheck disable=SC2086
for kind in timing position lateness; do
  [[ $kind == position ]] && logs="$logs $work/tt/truth.mcap"
  window="--from 1 --to 1.04"
  [[ $kind == timing ]] || window=
  expect 0 '' diagram $logs --kind $kind $window -o "$work/$kind.svg"
  grep -q '<svg' "$work/$kind.svg" || fail "no picture of $kind"
done
for format in pcapng candump csv; do
  # shellcheck disable=SC2086
  expect 0 'wrote' export $logs --format $format -o "$work/frames.$format"
  expect 0 'wrote' export "$work/tt/tt.mcap" --format $format -o "$work/merged.$format"
  cmp "$work/frames.$format" "$work/merged.$format" || fail "the nodes' logs as $format are not the launch's"
done

# ---- stopped and resumed, one after the other, in a drawn order: each is back, and the others did not notice
begin "$work/stopped" "$drive" --time-scale 10 --duration 2.1
stopped=$!
wait_begun "$work/stopped"
pids_of "$work/stopped"
sleep 1   # until the cluster is under way, with its memory locked
seed=${TTF_TEST_SEED:-4}
for node in $(python3 -c 'import random, sys; names = sys.argv[2:]; random.Random(sys.argv[1]).shuffle(names); print(*names)' \
    "$seed" $nodes); do
  kill -STOP "${pid[$node]}" && sleep 1 && kill -CONT "${pid[$node]}" || fail "seed $seed: $node cannot be stopped"
  sleep 1.1   # it integrates within 20 cycles
done &
stops=$!

# ---- meanwhile: drives stopped by the user, or by a death
begin "$work/interrupted" "$drive" --time-scale 4 --duration 600
interrupted=$!
begin "$work/required" "$drive" --time-scale 4 --duration 600
required=$!
wait_begun "$work/interrupted"
sleep 1.2
kill -INT "$interrupted"
wait "$interrupted"
code=$?
[[ $code -eq 130 ]] || fail "an interrupted launch exits with $code: $(cat "$work/interrupted.err")"
grep -q 'stopping: interrupted (SIGINT)' "$work/interrupted.err" || fail "an interrupted launch does not say so"
grep -q 'cut off' "$work/interrupted.err" && fail "an interrupted node leaves a torn log: $(cat "$work/interrupted.err")"
facts "$work/interrupted"
check "the logs of an interrupted launch are not complete" '
facts, manifest = read(sys.argv[1] + ".json"), read(sys.argv[1] + "/manifest.json")
assert all(log["whole"] for log in facts["logs"]) and facts["corrections"] and not facts["warnings"], facts
assert manifest["state"] == "ended" and manifest["exit_code"] == 130, manifest
assert [process["exit"] for node in manifest["nodes"] for process in node["processes"]] == [0] * 7, manifest["nodes"]' \
  "$work/interrupted"
wait_begun "$work/required"
pids_of "$work/required"
kill -9 "${pid[fusion]}"
wait "$required"
code=$?
[[ $code -eq 137 ]] || fail "a launch whose fusion is killed exits with $code: $(cat "$work/required.err")"
grep -q 'fusion: signal 9 (Killed)' "$work/required.err" || fail "nobody says that fusion was killed"
# ---- one that goes on until it is stopped
begin "$work/unending" "$drive" --time-scale 10 --duration 0
unending=$!
wait_begun "$work/unending"
sleep 2.5
kill -INT "$unending"
wait "$unending" || fail "a launch that goes on until it is stopped exits with $?: $(cat "$work/unending.err")"
check "a launch that was stopped is not judged to its end" '
summary, manifest = read(sys.argv[1] + "/summary.json"), read(sys.argv[1] + "/manifest.json")
assert 0 < summary["duration_s"] < 60 and manifest["exit_code"] == 0, (summary["duration_s"], manifest["exit_code"])
assert manifest["why"] == "interrupted (SIGINT)", manifest["why"]' "$work/unending"
# ---- one whose nodes are powered on shortly before its end
sed "s#\.\./schedules#$source/schedules#" "$drive" >"$work/nobody.yaml"
{
  echo "startup:"
  echo "  kind: cold"
  echo "  power_on: {$(for node in $nodes; do echo "$node: 1595 ms, "; done | tr -d '\n' | sed 's/, $//')}"
} >>"$work/nobody.yaml"
begin "$work/nobody" "$work/nobody.yaml" --time-scale 2 --duration 1.6
nobody=$!
# ---- a launch with an optional node, and nodes by hand: no supervisor but one instant, and one of them comes
# later
begin "$work/optional" "$drive" --time-scale 4 --duration 1.5 --policy feature=optional
optional=$!
start=$(python3 -c 'import time; print(f"{time.time() + 4:.3f}")')
by_hand=()
mkdir -p "$work/hand"
echo "a launch's" >"$work/hand/gateway.mcap"
for node in $nodes; do
  late=
  [[ $node == camera_pre ]] && late=--rejoin
  (
    [[ -n $late ]] && sleep 6
    exec "$program" node "$node" "$drive" --no-topics --session "by-hand-$$" --start-at "$start" --time-scale 4 \
      --duration 1.6 $late --out "$work/hand" --json >"$work/hand.$node" 2>"$work/hand.$node.err"
  ) &
  by_hand+=($!)
done
wait_begun "$work/optional"
pids_of "$work/optional"
sleep 1
kill -9 "${pid[feature]}"
for one in "${by_hand[@]}"; do wait "$one" || fail "a node that is started by hand exits with $?: $(cat "$work"/hand.*.err)"; done
grep -qx "a launch's" "$work/hand/gateway.mcap" || fail "a node that is started by hand writes over another log"
grep -q "gateway.mcap exists already: this log is .*/gateway.2.mcap" "$work/hand.gateway.err" ||
  fail "nobody says where the gateway's log is: $(cat "$work/hand.gateway.err")"
grep -q "^wrote .*/gateway.2.mcap$" "$work/hand.gateway.err" || fail "nobody says that the gateway's log is written"
mv "$work/hand/gateway.2.mcap" "$work/hand/gateway.mcap"
facts "$work/hand"
check "nodes that are started by hand do not drive together" '
facts = read(sys.argv[1] + "/hand.json")
assert all(log["whole"] for log in facts["logs"]) and min(facts["last_s"].values()) > 1.4, facts
assert reached(facts, "camera_pre")[-1:] == ["normal active"], facts["states"]   # it came later
assert facts["features"], ("nobody uses an image", facts["states"])
for node in ("laser_pre", "camera_pre", "gateway", "fusion", "feature"):
    assert read(f"{sys.argv[1]}/hand.{node}")["real_time"]["state"] == "normal active", node' "$work"

wait "$nobody"
code=$?
[[ $code -eq 1 ]] || fail "a launch at whose end nobody is there exits with $code: $(cat "$work/nobody.err")"
grep -Eq '^error: no node was in operation at the end: [a-z ]+' "$work/nobody.err" || fail "nobody says so: $(cat "$work/nobody.err")"
check "the manifest does not tell why a launch failed at whose end nobody is there" '
manifest = read(sys.argv[1] + "/manifest.json")
assert manifest["exit_code"] == 1 and manifest["why"].startswith("no node was in operation at the end: "), manifest
assert len(manifest["not_in_operation_at_end"]) == 5, manifest' "$work/nobody"
wait "$optional" || fail "a launch that can do without its dead node exits with $?: $(cat "$work/optional.err")"
grep -q 'feature: signal 9 (Killed)' "$work/optional.err" || fail "nobody says that feature was killed"
grep -Eq '^warning: .*feature.* not in operation at the end: .*signal 9 \(Killed\)' "$work/optional.err" ||
  fail "nobody says that feature was gone at the end: $(cat "$work/optional.err")"
check "the summary does not tell who was gone" '
assert {"node": "feature", "state": "signal 9 (Killed)"} in read(sys.argv[1] + "/summary.json")["not_in_operation_at_end"]' "$work/optional"
wait "$stops"
wait "$stopped" || fail "seed $seed: a launch whose nodes are stopped exits with $?: $(cat "$work/stopped.err")"
facts "$work/stopped"
check "seed $seed: stopped nodes are not back, or others noticed" '
facts, summary = read(sys.argv[1] + ".json"), read(sys.argv[1] + "/summary.json")
assert all(log["whole"] for log in facts["logs"]) and min(facts["last_s"].values()) > 1.4, facts
for node in ("laser_pre", "camera_pre", "gateway", "fusion", "feature"):
    assert reached(facts, node)[-1:] in ([], ["normal active"]), (node, facts["states"])
late = {node["node"]: node["lateness_us"]["wake_ups"]["longest"] for node in summary["strategies"][0]["real_time"]["nodes"]}
# Stopped for a second; a node that was integrating just then had no due acts for part of it.
assert all(late[node] > 500_000 for node in ("laser_pre", "camera_pre", "gateway", "fusion", "feature")), (late, facts["states"])' \
  "$work/stopped"

# ---- killed: each once, in one drive; each comes back and integrates
# shellcheck disable=SC2046
begin "$work/killed" "$drive" --time-scale 5 --duration 3 $(for node in $nodes; do echo --policy "$node=restart"; done)
killed=$!
"$program" node fusion "$drive" --no-topics --session "alone-$$" --rejoin --start-at "$(date +%s)" --time-scale 4 --duration 600 \
  --out "$work/alone" >"$work/alone.out" 2>&1 &
alone=$!

wait_begun "$work/killed"
pids_of "$work/killed"
sleep 0.5
for node in feature fusion gateway laser_pre camera_pre laser camera; do
  kill -9 "${pid[$node]}" || fail "$node cannot be killed"
  sleep 1.4
done
kill -INT "$alone"
wait "$alone" || fail "a node that is alone exits with $?: $(cat "$work/alone.out")"
"$log_facts" "$work/alone/fusion.mcap" >"$work/alone.json" || fail "the log of a node that is alone cannot be read"
check "the log of a node that is alone is not complete" '
facts = read(sys.argv[1])
assert facts["logs"][0]["whole"] and not facts["features"], facts["logs"]
assert "coldstart listen" in reached(facts, "fusion"), facts["states"]' "$work/alone.json"

wait "$killed" || fail "a launch whose nodes come back exits with $?: $(cat "$work/killed.err")"
facts "$work/killed"
check "killed nodes do not come back" '
folder = sys.argv[1]
facts, manifest = read(folder + ".json"), read(folder + "/manifest.json")
wholes = {log["name"].split("/")[-1]: log["whole"] for log in facts["logs"]}
for node in manifest["nodes"]:
    name = node["name"]
    assert [process["exit"] if process.get("exit") is not None else -process["signal"] for process in node["processes"]] == [-9, 0], node
    assert wholes[name + ".mcap"] is False and wholes[name + ".2.mcap"] is True, wholes
    assert facts["last_s"][name] > 2.8, (name, facts["last_s"])
    if name not in ("laser", "camera"): assert reached(facts, name)[-1] == "normal active", (name, facts["states"])
# The fusion service goes on behind every death.
assert max(facts["features"]) > 2.7, facts["features"]' "$work/killed"

[[ $failures -eq 0 ]] && echo "launch in real time: as documented"
exit $((failures > 0))
