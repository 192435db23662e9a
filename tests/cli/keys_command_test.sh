#!/usr/bin/env bash
# `ttfusion keys`: the keys of the input files, as text, schemas and pages.
#   keys_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

expect 0 'Examples: ttfusion keys scenario' keys --help
expect 0 '^world.objects\[\].speed: number 0..100 m/s, default 0$' keys scenario
expect 0 '^flexray.gdStaticSlot: whole number 4..661 macroticks, optional' keys cluster
expect 0 '^strategies\[\].rmse_truth.position_m: number or null, root mean square' keys summary
expect 2 '^error: command line: kind = voyage: must be one of scenario, cluster, plan, experiment, track, faults, summary$' keys voyage
expect 2 '^error: command line: --format = json-schema: goes with one kind' keys --format json-schema
expect 0 '^wrote .*/faults.json$' keys faults --format json-schema -o "$work/faults.json"
cmp -s "$work/faults.json" "$source/keys/schemas/faults.schema.json" || fail "keys writes another schema than the one kept"
expect 0 '^wrote .*/keys$' keys --format markdown -o "$work/keys"
[[ -s $work/keys/scenario_sensors_NAME.md ]] || fail "keys --format markdown writes no page of the sensors"

[[ $failures -eq 0 ]] && echo "keys command: all as documented"
exit $((failures > 0))
