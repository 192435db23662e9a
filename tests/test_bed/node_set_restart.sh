#!/usr/bin/env bash
# A node killed under --policy NODE=restart comes back, integrates, and goes on. The others lose only its
# frames.
#   node_set_restart.sh TTFUSION      its logs stay in LOGS, if that is set; exit code 77, with the reason, without a vcan
set -euo pipefail
source "$(dirname "$0")/node_set.bash"
need python3
make_interfaces
launch "$run/drive" --duration 2 --policy camera_pre=restart &
launch=$!
wait_for "all nodes are ready" "$run/drive/launch.log"
camera_pre=$(process_of camera_pre "$run/drive/manifest.json")
sleep_to 1203400000   # 3.4 ms into a cycle, where little is done
kill -KILL "$camera_pre"
wait "$launch" || fail "exit code $?: $(cat "$run/drive.txt")"
grep -q "camera_pre: signal 9 (Killed); restart 1 of 5 in 0.5 s" "$run/drive.txt" || fail "$(cat "$run/drive.txt")"
judge "$run/drive" \
  'nodes["camera_pre"]["state"] == "normal active"' "camera_pre has not come back" \
  'all(node.get("state", "normal active") == "normal active" for node in nodes.values())' "who is not normal active?" \
  'lost("drops") + lost("frames_lost") == 0' "somebody has lost frames" \
  'summary["uses"] >= 8' "the feature service used too little"
for log in camera_pre.mcap camera_pre.2.mcap; do
  "$ttfusion" export "$run/drive/$log" --format csv -o "$run/$log.csv" 2>"$run/words" || fail "$log: $(cat "$run/words")"
  [[ $(grep -c ",camera_pre,.*,camera_objects," "$run/$log.csv") -ge 3 ]] || fail "no observations in $log"
done
[[ -z ${LOGS:-} ]] || cp "$run/drive/tt.mcap" "$LOGS"
grep -o '"content_hash": "[0-9a-f]*"' "$run/drive/summary.json"
