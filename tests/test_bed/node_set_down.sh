#!/usr/bin/env bash
# An interface goes down under the node set: a sentence reports it, and all stop in order, with readable logs.
#   node_set_down.sh TTFUSION      exit code 77, with the reason, without a vcan
set -euo pipefail
source "$(dirname "$0")/node_set.bash"
need python3
for channel in "$b" "$a"; do
  make_interfaces
  launch "$run/drive" &
  launch=$!
  wait_for "all nodes are ready" "$run/drive/launch.log"
  sleep 0.9
  ip link set "$channel" down
  code=0
  wait "$launch" || code=$?
  words=$run/drive.txt
  [[ $code -eq 1 ]] || fail "exit code $code: $(cat "$words")"
  grep -q "error: $channel: the interface went down during the run: ip link set $channel up" "$words" ||
    fail "not a word of $channel: $(cat "$words")"
  ! grep -q "still running" "$words" || fail "somebody does not stop: $(cat "$words")"
  ! grep -q "warning: .*mcap" "$words" || fail "a log is not whole: $(cat "$words")"
  judge "$run/drive" 'manifest["exit_code"] == 1 and manifest["why"].endswith(": exit 1")' "the manifest says something else" \
    'all(p["signal"] is None and p["exit"] in (0, 1) for n in manifest["nodes"] for p in n["processes"])' "who ended how?"
  for log in "$run"/drive/{laser,camera,laser_pre,camera_pre,gateway,fusion,feature}.mcap; do
    "$ttfusion" export "$log" --format csv -o "$run/frames.csv" 2>"$run/words" || fail "$log: $(cat "$run/words")"
    ! grep -q warning "$run/words" || fail "$log: $(cat "$run/words")"
  done
  end_all
done
echo "an interface that goes down: all as it must be"
