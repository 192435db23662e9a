#!/usr/bin/env bash
# `ttfusion diagram` and `export` of the logs of a run's processes: the same as of the run's one log.
#   merged_logs_test.sh PROGRAM SOURCE_DIR SPLIT_LOG
set -u
program=$1
source=$2
split_log=$3
source "$(dirname "$0")/expect.sh"

expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy tt --seed 3 --duration 1.6 --no-pictures --out "$work/a"
expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy adva --seed 3 --duration 1.6 --no-pictures --out "$work/a"
expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy tt --seed 4 --duration 1.6 --no-pictures --out "$work/c"
mkdir "$work/b" "$work/nodes"
cp "$work/a/tt.mcap" "$work/b/"
"$split_log" "$work/a/tt.mcap" 5 "$work/nodes" || fail "split_log fails"
expect 0 'are merged' diagram --help
expect 0 'are merged' export --help
for kind in timing startup position plane; do
  expect 0 '' diagram "$work/a/tt.mcap" --kind $kind --from 1.5 --to 1.6 -o "$work/of_one.svg"
  expect 0 '' diagram "$work"/nodes/node{3,0,4,2,1}.mcap --kind $kind --from 1.5 --to 1.6 -o "$work/of_many.svg"
  cmp -s "$work/of_one.svg" "$work/of_many.svg" ||
    fail "the $kind diagram of a run's five logs is not that of its one log"
done
for format in pcapng candump csv perfetto foxglove; do
  expect 0 '' export "$work/a/tt.mcap" --format $format -o "$work/of_one"
  expect 0 '' export "$work"/nodes/*.mcap --format $format -o "$work/of_many"
  cmp -s "$work/of_one" "$work/of_many" || fail "the $format export of a run's five logs is not that of its one log"
done
for part in a/tt.mcap nodes/; do
  expect 0 '' export "$work/$part"* --format tables -o "$work/tables_of_${part%%/*}"
done
diff -rq "$work/tables_of_a" "$work/tables_of_nodes" || fail "the tables of a run's five logs are not those of its one log"
# The log of a process that neither measures nor fuses gives an empty scene, and the command says so.
expect 1 'wrote .*; the log has no .*truth, observations, tracks, ages or errors' \
  export "$work/nodes/node2.mcap" --format foxglove -o "$work/empty_scene.mcap"
says '^error: .*node2.mcap: has nothing that a scene shows$'
expect 0 '' diagram "$work"/nodes/*.mcap "$work/a/adva.mcap" --kind plane -o "$work/of_many.svg"
expect 0 '' diagram "$work/a/tt.mcap" "$work/a/adva.mcap" --kind plane -o "$work/of_one.svg"
cmp -s "$work/of_one.svg" "$work/of_many.svg" || fail "two runs side by side differ by how many logs one of them has"
expect 2 'adva.mcap: cluster = paper_unsynchronised: must be paper_synchronised as in .*tt.mcap: only logs of one drive' \
  diagram "$work/a/tt.mcap" "$work/a/adva.mcap" -o "$work/none.svg"
expect 2 'c/tt.mcap: seed = 4: must be 3 as in .*a/tt.mcap' export "$work/a/tt.mcap" "$work/c/tt.mcap" --format csv \
  -o "$work/none"
expect 2 'b/tt.mcap: holds the same records as .*a/tt.mcap: give each log once' \
  diagram "$work/a/tt.mcap" "$work/b/tt.mcap" --kind plane -o "$work/none.svg"
expect 2 'holds the same records as' export "$work/a/tt.mcap" "$work/nodes/node2.mcap" --format csv -o "$work/none"
expect 2 'must be another file than the input' export "$work"/nodes/node{0,1}.mcap --format csv \
  -o "$work/nodes/node1.mcap"
printf 'damage' | dd of="$work/nodes/node1.mcap" bs=1 seek=$(($(stat -c %s "$work/nodes/node1.mcap") / 2)) conv=notrunc status=none
expect 0 'warning: .*node1.mcap: the chunk at byte' export "$work"/nodes/*.mcap --format csv -o "$work/of_many"
expect 0 '' export "$work/a/tt.mcap" --format csv -o "$work/of_one"
LC_ALL=C comm -13 <(LC_ALL=C sort "$work/of_one") <(LC_ALL=C sort "$work/of_many") >"$work/added"
[[ ! -s "$work/added" ]] || fail "a damaged log adds frames"
[[ $(wc -l <"$work/of_many") -lt $(wc -l <"$work/of_one") ]] || fail "a damaged chunk costs no frame"

[[ $failures -eq 0 ]] && echo "merged logs: all as documented"
exit $((failures > 0))
