#!/usr/bin/env bash
# `ttfusion keys`: the keys of the input files, as text, schemas and pages.
#   keys_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

# Kinds with few keys show what is printed. Documents.* (test_keys) compares the pages and schemas of all kinds.
expect 0 'Examples: ttfusion keys cluster' keys --help
expect 0 '^tracker.initial_acceleration_sigma: number 0.01..100 m/s\^2, default 2$' keys track
expect 0 '^flexray.gdStaticSlot: whole number 4..661 macroticks, optional' keys cluster
expect 0 '^strategies\[\].rmse_truth.position_m: number or null, root mean square' keys summary
expect 2 '^error: command line: kind = voyage: must be one of scenario, cluster, plan, experiment, track, faults, summary$' keys voyage
expect 2 '^error: command line: --format = json-schema: goes with one kind' keys --format json-schema
expect 0 '^wrote .*/faults.json$' keys faults --format json-schema -o "$work/faults.json"
cmp -s "$work/faults.json" "$source/keys/schemas/faults.schema.json" || fail "keys writes another schema than the one kept"
for kind in faults summary; do
  expect 0 '^wrote .*/keys$' keys $kind --format markdown -o "$work/keys"
done
expect 0 '^wrote .*/summary.json$' keys summary --format json-schema -o "$work/summary.json"
cmp "$work/summary.json" "$source/keys/schemas/summary.schema.json" || fail "keys writes another schema of summary.json than the one kept"
for page in faults summary summary_faults; do
  cmp "$work/keys/$page.md" "$source/docs/keys/$page.md" || fail "keys --format markdown writes another page $page.md than the one kept"
done

[[ $failures -eq 0 ]] && echo "keys command: all as documented"
exit $((failures > 0))
