#!/usr/bin/env bash
# The loop closed in real time over DDS, on any kernel under any load: lateness is not asserted. Drives are stretched.
#   launch_loop_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/launching.sh"
launch_options=(--no-topics --duration 3.5)
drive=$source/tests/test_bed/short_loop.yaml
nodes="laser camera odometry laser_pre camera_pre odometry_pre gateway fusion feature actuator"

# check WHAT FOLDER SCRIPT: a Python script with assertions about a launch's JSON files; `vehicle` are the nodes' counts.
check() {
  python3 -c "import json, sys
def read(name): return json.load(open(sys.argv[1] + '/' + name))
manifest, driving = read('manifest.json'), read('summary.json')['strategies'][0]['driving']
vehicle = {node['node']: node['said']['vehicle'] for node in manifest['health'] if 'vehicle' in node['said']}
assert sorted(vehicle) == ['actuator', 'camera', 'laser', 'odometry'], vehicle
assert all(counts['whole'] and not counts['malformed'] for counts in vehicle.values()), vehicle
$3" "$2" || fail "$1: $(cat "$2.err")"
}

# ---- the node with the actuator is no real node
expect 2 'command line: --external = actuator: must not name the node with the actuator, whose process moves the vehicle' \
  launch "$drive" --external actuator --session "external-$$"

# ---- one whole, one whose actuator and odometry are killed and come back, and nodes by hand, one of which comes later
begin "$work/whole" "$drive" --time-scale 4
whole=$!
begin "$work/killed" "$drive" --time-scale 6 --policy actuator=restart --policy odometry=restart
killed=$!
start=$(python3 -c 'import time; print(f"{time.time() + 4:.3f}")')
by_hand=()
for node in $nodes; do
  late=
  [[ $node == camera ]] && late=--rejoin
  (
    [[ -n $late ]] && sleep 10
    exec "$program" node "$node" "$drive" --no-topics --session "loop-$$" --start-at "$start" --time-scale 4 --duration 3.5 $late \
      --out "$work/hand" --json >"$work/hand.$node" 2>"$work/hand.$node.err"
  ) &
  by_hand+=($!)
done
wait_begun "$work/killed"
pids_of "$work/killed"
sleep 3
expect 1 "error: this process of the session loop-$$ runs already on this host: give each drive a --session of its own" \
  node laser "$drive" --no-topics --session "loop-$$" --start-at "$start" --time-scale 4 --duration 3.5 --rejoin --out "$work/again"
sleep 3
kill -9 "${pid[actuator]}"
sleep 4
kill -9 "${pid[odometry]}"
wait "$whole" || fail "a launch exits with $?: $(cat "$work/whole.err")"
check "a whole drive" "$work/whole" '
assert driving["readings"]["applied"] > 20, driving
assert all(0 <= vehicle["actuator"]["told"] - vehicle[node]["heard"] <= 1 for node in ("laser", "camera")), vehicle'
wait "$killed" || fail "a launch whose actuator comes back exits with $?: $(cat "$work/killed.err")"
check "an actuator that comes back" "$work/killed" '
# The new processes have the commands of the old ones.
assert vehicle["actuator"]["told"] > 0 and vehicle["actuator"]["heard"] > 0, vehicle
assert vehicle["odometry"]["heard"] >= vehicle["actuator"]["heard"] + vehicle["actuator"]["told"] - 1, vehicle'
for one in "${by_hand[@]}"; do wait "$one" || fail "a node that is started by hand exits with $?: $(cat "$work"/hand.*.err)"; done
python3 -c 'import json, sys
vehicle = {node: json.load(open(f"{sys.argv[1]}/hand.{node}"))["real_time"]["vehicle"] for node in ("laser", "camera", "odometry", "actuator")}
assert all(counts["whole"] for counts in vehicle.values()), vehicle
assert all(0 <= vehicle["actuator"]["told"] - vehicle[node]["heard"] <= 1 for node in ("laser", "camera", "odometry")), vehicle
assert vehicle["actuator"]["told"] > 0, vehicle' "$work" || fail "nodes by hand: $(cat "$work"/hand.*.err)"

[[ $failures -eq 0 ]] && echo "the loop closed in real time: as documented"
exit $((failures > 0))
