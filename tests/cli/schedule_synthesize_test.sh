#!/usr/bin/env bash
# `ttfusion schedule synthesize PLAN.yaml`: the shipped plans become clusters that pass the check and drive, a plan without
# solution is explained, and one sentence for each mistake.
#   schedule_synthesize_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
plans=$source/schedules/plans

expect 0 '^data_age .* proven best: all orders tried$' schedule synthesize "$plans/paper.yaml" -o "$work/paper.yaml"
says '^worst_age .* proven best: all orders tried$'
expect 0 '^paper_planned: consistent$' schedule check "$work/paper.yaml"
expect 0 '^front_radar ' schedule synthesize "$plans/paper_two_lasers_radar.yaml" -o "$work/four.yaml"
says '^data_age .* proven best: all orders tried$'
says '^worst_age .* proven best: all orders tried$'
expect 0 '^paper_two_lasers_radar: consistent$' schedule check "$work/four.yaml"
expect 0 '^error +1\.00000 .* at most 0\.0[0-9]+ % off$' schedule synthesize "$plans/paper_least_error.yaml" -o "$work/least.yaml"
says '^  with noise 25 +0\.0099[0-9]+ m2 +1\.00000 times the least, 0 m2 more$'
expect 0 '^paper_least_error: consistent$' schedule check "$work/least.yaml"
# No schedule is the best for both noises.
sed -e "s#extends: .*#extends: $plans/paper.yaml#" -e 's/process_noises: .*/process_noises: [0.01, 10000]/' \
  -e 's/camera: 0.15/camera: 0.4/' "$plans/paper_least_error.yaml" >"$work/two_noises.yaml"
expect 0 '^error +1\.0065[0-9] ' schedule synthesize "$work/two_noises.yaml"
says '^  with noise 0\.01 +0\.00060[0-9] m2 +1\.0065[0-9] times the least, 4e-06 m2 more$'
says '^  with noise 10000 +0\.731[0-9] m2 +1\.0009[0-9] times the least, 0\.000[67][0-9]* m2 more$'
sed 's/objective: .*/objective: [gap_error]/' "$plans/paper.yaml" >"$work/gap.yaml"
expect 0 '^gap_error +0\.1884 m2 +0\.1884 m2  best, if the error grows with the age$' schedule synthesize "$work/gap.yaml"
# With so long a delay of commands no loop is stable.
sed 's/objective: .*/objective: [gap_error]\n  gap_error: {delay: 1 s}/' "$plans/paper.yaml" >"$work/unstable.yaml"
expect 0 '^gap_error +unbounded +unbounded  the loop was stable at no instants$' schedule synthesize "$work/unstable.yaml"
sed 's/objective: .*/objective: [error]/' "$plans/paper.yaml" >"$work/no_error.yaml"
expect 2 'plan.error: must have process_noise and sigma' schedule synthesize "$work/no_error.yaml"
# The plans give the shipped clusters, which experiments drive.
diff "$work/paper.yaml" "$source/schedules/paper_planned.yaml" || fail "schedules/paper_planned.yaml is another one"
expect 0 '^laser +55.184 +55.532 ' schedule synthesize "$plans/closed_loop.yaml" -o "$work/loop.yaml"
diff "$work/loop.yaml" "$source/schedules/closed_loop_planned.yaml" ||
  fail "schedules/closed_loop_planned.yaml is another one"
# A task that reads the image and odometry uses the image; it does not fuse odometry.
says '^seen_by_laser +55.094 +55.442 '
expect 0 ' used first +55.094 +55.442$' schedule check "$work/loop.yaml"
# short_scans PLAN EXPERIMENT...: the plan's sensors measure at the instants that the experiments have.
short_scans() {
  local experiment sensor key value
  expect 0 'wrote' schedule synthesize "$plans/$1.yaml" -o "$work/short.yaml"
  for experiment in "${@:2}"; do
    for sensor in laser camera; do
      for key in base_cycle offset; do
        value=$(sed -n "s/.*kind: $sensor,.*$key: \([0-9]*\).*/\1/p" "$work/short.yaml")
        grep -q "planned/cluster.sensors.$sensor.$key: $value\$" "$source/experiments/$experiment.yaml" ||
          fail "with short scans, $experiment has another $key of $sensor than $value"
      done
    done
  done
}
short_scans paper_short_scans planned_schedule
says '^worst_age +40.874 ms .* proven best'
short_scans closed_loop_short_scans closed_loop_planned closed_loop_planned_following
for cluster in paper four least; do
  sed "s#tt: .*#tt: $work/$cluster.yaml#; s#\\.\\./schedules#$source/schedules#" "$source/scenarios/paper_scenario1.yaml" \
    >"$work/drive.yaml"
  expect 0 'deadlines missed +0$' run "$work/drive.yaml" --strategy tt --no-log --out "$work/out"
  says 'arrived out of sequence +0$'
