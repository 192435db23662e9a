#!/usr/bin/env bash
# `ttfusion launch` with steps of libraries: the records of a single process, and nodes whose step hangs, crashes or ends its process.
#   launch_steps_test.sh PROGRAM SOURCE_DIR STEPS
set -u
program=$1
source=$2
steps=$3
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/launching.sh"
launch_options=(--virtual-time --steps "$steps" --step-limit 1)
ulimit -c 0

# ---- the example: the records of a single process
"$program" run "$source/examples/step/scenario.yaml" --strategy tt --steps "$steps" --no-pictures --out "$work/run" \
  >"$work/run.out" 2>&1 || fail "run: $(cat "$work/run.out")"
launch "$work/launch" "$source/examples/step/scenario.yaml" || fail "launch: $(cat "$work/launch.err")"
grep -q 'dashboard *| .*s: lamp on, nearest object' "$work/launch.err" || fail "the lamp is not told: $(cat "$work/launch.err")"
hash_of() {
  python3 -c 'import json, sys; print(json.load(open(sys.argv[1] + "/summary.json"))["strategies"][0]["content_hash"])' "$1"
}
[[ $(hash_of "$work/launch") == "$(hash_of "$work/run")" ]] || fail "launch leaves other records than run"

# ---- a process that is stopped during a call for longer than the limit goes on
gateway_of() {   # LIBRARY: a scenario whose gateway is the library's, in $work/LIBRARY.yaml
  sed "s/step: gateway/step: $1.so/" "$source/schedules/paper_synchronised.yaml" >"$work/$1.cluster.yaml"
  sed "s#\.\./schedules/paper_synchronised.yaml#$1.cluster.yaml#; s#\.\./schedules#$source/schedules#" \
    "$source/scenarios/paper_scenario1.yaml" >"$work/$1.yaml"
}
gateway_of spins
"$program" run "$work/spins.yaml" --strategy tt --steps "$steps" --step-limit 2 --no-pictures --out "$work/spins" 2>"$work/spins.err" >/dev/null &
spins=$!
for _ in $(seq 600); do grep -q 'it spins' "$work/spins.err" && break; sleep 0.02; done
kill -STOP "$spins" && sleep 3 && kill -CONT "$spins"
wait "$spins" || fail "a process that was stopped during a call: $(cat "$work/spins.err")"

# ---- the tenth execution hangs, crashes, or ends the process as if all were well: in virtual time the others go on alike, to the end
survivors="laser camera laser_pre camera_pre fusion feature"
for library in hangs crashes leaves; do
  gateway_of $library
  launch "$work/$library" "$work/$library.yaml" --policy gateway=optional ||
    fail "the survivors of a step that $library: $(cat "$work/$library.err")"
  for node in $survivors; do
    "$program" export "$work/$library/$node.mcap" --format csv -o "$work/$library.$node.csv" 2>/dev/null ||
      fail "$library: the log of $node cannot be read"
  done
  "$program" export "$work/$library/gateway.mcap" --format csv -o "$work/$library.gateway.csv" >/dev/null 2>&1 ||
    fail "$library: the dead node's log cannot be read"
done
grep -q 'gateway *| error: .*step = hangs.so: a call did not return within 1 s (--step-limit)' "$work/hangs.err" ||
  fail "a hang is not told: $(cat "$work/hangs.err")"
grep -q '^warning: gateway was not in operation at the end: exit 1$' "$work/hangs.err" || fail "the hanging node is not told"
grep -q 'gateway *| error: .*step = crashes.so: a call crashed' "$work/crashes.err" || fail "a crash is not told"
grep -q '^warning: gateway was not in operation at the end: signal 11 (Segmentation fault)$' "$work/crashes.err" ||
  fail "the crashed node is not told"
died='exit 0 without its result'
grep -q "^warning: gateway was not in operation at the end: $died$" "$work/leaves.err" ||
  fail "a node that ended its process is not told: $(cat "$work/leaves.err")"
grep -Eq "^gateway +$died +0 " "$work/leaves.err" || fail "the table shows another end: $(cat "$work/leaves.err")"
python3 - "$work/leaves" "$died" <<'EOF' || fail "the files of the launch tell another end"
import json, sys
manifest, summary = (json.load(open(f"{sys.argv[1]}/{name}.json")) for name in ("manifest", "summary"))
gateway = next(node for node in manifest["nodes"] if node["name"] == "gateway")
assert [(p["exit"], p["why"]) for p in gateway["processes"]] == [(0, sys.argv[2])], gateway
assert summary["not_in_operation_at_end"] == [{"node": "gateway", "state": sys.argv[2]}], summary["not_in_operation_at_end"]
EOF
for node in $survivors; do
  for library in crashes leaves; do
    [[ -s $work/hangs.$node.csv ]] && cmp "$work/hangs.$node.csv" "$work/$library.$node.csv" ||
      fail "$node: steps that hang and $library at the same execution leave other records"
  done
done
# A required node takes the launch along.
for library in hangs leaves; do
  launch "$work/required" "$work/$library.yaml"
  [[ $? -eq 1 ]] || fail "a launch whose required node's step $library does not exit with 1"
done

# ---- in real time nothing happens to the others
launch_options=(--steps "$steps" --step-limit 1 --no-topics)
launch "$work/live" "$work/hangs.yaml" --policy gateway=optional --time-scale 4 --duration 1.5 ||
  fail "the others of a node that hangs in real time: $(cat "$work/live.err")"
grep -q 'gateway *| error: .*a call did not return within 1 s' "$work/live.err" || fail "a hang in real time is not told"
for node in $survivors; do
  grep -q "$node: exit [1-9]" "$work/live.err" && fail "$node ends with the node that hangs"
done
launch "$work/gone" "$work/leaves.yaml" --policy gateway=optional --time-scale 4 --duration 1.5 ||
  fail "the others of a node that ends its process in real time: $(cat "$work/gone.err")"
grep -q "not in operation at the end: .*$died" "$work/gone.err" || fail "an end in real time is not told: $(cat "$work/gone.err")"
grep -q '^verdict: .*gateway' "$work/gone.out" || fail "the verdict leaves the node out: $(cat "$work/gone.out")"

[[ $failures -eq 0 ]] && echo "launches with steps of libraries: hangs and crashes end their node alone"
exit $((failures > 0))
