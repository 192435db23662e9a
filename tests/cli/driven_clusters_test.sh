#!/usr/bin/env bash
# The clusters that experiments drive are those that `ttfusion schedule synthesize` makes of the plans.
#   driven_clusters_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
plans=$source/schedules/plans

# drives EXPERIMENT AXIS=VALUE CLUSTER [PARADIGM]: the paradigm drives the cluster that synthesis made.
drives() {
  python3 "$(dirname "$0")/driven_cluster.py" "$program" "$source/experiments/$1.yaml" "${4:-planned}" "$2" "$3" ||
    fail "$1 drives another cluster at $2"
}
# bounds CASE PLAN POINTS LASER_LOAD CAMERA_LOAD: with these scans and this traffic, the plan gives the case's cluster.
bounds() {
  cat >"$work/case.yaml" <<YAML
extends: $plans/$2.yaml
name: $1
pdus: {laser_scan: {max_elements: $3}}
can: {laser_can: {other_load: $4}, camera_can: {other_load: $5}}
YAML
  expect 0 'wrote' schedule synthesize "$work/case.yaml" -o "$work/case_planned.yaml"
  drives planned_bounds "case=$1" "$work/case_planned.yaml"
}
for bound in narrow paper wide; do
  plan=paper_$bound
  [[ $bound = paper ]] && plan=paper
  bounds ${bound}_long $plan 1300 0 0
  bounds ${bound}_long_load $plan 1300 0.04 0.1
  bounds ${bound}_short $plan 140 0 0
  bounds ${bound}_short_load $plan 140 0.4 0.1
done
for plan in held held_sixty; do
  for bound in 34 44; do
    name=paper_$plan
    [[ $bound = 44 ]] && name=paper_wide_$plan
    expect 0 'wrote' schedule synthesize "$plans/$name.yaml" -o "$work/held.yaml"
    drives planned_periods "bound=$bound" "$work/held.yaml" $plan
  done
done
expect 0 '^laser +65.174 +65.582 ' schedule synthesize "$plans/closed_loop_wide.yaml" -o "$work/loop_wide.yaml"
drives closed_loop_planned condition=wide "$work/loop_wide.yaml"
drives closed_loop_planned_following condition=wide_025 "$work/loop_wide.yaml"
drives closed_loop_planned_following condition=wide_4 "$work/loop_wide.yaml"

[[ $failures -eq 0 ]] && echo "driven clusters: all as synthesized"
exit $((failures > 0))