done

# The price of a smaller age, and the pieces that bind it.
expect 0 '^ +camera_frame on camera_can +5.412 +-1.000 +0.000 +0.000$' schedule synthesize "$plans/paper.yaml" --binding \
  --trade-off "$work/trade_off.svg"
says '^      rests: lists are fused in the order of their measurements +16.497$'
cmp "$work/trade_off.svg" "$source/docs/pictures/trade_off.svg" ||
  fail "docs/pictures/trade_off.svg is another one: schedule synthesize schedules/plans/paper.yaml --trade-off FILE"
expect 0 'wrote' schedule synthesize "$plans/paper_least_error.yaml" --trade-off "$work/trade_off.csv"
grep -q '^front,8.835,4,4,54.916,54.916,80,proven,' "$work/trade_off.csv" || fail "the front has another least age"
[[ $(grep -c '^candidate,.*,1\.0[0-9]*$' "$work/trade_off.csv") -eq 94 ]] || fail "the lengths with a schedule have no error"
expect 2 '^error: command line: --trade-off = .*: must end in \.svg, \.png, \.pdf or \.csv$' schedule synthesize "$plans/paper.yaml" --trade-off "$work/trade_off.txt"
# A round of sixty cycles, and a free payload.
expect 0 '^paper_sixty_cycles: a cycle of 6.83 ms, chosen' schedule synthesize "$plans/paper_sixty_cycles.yaml" -o "$work/sixty.yaml"
expect 0 '^paper_sixty_cycles: consistent$' schedule check "$work/sixty.yaml"
expect 0 'a payload of 106 bytes, chosen among 1274 cycles, payloads and rates$' \
  schedule synthesize "$plans/paper_payload.yaml" -o "$work/payload.yaml"
expect 0 '^paper_payload: consistent$' schedule check "$work/payload.yaml"
expect 0 '^slots ' schedule synthesize "$plans/paper_laser.yaml"

# A plan without solution.
sed '/ laser: {from/s/60 ms/50 ms/' "$plans/paper.yaml" >"$work/tight.yaml"
expect 1 'cannot hold together: .*tight.yaml:[0-9]+: plan.chains.laser.largest_age: 50 ms$' \
  schedule synthesize "$work/tight.yaml" -o "$work/none.yaml"
says 'one of these changes alone is enough: .*largest_age: 54\.[0-9]+ ms$'
[[ ! -e $work/none.yaml ]] || fail "a plan without solution leaves a file"
"$program" schedule synthesize "$work/tight.yaml" --json >"$work/why.json" 2>/dev/null && fail "no solution exits with 0"
"$program" schedule synthesize "$plans/paper.yaml" --json >"$work/found.json" || fail "a result as JSON fails"
python3 - "$work/why.json" "$work/found.json" <<'PY' || fail "a result is no JSON"
import json, sys
why, found = (json.load(open(path)) for path in sys.argv[1:])
assert not why["found"] and why["proven"] and why["cannot_hold_together"] and why["one_change_is_enough"], why
assert found["found"] and all(one["proven"] for one in found["objective"]), found
assert [chain["name"] for chain in found["chains"]] == ["laser", "camera"], found
PY

# Mistakes.
expect 2 'is neither a file nor the name of a shipped plan' schedule synthesize papyrus
expect 2 'plan: is missing' schedule synthesize "$source/schedules/paper_fitted.yaml"
sed 's/from: laser, to/from: lidar, to/' "$plans/paper.yaml" >"$work/lidar.yaml"
expect 2 'lidar.yaml:[0-9]+: plan.chains.laser.from = lidar: is not the name of a sensor' schedule synthesize "$work/lidar.yaml"
expect 2 '' schedule synthesize "$work/paper.yaml" -o "$work/paper.yaml"

[[ $failures -eq 0 ]] && echo "schedule synthesize: all as documented"
exit $((failures > 0))
