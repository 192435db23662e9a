#!/usr/bin/env bash
# Ten processes in ten slots of vcan0, 300 cycles, and one that only listens. Writes the frames that each
# received, with their instants, into a folder. In virtual time the result is the same each time, to the
# nanosecond.
#   exchange.sh VCAN_PEER FOLDER
set -euo pipefail
peer=$1
folder=$2
mkdir -p "$folder"
start=$(($(date +%s) + 2))
nodes=()
for slot in $(seq 10); do
  "$peer" node vcan0 A "$slot" 10 300 "$start" >"$folder/node_$slot" &
  nodes+=($!)
done
for node in "${nodes[@]}"; do wait "$node"; done
