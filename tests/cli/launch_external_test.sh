#!/usr/bin/env bash
# `ttfusion launch --external` over DDS: examples/real_node_dds.c, which has the type of a sample alone, in
# camera_pre's place. An ordinary kernel's lateness is allowed for: a part of its frames may be late.
#   launch_external_test.sh PROGRAM SOURCE_DIR REAL_NODE
set -u
program=$1
source=$2
real_node=$3
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/launching.sh"
[[ -e /sys/class/net/lo ]] && "$program" launch "$source/scenarios/paper_scenario1.yaml" --dry-run >/dev/null 2>&1 ||
  { echo "skipped: no loopback interface"; exit 77; }
session=real-node-$$
"$real_node" 2>"$work/usage"
[[ $? -eq 2 && $(<"$work/usage") == usage:* ]] || fail "no usage without a session: $(<"$work/usage")"
launch_options=(--no-topics --session "$session" --external camera_pre)
drive=$source/tests/test_bed/short_drive.yaml

CYCLONEDDS_URI=file://$source/bus/dds/loopback.xml "$real_node" "$session" 4 &
real=$!
launch "$work/there" "$drive" --time-scale 4 || fail "exit code $?: $(cat "$work/there.err")"
kill "$real"
wait "$real" 2>/dev/null
python3 - "$work/there" <<'PY' || fail "$(cat "$work/there.out" "$work/there.err")"
import json, sys
folder = sys.argv[1]
summary, manifest = (json.load(open(f"{folder}/{name}.json")) for name in ("summary", "manifest"))
real, = manifest["external_nodes"]
assert summary["external_nodes"] == [real] and real["node"] == "camera_pre" and real["state"] == "sending", real
# A process that stands still for a cycle is in another one.
assert real["malformed"]["all"] == real["malformed"]["not of its slot"] + real["malformed"]["repeated"], real
# 200 cycles on two channels; triggers and lists in every eighth.
counted = real["in_window"] + real["early"] + real["late"] + real["missing"]
assert counted >= 400 and real["in_window"] >= counted / 4, real
# The others use it as they would the node in its place, and did not wait in vain.
assert summary["strategies"][0]["uses"] >= 8, summary["strategies"][0]["uses"]
assert all(node["said"]["medium"]["malformed"] == 0 for node in manifest["health"] if node["node"] != "camera_pre")
PY
grep -q 'continues without the missing nodes' "$work/there/launch.log" && fail "a process waited for the real node"
grep -q 'real node' "$work/there.out" || fail "no table of it: $(cat "$work/there.out")"
[[ ! -e $work/there/camera_pre.mcap ]] || fail "it has a log"

launch "$work/absent" "$drive"
[[ $? -eq 1 ]] || fail "a drive without it does not fail"
grep -q 'ended: nothing was heard of camera_pre' "$work/absent.err" || fail "$(cat "$work/absent.err")"

[[ $failures -eq 0 ]] && echo "a real node over DDS: as the page says"
exit $((failures > 0))
