#!/usr/bin/env bash
# `ttfusion run --truth` and `export --format osi`: worlds of other simulators in, truth and tracks out.
#   run_truth_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

for trace in lane_change cut_in queue; do
  python3 "$source/examples/osi_traces.py" $trace "$work/$trace.osi" || fail "no trace $trace"
done
drive=(run "$source/scenarios/paper_scenario2.yaml" --strategy tt --no-pictures)

# A world seen from the ground. Its ids are reported, and the scenario's object is not there.
expect 0 'truth of .*/lane_change.osi, a trace of GroundTruth as its messages show: 1 object in 401 messages over 8 s, seen from the ground' \
  "${drive[@]}" --truth "$work/lane_change.osi" --duration 8 --out "$work/a"
says "the scenario's object is not there" 'position RMSE' 'The world of .*/lane_change.osi, with the sensors and the tracker of paper_scenario2'
[[ $output != *'turns off'* ]] || fail "the description of a world that is not there: $output"
python3 -c '
import json, sys
summary = json.load(open(sys.argv[1]))
assert summary["truth"]["objects"] == [{"id": 42, "kind": "vehicle"}] and summary["truth"]["length_s"] == 8.0, summary["truth"]
tt = summary["strategies"][0]
assert tt["rmse_truth"]["position_m"] < 0.5, tt["rmse_truth"]
' "$work/a/summary.json" || fail "the summary of lane_change"

# The drive ends with the trace. Objects come and go.
expect 0 'position RMSE' "${drive[@]}" --truth "$work/queue.osi" --duration 60 --out "$work/q"
says '4 objects in 401 messages over 8 s'
expect 0 'truth.csv' export "$work/q" --format tables -o "$work/q_tables"
python3 -c '
import csv, sys
life = {}
for row in csv.DictReader(open(sys.argv[1])):
    at = float(row["time_s"])
    first, last = life.get(row["object"], (at, at))
    life[row["object"]] = (min(first, at), max(last, at))
assert len(life) == 4, life
assert life["2"][1] <= 6.02 < life["0"][1] and 3.0 <= life["3"][0] < 3.1, life
' "$work/q_tables/truth.csv" || fail "the lives of the queue"

# The log is an OSI trace, too, and that trace gives the same truth again.
expect 0 'wrote .*/q.mcap: [0-9]+ messages of SensorData and [0-9]+ of GroundTruth, beside the log' \
  export "$work/q/tt.mcap" --format osi -o "$work/q.mcap"
expect 0 '"ground_truths": [1-9]' export "$work/q/tt.mcap" --format osi -o "$work/q.mcap" --json
expect 0 'truth.csv' export "$work/q.mcap" --format tables -o "$work/again_tables"
[[ $output != *warning* ]] || fail "a log with a trace is read with a warning: $output"
cmp -s "$work/q_tables/truth.csv" "$work/again_tables/truth.csv" || fail "a log with a trace has another truth"
expect 0 'a trace of GroundTruth: 4 objects in .*, seen from vehicle 65535' "${drive[@]}" --truth "$work/q.mcap" --out "$work/r"
expect 0 '_sd_380_[0-9]+_[0-9]+_[a-z0-9_]+_tt.osi and 19700101T000000Z_gt_' \
  export "$work/q/tt.mcap" --format osi -o "$work/pair"
python3 "$(dirname "$0")/osi_reader.py" "$work/q.mcap" "$work/pair"
case $? in
  0) ;;
  77) echo "skipped: the trace as others read it: install Debian's python3-protobuf" ;;
  *) fail "another reader does not read the trace" ;;
esac
expect 0 'as its messages show: 4 objects' "${drive[@]}" --truth "$work"/pair/*_gt_*.osi --out "$work/r"
expect 2 'must be a trace of GroundTruth or SensorView, and is one of SensorData' \
  "${drive[@]}" --truth "$work"/pair/*_sd_*.osi --out "$work/r"
expect 2 'must end in .mcap, or name a folder' export "$work/q/tt.mcap" --format osi -o "$work/q.osi"

# From a vehicle.
expect 0 '1 object in 321 messages over 6.4 s, seen from vehicle 1' "${drive[@]}" --truth "$work/cut_in.osi" --out "$work/c" --duration 60
says '^warning: .*cut_in.osi: vehicle 1 moves, and .*paper_synchronised.yaml has no odometry'
expect 0 'beside the log' export "$work/c/tt.mcap" --format osi -o "$work/c.mcap"
expect 0 '1 object in .*, seen from vehicle 65535' "${drive[@]}" --truth "$work/c.mcap" --out "$work/r"
says '^warning: .*vehicle 65535 moves'

# Mistakes.
output=$(python3 "$source/examples/osi_traces.py" queue "$work/no/folder/queue.osi" 2>&1)
[[ $? -eq 2 && $output == "error: $work/no/folder/queue.osi: cannot be written: No such file or directory" ]] ||
  fail "a trace into no folder: $output"
expect 2 '--truth = .*queue.osi: is for `ttfusion run`, `launch` and `node`: an experiment draws the world of each' \
  experiment "$source/experiments/process_noise.yaml" --truth "$work/queue.osi"
expect 2 'must have a message, and is empty' "${drive[@]}" --truth /dev/null --out "$work/none"
head -c 3000 "$work/lane_change.osi" >"$work/cut.osi"
expect 2 'was cut off within message 15 at byte 2[0-9]*: a trace must be whole, and `head -c' \
  "${drive[@]}" --truth "$work/cut.osi" --out "$work/none"
at=$(sed -E 's/.*head -c ([0-9]+).*/\1/' <<<"$output")
head -c "$at" "$work/lane_change.osi" >"$work/short.osi"
expect 2 'short.osi: must be at least 1.5 s long, and has 0.26 s: .*paper_scenario2.yaml evaluates from there on' \
  "${drive[@]}" --truth "$work/short.osi" --out "$work/none"
expect 2 'this is a scenario, not an OSI trace; `ttfusion run` takes it' \
  "${drive[@]}" --truth "$source/scenarios/crowd_25.yaml" --out "$work/none"
expect 2 'must have a channel of osi3.GroundTruth or osi3.SensorView, and has channels of ttfusion' \
  "${drive[@]}" --truth "$work/q/tt.mcap" --out "$work/none"
expect 2 '--truth = .*: does not go with --input' "${drive[@]}" --truth "$work/queue.osi" --input "$work/queue.osi"
expect 2 'plays a recording, so --truth would be ignored' \
  run "$source/scenarios/laser_radar_recorded.yaml" --truth "$work/queue.osi" --out "$work/none"
expect 2 'No such file' "${drive[@]}" --truth "$work/nothing.osi" --out "$work/none"
[[ -e $work/none ]] && fail "a refused trace leaves a folder"

[[ $failures -eq 0 ]] && echo "traces: in and out as documented"
exit $((failures > 0))
