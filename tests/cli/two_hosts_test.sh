#!/usr/bin/env bash
# A node set split over two hosts, on DDS: two network namespaces with a veth pair between them. They share a
# kernel clock. With time namespaces, the second host's CLOCK_MONOTONIC has another origin. Its UTC is 1.5 ms
# ahead, by another --start-at. The cluster's clocks overcome that, and logs are merged by those clocks. Exits
# with 77 and the reason where namespaces are not permitted.
#   two_hosts_test.sh PROGRAM SOURCE_DIR LOG_FACTS [TIME_SCALE]
set -u
program=$1
source=$2
log_facts=$3
scale=${4:-20}

# This shell becomes the first host.
if [[ ${TTF_FIRST_HOST-} != yes ]]; then
  command -v ip >/dev/null && command -v nsenter >/dev/null || { echo "skipped: no ip or nsenter (iproute2, util-linux)"; exit 77; }
  for way in "unshare --net" "unshare --net --user --map-root-user"; do
    $way true 2>/dev/null && TTF_FIRST_HOST=yes exec $way "$0" "$@"
  done
  echo "skipped: network namespaces are not permitted: $(unshare --net true 2>&1)"
  exit 77
fi

source "$(dirname "$0")/expect.sh"
other="--net"
unshare --time true 2>/dev/null && other="--net --time"
# shellcheck disable=SC2086
unshare $other $([[ $other == *time ]] && echo --monotonic 1000) sleep 600 &
holder=$!
trap 'kill $holder; rm -rf "$work"' EXIT
for _ in $(seq 50); do   # until it is in its namespace
  [[ $(readlink /proc/$holder/ns/net) != "$(readlink /proc/self/ns/net)" && $(cat /proc/$holder/comm) == sleep ]] && break
  sleep 0.1
done
on_second() { nsenter --target "$holder" $other -- "$@"; }
{
  ip link add ttf_first type veth peer name ttf_second netns "$holder" && ip address add 10.77.0.1/24 dev ttf_first &&
    ip link set lo up && ip link set ttf_first up && on_second ip address add 10.77.0.2/24 dev ttf_second &&
    on_second ip link set lo up && on_second ip link set ttf_second up
} 2>"$work/ip.err" || { echo "skipped: no veth pair between namespaces: $(cat "$work/ip.err")"; exit 77; }

# As bus/dds/loopback.xml recommends for several machines.
for host in first second; do
  sed -e 's#<NetworkInterface name="lo"#<NetworkInterface name="ttf_'$host'"#' -e '/<MaxMessageSize>/d; /<FragmentSize>/d' \
    -e 's#<Peer Address="127.0.0.1"/>#<Peer Address="10.77.0.1"/><Peer Address="10.77.0.2"/>#' \
    "$source/bus/dds/loopback.xml" >"$work/$host.xml"
done
# A window that covers the hosts' initial clock distance. It is wide, because nodes outside it are no longer
# followed. With this stretching, a loaded kernel's late wake-ups stay within it.
sed -e "s/^real_time:.*/real_time: {early: $((400 * scale)) us, late: $((500 * scale)) us}/" \
  "$source/schedules/paper_synchronised.yaml" >"$work/cluster.yaml"
sed -e "s#\.\./schedules/paper_unsynchronised#$source/schedules/paper_unsynchronised#" \
  -e "s#\.\./schedules/paper_synchronised#$work/cluster#" -e "s/^evaluate_from:.*/evaluate_from: 400 ms/" \
  "$source/scenarios/paper_scenario1.yaml" >"$work/drive.yaml"

