#!/usr/bin/env bash
# can-utils as strangers on vcan0 and vcan1, and a process of ours (vcan_peer.cc): each must see the other as
# docs/media/socketcan.md describes.
#   strangers.sh VCAN_PEER    exit code 77, with the reason, without a vcan or can-utils; 1 if a test fails
set -euo pipefail
peer=$(realpath "$1")
cd "$(dirname "$0")/../.."
page=docs/media/socketcan.md

export PATH=$PATH:/usr/sbin:/sbin
for program in candump cansend cangen canplayer ip; do
  command -v "$program" >/dev/null && continue
  echo "skipped: no $program (Debian: can-utils, iproute2)"
  exit 77
done
for interface in vcan0 vcan1; do
  if ! reason=$("$peer" listen "$interface" A 1 2>&1 >/dev/null); then
    echo "skipped: $reason"
    exit 77
  fi
done

run=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$run"' EXIT
source tests/test_bed/waiting.bash
# The page's examples for that interface, from the identifier on, as candump shows them.
examples() { sed -nE "s/^    $1 +([0-9A-F]{3} .*)/\1/p" "$page"; }
shown() { sed -E 's/^ *vcan[0-9]+ +//; s/ +$//' "$1"; }
# 001  [08]  01 02 ...  ->  001##10102...
as_cansend() { sed -E 's/^([0-9A-F]+) +\[[0-9]+\] +/\1##1/; s/ //g'; }

echo "what cansend sends as the page says, we understand; what we say of it, candump shows as the page says"
for channel in A:vcan0 B:vcan1; do
  examples "${channel#*:}" >"$run/expected"
  [[ -s $run/expected ]] || fail "no examples of ${channel#*:} in $page"
  candump -T 1000 vcan1 >"$run/shown" &
  candump -L -T 1000 vcan1 >"$run/recorded" &
  wait_for_receivers vcan1 2
  "$peer" listen vcan0 "${channel%:*}" 500 vcan1 >"$run/received" 2>"$run/ready" &
  wait_for listening "$run/ready"
  as_cansend <"$run/expected" | while read -r frame; do cansend vcan0 "$frame"; done
  wait
  diff <(shown "$run/shown") "$run/expected" || fail "candump sees another frame on channel ${channel%:*}"
  grep -q ' foreign 0 malformed 0 displaced 0 abandoned 0 lost 0' "$run/received" || fail "$(tail -1 "$run/received")"
  # canplayer replays candump's recording.
  "$peer" listen vcan0 "${channel%:*}" 500 >"$run/replayed" 2>"$run/ready" &
  wait_for listening "$run/ready"
  canplayer -I "$run/recorded" vcan0=vcan1
  wait
  diff "$run/received" "$run/replayed" || fail "a replay is something else"
done

echo "strangers' frames are counted and ignored, while three of ours go on"
"$peer" listen vcan0 A 5000 >"$run/received" 2>"$run/ready" &
listener=$!
wait_for listening "$run/ready"
start=$(($(date +%s) + 2))
nodes=()
for slot in 1 2 3; do
  "$peer" node vcan0 A "$slot" 3 200 "$start" >"$run/node_$slot" &
  nodes+=($!)
done
sleep "$((start - $(date +%s)))"
cangen vcan0 -g 2 -n 100 -I i -L 8 -D r
cangen vcan0 -g 2 -n 100 -I i -L 8 -D r -e
cangen vcan0 -g 2 -n 100 -I i -L i -D r -f
for node in "${nodes[@]}"; do wait "$node" || fail "a node lost frames: $(tail -qn1 "$run"/node_*)"; done
wait "$listener"
read -r _ complete _ _ _ foreign _ malformed _ displaced _ _ _ lost <<<"$(tail -1 "$run/received")"
[[ $complete -eq 600 && $foreign -eq 200 && $((malformed + displaced)) -eq 100 && $lost -eq 0 ]] ||
  fail "600 complete, 200 foreign, 100 malformed: $(tail -1 "$run/received")"

echo "what nobody reads is counted"
"$peer" deaf vcan0 64 3000 >"$run/deaf" 2>"$run/ready" &
wait_for listening "$run/ready"
cangen vcan0 -g 0 -n 500 -I i -L 64 -f
wait
read -r _ received _ lost <"$run/deaf"
[[ $received -ge 64 && $lost -gt 0 && $((received + lost)) -eq 500 ]] || fail "500 sent, $(cat "$run/deaf")"

if [[ $(id -u) -eq 0 ]]; then
  echo "an interface that goes down ends in a clear sentence"
  ip link del dev vcan98 2>/dev/null || true
  ip link add dev vcan98 type vcan
  ip link set vcan98 mtu 72 up
  "$peer" listen vcan98 A 60000 >"$run/received" 2>"$run/ready" &
  listener=$!
  wait_for listening "$run/ready"
  ip link set vcan98 down
  code=0
  wait "$listener" || code=$?
  ip link del dev vcan98
  [[ $code -eq 1 ]] && grep -qx 'vcan98: the interface went down during the run: ip link set vcan98 up' "$run/ready" ||
    fail "exit code $code: $(cat "$run/ready")"
fi
echo "strangers: all as the page says"
