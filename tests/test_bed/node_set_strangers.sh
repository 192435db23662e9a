#!/usr/bin/env bash
# can-utils beside the node set on its interfaces, and in place of a sensor.
#   node_set_strangers.sh TTFUSION VCAN_PEER      exit code 77, with the reason, where there is no vcan or no can-utils
set -euo pipefail
source "$(dirname "$0")/node_set.bash"
peer=$(realpath "$2")
need python3 candump cansend cangen canplayer
make_interfaces

frames_of() { "$ttfusion" export "$1" --format csv -o "$run/frames.csv" 2>"$run/words" && cat "$run/frames.csv"; }

echo "noise on a channel and on a private CAN is counted and ignored, reports of errors are recorded, and what candump records" \
  "of ours is as the page says"
candump -L "$a" >"$run/channel.log" &
ears=($!)
candump -L "$laser_can" >"$run/laser.log" &
ears+=($!)
wait_for_receivers "$a" 1
wait_for_receivers "$laser_can" 1
launch "$run/drive" &
launch=$!
wait_for "all nodes are ready" "$run/drive/launch.log"
sleep 0.6
quietly() { "$@" >/dev/null; }
for interface in "$a" "$laser_can"; do
  quietly cangen "$interface" -g 3 -n 40 -I i -e -L 8 -D r &                     # 29-bit identifiers
  for _ in $(seq 20); do
    cansend "$interface" 20000080#0000000000000000                               # an error frame
    cansend "$interface" 123#R                                                   # a remote frame
    sleep 0.005
  done &
done
quietly cangen "$a" -g 3 -n 40 -I i -L 8 -D r &                                    # classic, on our identifiers
quietly cangen "$a" -g 3 -n 60 -I i -L i -D r -f &                                 # CAN FD on our identifiers
quietly cangen "$laser_can" -g 3 -n 40 -I 300 -L 8 -D r &                          # an unassigned identifier
for _ in $(seq 10); do
  cansend "$laser_can" 001#010203                                                # a strobe of three bytes
  cansend "$laser_can" 002#00                                                    # a trigger of one
  cansend "$laser_can" 100##1.00.00.00.00                                        # a fragment of the laser's list, too short
  sleep 0.01
done &
# Reports of a driver: a bit error in a frame of its own, a stuff error in another's, bus off, restarted,
# error passive. The counters of errors are the last two bytes.
reports=(20000288#0000810000000800 20000288#0000040000000001 20000240#000000000000FF00 20000300#0000000000000000
  20000204#0020000000008000)
for report in "${reports[@]}"; do
  cansend "$laser_can" "$report"
  sleep 0.01
done &
wait "$launch" || fail "exit code $?: $(cat "$run/drive.txt")"
judge_drive "$run/drive" \
  'all(nodes[n]["medium"]["foreign"] == 40 + 20 + 20 + 40 for n in ("camera_pre", "gateway", "fusion", "feature"))' \
  "on the channel: 29-bit, error, remote and classic frames" \
  'all(nodes[n]["medium"]["malformed"] == 60 for n in ("camera_pre", "gateway", "fusion", "feature"))' \
  "on the channel: CAN FD frames that are none of ours" \
  'nodes["laser_pre"]["medium"]["foreign"] == 120 + 80 and nodes["laser"]["medium"]["foreign"] == 80' \
  "on the laser's CAN: 29-bit, error and remote frames" \
  'summary["refused_can_frames"] == 2 * (40 + 10 + 10 + 10)' "on the laser's CAN: identifiers and lengths that nobody has" \
  'all((nodes[n]["can_errors"], nodes[n]["can_state"]) == (2, "error passive") for n in ("laser", "laser_pre"))' \
  "on the laser's CAN: errors and the state of the controllers" \
  'not any("can_state" in nodes[n] for n in ("camera", "camera_pre"))' "on the camera's CAN: reports of nothing"
[[ $(grep -c 'CAN error passive' "$run/drive.txt") -ge 2 ]] || fail "the table has no CAN in trouble: $(cat "$run/drive.txt")"
for node in laser laser_pre; do
  "$ttfusion" export "$run/drive/$node.mcap" --format candump -o "$run/$node.reports" 2>"$run/words"
  awk '$2 == "laser_can" && $3 ~ /^20000/ { print $3 }' "$run/$node.reports" | diff - <(printf '%s\n' "${reports[@]}") ||
    fail "the log of $node has other reports (<) than there were (>)"
done
kill "${ears[@]}"
wait "${ears[@]}" || true

echo "what candump recorded of a channel is what all nodes sent there"
"$peer" listen "$a" A 500 >"$run/received" 2>"$run/ready" &
listener=$!
wait_for listening "$run/ready"
canplayer -I "$run/channel.log" "$a=$a"
wait "$listener"
frames_of "$run/drive/tt.mcap" >"$run/drive.csv"
# Slot, cycle counter and payload of each frame.
awk -F, '$2 == "FlexRay" && $3 == "A" { print $5, $4 % 64, $13 }' "$run/drive.csv" | sort >"$run/logged"
awk '$1 == "slot" && $NF != "late" { print $2, $4, $NF }' "$run/received" | sort >"$run/decoded"
[[ -s $run/logged ]] || fail "no frames in the log"
diff "$run/logged" "$run/decoded" >"$run/difference" || fail "other frames than in the log: $(head "$run/difference")"
follow_ups=$(grep -c " ns late$" "$run/received") sync_frames=$(grep -c "sync" <(grep "^[^,]*,FlexRay,A" "$run/drive.csv"))
[[ $follow_ups -eq $sync_frames ]] || fail "$follow_ups follow-ups of $sync_frames sync frames"

echo "canplayer takes the laser's place: what it recorded of it gives the same observations"
# The device's frames; triggers are the host's.
grep -E ' (001#[0-9A-F]{8}|100##[0-9A-F]{129})$' "$run/laser.log" >"$run/device.log"
mkdir "$run/by_hand"
start=$(($(date +%s) + 3))
nodes=()
for node in camera laser_pre camera_pre gateway fusion feature; do
  "$ttfusion" node "$node" "$drive" "${on_vcans[@]}" --start-at "$start" --json --out "$run/by_hand" \
    >"$run/by_hand/$node.json" 2>"$run/by_hand/$node.txt" &
  nodes+=($!)
done
candump -n 1 "$laser_can,002:7FF" >"$run/trigger"   # the first
canplayer -I "$run/device.log" "$laser_can=$laser_can" &
for node in "${nodes[@]}"; do wait "$node" || fail "$(cat "$run"/by_hand/*.txt)"; done
observations() {   # without sequence number and time stamp
  frames_of "$1" | awk -F, '$2 == "observation_can" && $9 == "laser_objects" { print substr($13, 17) }'
}
observations "$run/drive/laser_pre.mcap" >"$run/of_the_emulator"
observations "$run/by_hand/laser_pre.mcap" >"$run/of_the_player"
[[ $(wc -l <"$run/of_the_emulator") -ge 10 ]] || fail "$(wc -l <"$run/of_the_emulator") observations of the emulator"
diff "$run/of_the_emulator" "$run/of_the_player" || fail "other observations"
# Images with an object in them, of 25.
images=$(frames_of "$run/by_hand/fusion.mcap" |
  awk -F, '$3 == "A" && $9 == "image" && $11 == "0" && substr($13, 7, 2) != "00"' | wc -l)
[[ $images -ge 15 ]] || fail "$images images"
echo "node set and strangers: all as the page says"