# Seven processes are to be there by then, on a loaded machine, too.
now=$(python3 -c 'import time; print(time.time() + 6)')
first_start=$(python3 -c "print(f'{$now:.6f}')")
second_start=$(python3 -c "print(f'{$now + 0.0015:.6f}')")   # its clock is ahead: it begins later
pids=()
node() {   # HOST START NAME
  local run=
  [[ $1 == second ]] && run=on_second
  CYCLONEDDS_URI=file://$work/$1.xml $run "$program" node "$3" "$work/drive.yaml" --no-topics --host "$1" --start-at "$2" \
    --time-scale "$scale" --duration 1 --out "$work/$1" --json >"$work/$3.json" 2>"$work/$3.err" &
  pids+=($!)
}
for name in laser laser_pre gateway fusion; do node first "$first_start" $name; done
for name in camera camera_pre feature; do node second "$second_start" $name; done
for pid in "${pids[@]}"; do wait "$pid" || fail "a node exits with $?: $(cat "$work"/*.err)"; done

logs=$(echo "$work"/first/*.mcap "$work"/second/*.mcap)
# shellcheck disable=SC2086
"$log_facts" $logs >"$work/facts.json" || fail "the logs of two hosts cannot be read together"
for host in first second; do "$log_facts" "$work/$host"/*.mcap >"$work/$host.json" || fail "logs of $host"; done
python3 - "$work" "$scale" <<'PY' || fail "two hosts do not drive together, or their logs are not on one time"
import json, os, statistics, sys
work = sys.argv[1]
def read(name): return json.load(open(os.path.join(work, name + ".json")))
facts, first, second = read("facts"), read("first"), read("second")
for name in ("laser_pre", "gateway", "fusion", "camera_pre", "feature"):
    real_time = read(name)["real_time"]
    assert real_time["state"] == "normal active", (name, real_time, [s for s in facts["states"] if s["node"] == name])
assert facts["features"] and max(facts["features"]) > 0.9, facts["features"]
assert all(log["whole"] for log in facts["logs"]) and not facts["warnings"], facts
assert {log["host"] for log in facts["logs"]} == {"first", "second"}
assert (first["clock"], second["clock"], facts["clock"]) == ("wall", "wall", "common")

ROUND = 64 * 5_000_000
SCALE = int(sys.argv[2])
APART = 100_000                 # ns of real time; a few microseconds on a quiet machine
START = 1_500_000 / SCALE       # in the drive's time: by so much less has passed of it on the second host

# Each node's clock reading, less its host's. Within a host they agree up to the cluster's precision. Between hosts they
# differ by the hosts' clock distance.
def shown(facts):
    by_node = {}
    for corrected in facts["corrections"]:
        if corrected["at_ns"] > 600_000_000:
            by_node.setdefault(corrected["node"], []).append(corrected["global_ns"] - corrected["at_ns"])
    return by_node
def apart(one, other):     # medians, and how far any is from the other's median
    middle = statistics.median(one)
    differences = [(value - middle + ROUND // 2) % ROUND - ROUND // 2 for value in other]
    return statistics.median(differences), max(abs(d - START) for d in differences)
own = {**shown(first), **shown(second)}
assert set(own) == {"laser_pre", "gateway", "fusion", "camera_pre", "feature"}, own
merged = shown(facts)
for name in ("camera_pre", "feature"):
    raw, _ = apart(own["gateway"], own[name])
    put, _ = apart(merged["gateway"], merged[name])
    print(f"{name}: {raw / 1000:.1f} us ahead of the first host by its own clock, {put / 1000:.1f} us after the merge;"
          f" {(raw - START) * SCALE / 1000:.1f} us of real time between the hosts")
    assert abs(raw - START) * SCALE < APART, (name, raw)     # they began 1.5 ms apart
    assert abs(put) * SCALE < APART, (name, put)
PY
# shellcheck disable=SC2086
{
  expect 0 '' diagram $logs --kind timing --from 0.5 --to 0.54 -o "$work/timing.svg"
  expect 0 '' diagram $logs --kind lateness -o "$work/lateness.svg"
  expect 0 'wrote' export $logs --format pcapng -o "$work/frames.pcapng"
}
for file in timing.svg lateness.svg; do grep -q '<svg' "$work/$file" || fail "no picture $file"; done

[[ $failures -eq 0 ]] && echo "two hosts: one cluster, one time"
exit $((failures > 0))
