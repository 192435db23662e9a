#!/usr/bin/env bash
# The node set as processes on vcans: all finish a drive without losses, and the images are used.
#   node_set.sh TTFUSION      its logs stay in LOGS, if that is set; exit code 77, with the reason, without a vcan
set -euo pipefail
source "$(dirname "$0")/node_set.bash"
need python3
make_interfaces
launch "$run/drive" || fail "$(cat "$run/drive.txt")"
judge_drive "$run/drive" 'medium("foreign") + medium("malformed") == 0' "there is something foreign"
[[ -z ${LOGS:-} ]] || cp "$run/drive/tt.mcap" "$LOGS"
grep -o '"content_hash": "[0-9a-f]*"' "$run/drive/summary.json"
