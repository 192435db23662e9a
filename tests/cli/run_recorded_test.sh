#!/usr/bin/env bash
# `ttfusion run --input`: recorded observations, and mistakes in them.
#   run_recorded_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

printf 'L\t1.0\t0.1\t1000000\t1.0\t0.1\t5.0\t0.0\t0.0\t0.0\n' >"$work/short.txt"
expect 2 'paper_scenario1.yaml: clusters = .*: takes no recording, so --input would be ignored' \
  run "$source/scenarios/paper_scenario1.yaml" --input "$work/short.txt" --out "$work/none"
[[ -e $work/none/buff.mcap ]] && fail "a refused recording leaves a log"
# A car at 5 m/s, seen in turn: rows 50 ms and SECOND us apart, COUNT of them.
rows() {
  awk -v second="$1" -v count="$2" 'BEGIN {
    at = 0
    for (i = 0; i < count; ++i) {
      x = 10 + 5e-6 * at
      truth = sprintf("%d\t%.4f\t0\t5\t0\t0\t0", at, x)
      printf i % 2 ? "R\t%.4f\t0\t5\t%s\n" : "L\t%.4f\t0\t%s\n", x, truth
      at += i % 2 ? second : 50000
    }
  }'
}
recorded=(run "$source/scenarios/laser_radar_recorded.yaml" --strategy adva --no-pictures)
rows 55000 100 >"$work/off.txt"
expect 2 'off.txt:3: t_us = 105000: must be within 1 ms of an instant at which .*laser_radar.yaml has laser measure: every 100 ms' \
  "${recorded[@]}" --input "$work/off.txt" --out "$work/none"
[[ -e $work/none/adva.mcap ]] && fail "a recording off the schedule leaves a log"
rows 50000 100 >"$work/five_seconds.txt"
expect 0 'laser: 50 rows, 50 lists played' "${recorded[@]}" --input "$work/five_seconds.txt" --out "$work/r"
says 'the recording ended at 4.95 s of 25 s'
expect 0 "wrote .*; the log has no sensors' fields$" export "$work/r/adva.mcap" --format foxglove -o "$work/r_scene.mcap"
expect 0 '"ends_early": true' "${recorded[@]}" --input "$work/five_seconds.txt" --out "$work/r" --json
# Most of a recording was left over, or no track came of it: the reason, exit code 1, and the log all the same.
rows 50000 1200 >"$work/a_minute.txt"
expect 1 '^error: .*a_minute.txt: with adva: 699 of 1200 rows are beyond the drive.s end at 25 s$' \
  "${recorded[@]}" --input "$work/a_minute.txt" --out "$work/minute"
[[ -s $work/minute/adva.mcap ]] || fail "a drive that left most rows over writes no log"
rows 50000 1000 >"$work/half_unused.txt"
expect 0 '250 unused rows beyond' "${recorded[@]}" --input "$work/half_unused.txt" --out "$work/minute"
rows 1950000 20 >"$work/every_two_seconds.txt"
expect 1 '^error: .*two_seconds.txt: with adva: no track came of 20 lists played within 18.05 s, 20 of them fused: a track needs 3 hits in 5 lists' \
  "${recorded[@]}" --input "$work/every_two_seconds.txt" --out "$work/sparse"
python3 -c '
import json, sys
r = json.load(open(sys.argv[1]))["strategies"][0]["recording"]
assert r["made_track"] is False and len(r["reasons"]) == 1, r
' "$work/sparse/summary.json" || fail "summary.json does not say that no track came"
[[ -s $work/sparse/adva.mcap ]] || fail "a drive without a track writes no log"
recording=${TTF_RECORDINGS:-$source/../shared/data}/laser_radar/measurements.txt
if [[ -r $recording ]]; then
  expect 0 'position RMSE' run "$source/scenarios/laser_radar_recorded.yaml" --input "$recording" --out "$work/r" \
    --no-pictures
  sed '7s/[0-9]/x/' "$recording" >"$work/broken.txt"
  expect 2 'broken.txt:7' run "$source/scenarios/laser_radar_recorded.yaml" --input "$work/broken.txt" --out "$work/r"
else
  echo "recorded input: skipped, there is no recording $recording;" \
    "set TTF_RECORDINGS to the folder that holds laser_radar/measurements.txt"
fi
expect 2 '--input' run "$source/scenarios/laser_radar_recorded.yaml" --out "$work/r"

[[ $failures -eq 0 ]] && echo "run recorded: all as documented"
exit $((failures > 0))
