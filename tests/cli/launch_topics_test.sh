#!/usr/bin/env bash
# A real-time launch's topics for ROS 2, as the shipped example listener receives them.
#   launch_topics_test.sh PROGRAM SOURCE_DIR ROS_LISTEN
set -u
program=$1
source=$2
listen=$3
source "$(dirname "$0")/expect.sh"
drive=$source/scenarios/paper_scenario1.yaml
export CYCLONEDDS_URI=file://$source/bus/dds/loopback.xml
export ROS_DOMAIN_ID=$((100 + $$ % 100))   # unlikely to be used by others on this machine

# receive NAME LAUNCH_ARGS...: listens beside a launch.
receive() {
  local name=$1 listener
  shift
  "$listen" "$ROS_DOMAIN_ID" >"$work/$name.received" 2>"$work/$name.err" &
  listener=$!
  "$program" launch "$drive" --time-scale 4 --duration 1.6 --no-pictures --out "$work/$name" \
    "$@" >"$work/$name.out" 2>&1 ||
    fail "a launch that is listened to exits with $?: $(cat "$work/$name.out")"
  kill -INT "$listener"
  wait "$listener" || fail "the listener exits with $?: $(cat "$work/$name.err")"
}

receive silent --no-topics
[[ -s $work/silent.received ]] && fail "with --no-topics there is something to receive: $(head -3 "$work/silent.received")"

before=$(date +%s)
receive published
after=$(date +%s)
python3 - "$work/published.received" "$before" "$after" <<'PY' || fail "what is received of a launch is another"
import json, sys
before, after = int(sys.argv[2]), int(sys.argv[3])
received, publishers = {}, {}
for line in map(json.loads, open(sys.argv[1])):
    if line["event"] == "publication": publishers[line["topic"]] = publishers.get(line["topic"], 0) + 1
    if line["event"] == "sample": received.setdefault(line["topic"], []).append(line)
counts = {topic: len(lines) for topic, lines in received.items()}
# Least counts out of 160 steps, 40 images, 20 measurements of the first sensor, and a health of each node a second.
for topic, least in (("tracks", 100), ("image", 25), ("image/boxes", 25), ("truth/object_0", 12)):
    assert counts.get("rt/ttfusion/" + topic, 0) >= least, counts
# Each topic has one publisher; diagnostics are every node's.
assert publishers.pop("rt/diagnostics") == 7 and set(publishers) == set(counts) - {"rt/diagnostics"}, publishers
assert all(count == 1 for count in publishers.values()), publishers
assert any(line["tracks"] for line in received["rt/ttfusion/tracks"]), "never a track"
assert {status["name"] for line in received["rt/diagnostics"] for status in line["status"]} == \
    {"laser", "camera", "laser_pre", "camera_pre", "gateway", "fusion", "feature"}, received["rt/diagnostics"]
# Stamps are on ROS' clock: a drive of 1.6 s that is stretched four times lasts 6.4 s there.
for topic in ("tracks", "image", "truth/object_0"):
    stamps = [line["stamp_ns"] * 1e-9 for line in received["rt/ttfusion/" + topic]]
    assert stamps == sorted(stamps) and before < stamps[0] and stamps[-1] < after + 1, (topic, before, stamps, after)
    assert 4.5 < stamps[-1] - stamps[0] < 7.5, (topic, stamps[0], stamps[-1])
PY
[[ $failures -eq 0 ]] && echo "topics of a launch: received"
exit $((failures > 0))
