#!/usr/bin/env bash
# `ttfusion experiment` of a campaign on a CAN: the table, shards, replays, refused input.
#   can_campaign_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/shipped.sh"

campaign=$work/schedules/campaign.yaml
sed -e 's#^cluster: ../schedules/#cluster: #' -e 's/^faults: .*/faults: 100/' \
  "$source/experiments/can_fault_campaign.yaml" >"$campaign"
expect 0 'variant automatic \(automatic recovery\)' experiment "$campaign" --jobs 2 --out "$work/campaign"
says 'can_stuck_dominant +[1-9]'
says 'to bus off'
says 'expected: no fault of .*; found 0: holds'
expect 0 '' experiment "$campaign" --shard 1/2 --jobs 1 --out "$work/shard1"
expect 0 '' experiment "$campaign" --shard 2/2 --jobs 2 --out "$work/shard2"
expect 0 'holds' experiment "$campaign" --merge "$work/shard1" "$work/shard2" --out "$work/merged"
expect 0 '"harmed_by_harmless": 0' experiment "$campaign" --merge "$work/shard1" "$work/shard2" --json
cmp -s "$work/campaign/results.csv" "$work/merged/results.csv" || fail "shards put together give other results"
head -1 "$work/campaign/results.csv" | grep -q 'sender,identifier,.*bus_off_after_ns' || fail "the table has other columns"
stuck=$(awk -F, '$3 == "can_stuck_dominant" { print $1; exit }' "$work/campaign/results.csv")
expect 0 "fault $stuck: can_stuck_dominant of " experiment "$campaign" --replay "$stuck"
says 'begins an error frame as'
says 'error active -> error passive'
sed -e 's/^expect:/classes: {can_babbling: 1}\nexpect:/; s/^  harmless: .*/  harmless: [can_babbling]/' "$campaign" \
  >"$work/schedules/babbling.yaml"
expect 1 'does not hold' experiment "$work/schedules/babbling.yaml"
says 'ttfusion experiment .*babbling.yaml --replay [0-9]+'

# Broken CHANGE MESSAGE: refused with one sentence.
broken() {
  sed -e "$1" "$campaign" >"$work/schedules/broken.yaml"
  expect 2 "$2" experiment "$work/schedules/broken.yaml"
}
broken 's/^can: .*/can: cabin/' 'broken.yaml:[0-9]+: can = cabin: must be a CAN of paper_event_triggered: laser_can'
broken 's/^can: .*/can: laser_can/' 'can = laser_can: must have at least 3 nodes: it has 2'
broken 's/^duration: .*/duration: 1 ms/' 'duration = 1 ms: must be '
broken 's/^seed: .*/seed: 1\nstart_up: 0.5/' 'start_up: is not a known key'
broken 's/{recovery: never}/{topology: bus, guardian: false, channels: AB}/' 'variants.never: must have recovery instead'
broken 's/^  harmless: .*/  harmless: [crash]/' 'harmless.* = crash: must be '
broken 's/^  harmless: .*/  harmed_with_guardian: 0/' 'harmed_with_guardian = 0: must be harmless instead'
sed -e 's/topology: star, guardian: true, channels: AB/recovery: never/' -e 's#^cluster: ../schedules/#cluster: #' \
  -e '/^expect:/,$d' "$source/experiments/fault_campaign.yaml" >"$work/schedules/broken.yaml"
expect 2 'variants.guardian.recovery = never: needs the key .can.' experiment "$work/schedules/broken.yaml"

[[ $failures -eq 0 ]] && echo "campaign on a CAN: all as documented"
exit $((failures > 0))
