#!/usr/bin/env bash
# The loop closed on vcans. Commands on the bus drive the vehicle. Its processes compute the same way of it.
#   node_set_closed_loop.sh TTFUSION      its logs stay in LOGS, if that is set; exit code 77, with the reason, without a vcan
set -euo pipefail
source "$(dirname "$0")/node_set.bash"
need python3
drive=$project/tests/test_bed/short_loop.yaml
interfaces+=(ttfcan5)
on_vcans+=(--can odometry_can=ttfcan5)
make_interfaces
launch "$run/drive" || fail "$(cat "$run/drive.txt")"
judge_drive "$run/drive" 'medium("foreign") + medium("malformed") == 0' "there is something foreign" \
  'summary["driving"]["readings"]["applied"] > 20' "too few commands were applied" \
  'summary["driving"]["readings"]["late"] == 0' "commands were late" \
  'summary["driving"]["emergency_brakings"]["right"] == 1 and summary["driving"]["collision"] is None' \
  "the brakes did not stop the vehicle" \
  'sorted(name for name, node in nodes.items() if "vehicle" in node) == ["actuator", "camera", "laser", "odometry"]' \
  "who computes the vehicle?" \
  'all(node["vehicle"]["whole"] and not node["vehicle"]["malformed"] for node in nodes.values() if "vehicle" in node)' \
  "a process does not know the whole way of the vehicle"
[[ -z ${LOGS:-} ]] || cp "$run/drive/tt.mcap" "$LOGS"
grep -o '"content_hash": "[0-9a-f]*"' "$run/drive/summary.json"
