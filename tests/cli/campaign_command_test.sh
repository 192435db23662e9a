#!/usr/bin/env bash
# `ttfusion experiment` of a fault campaign: the table, shards, replays, refused input.
#   campaign_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/shipped.sh"

campaign=$work/schedules/campaign.yaml
sed -e 's#^cluster: .*#cluster: flexray_demo.yaml#' -e 's/^faults: .*/faults: 24/' \
  "$source/experiments/fault_campaign.yaml" >"$campaign"
expect 0 'Example' experiment --help
expect 0 'variant guardian \(guardian and two channels\)' experiment "$campaign" --jobs 2 --out "$work/campaign"
expect 0 '"holds": true' experiment "$campaign" --jobs 1 --json
expect 0 '' experiment "$campaign" --shard 1/2 --out "$work/shard1"
expect 0 '' experiment "$campaign" --shard 2/2 --out "$work/shard2"
expect 0 'holds' experiment "$campaign" --merge "$work/shard1" "$work/shard2" --out "$work/merged"
cmp -s "$work/campaign/results.csv" "$work/merged/results.csv" || fail "shards put together give other results"
awk -F, -v OFS=, '$2 == "guardian" && $7 == "yes" && !done { $12 = "frame_lost"; done = 1 } 1' \
  "$work/merged/results.csv" >"$work/campaign/results.csv"
expect 1 'does not hold' experiment "$campaign" --merge "$work/campaign"
says 'ttfusion experiment .*campaign.yaml --replay [0-9]+'
sed -e 's/^seed: .*/seed: 77/' "$campaign" >"$work/schedules/seed.yaml"
expect 0 '' experiment "$work/schedules/seed.yaml" --out "$work/copy"
expect 0 '' experiment "$campaign" --seed 77 --out "$work/seed"
cmp -s "$work/copy/results.csv" "$work/seed/results.csv" || fail "--seed 77 is not a copy of the file with seed 77"
cmp -s "$work/merged/results.csv" "$work/seed/results.csv" && fail "another seed draws the same faults"
grep -q '"seed": 77,' "$work/seed/coverage.json" || fail "coverage.json does not name the seed"
expect 2 'results.csv:[0-9]+: line' experiment "$campaign" --merge "$work/seed"
expect 0 '' experiment "$campaign" --seed 77 --merge "$work/seed"
expect 2 'campaign.yaml: --merge: lacks shard 2/2: give the folders of all shards' experiment "$campaign" \
  --merge "$work/shard1"
expect 0 '' experiment "$campaign" --shard 3/5 --out "$work/shard3"
expect 2 'lacks shard 1/5, 2/5, 4/5, 5/5' experiment "$campaign" --merge "$work/shard3"
expect 2 '--merge = [0-9]+: is a (missing|repeated) fault' experiment "$campaign" --merge "$work/shard1" \
  "$work/shard3"
expect 0 'fault 3: [a-z_]+ ' experiment "$campaign" --replay 3
for fault in 2 3 8; do
  "$program" experiment "$campaign" --replay $fault >"$work/replay.txt"
  awk '/^variant/ { last = -1 } / ms  cycle / { shown++; if ($1 < last) bad = 1; last = $1 } END { exit bad || shown < 20 }' \
    "$work/replay.txt" || fail "the replay of fault $fault is not in the order of time"
done
: >"$work/file"
expect 1 'error: .*/file/x: cannot be created: Not a directory' \
  experiment "$source/experiments/fault_campaign.yaml" --out "$work/file/x"
expect 2 '--replay = 24: must be 0..23' experiment "$campaign" --replay 24
expect 2 '--shard = 3/2: must be i/n' experiment "$campaign" --shard 3/2
sed -e 's/guardian: true/guardian: true, why: not/' "$campaign" >"$work/schedules/broken.yaml"
expect 2 'broken.yaml:[0-9]+: variants.guardian.why: is not a known key' experiment "$work/schedules/broken.yaml"
sed -e 's/^kind: .*/kind: voyage/' "$campaign" >"$work/schedules/broken.yaml"
expect 2 'kind = voyage: must be sweep or fault_campaign' experiment "$work/schedules/broken.yaml"
sed -e 's/^expect:/classes: {crash: 1}\nexpect:/' "$campaign" >"$work/schedules/crashes.yaml"
expect 0 'crash +24 ' experiment "$work/schedules/crashes.yaml"

[[ $failures -eq 0 ]] && echo "campaign command: all as documented"
exit $((failures > 0))
