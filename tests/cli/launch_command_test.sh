#!/usr/bin/env bash
# `ttfusion launch` and `ttfusion node` as a user meets them: plans, exit codes, and one clear sentence for bad input.
#   launch_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
drive=$source/scenarios/paper_scenario1.yaml
cluster=$source/schedules/paper_synchronised.yaml

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect CODE PATTERN ARGS...: exit code, and a pattern in what is printed on either stream.
expect() {
  local code=$1 pattern=$2 output actual
  shift 2
  output=$("$program" "$@" 2>&1)
  actual=$?
  [[ $actual -eq $code ]] || fail "$* exits with $actual, not $code: $output"
  grep -Eq -- "$pattern" <<<"$output" || fail "$* does not say '$pattern': $output"
}

expect 0 'Example: ttfusion launch' launch --help
expect 0 'Example: ttfusion node' node --help
expect 2 'required' launch
expect 2 'required' node fusion
expect 2 'absent.yaml: cannot be read' launch "$work/absent.yaml"

# Bad options, each in one sentence.
for command in launch "node fusion"; do
  # shellcheck disable=SC2086
  {
    expect 2 'strategy' $command "$drive" --strategy best
    expect 2 '--seed = 1x: must be a whole number 0..4611686018427387904' $command "$drive" --seed 1x
    expect 2 '--bus = can: must be dds, or socketcan: with one or two different interfaces' $command "$drive" --bus can
    expect 2 '--bus = socketcan:vcan0,vcan0: must be dds, or' $command "$drive" --bus socketcan:vcan0,vcan0
    expect 2 '--bus = socketcan:vcan0: must be dds with --virtual-time' $command "$drive" --bus socketcan:vcan0 --virtual-time
    for scale in 0 0.09 1000.1 -1 nan 1e2; do
      expect 2 "--time-scale = $scale: must be a decimal number 0.1..1000" $command "$drive" "--time-scale=$scale"
    done
    expect 2 '--time-scale = 2: must not be given with --virtual-time' $command "$drive" --time-scale 2 --virtual-time
    for duration in 0.09 3600.1 x; do
      expect 2 "--duration = $duration: must be a decimal number 0.1..3600 s" $command "$drive" --duration "$duration"
    done
    expect 2 '--duration = 1.4: must be at least 1.5 s: from there on .*paper_scenario1.yaml is evaluated' $command "$drive" --duration 1.4
    expect 2 'a recording is played by `ttfusion run --input`' $command "$source/scenarios/laser_radar_recorded.yaml"
  }
done
expect 2 'NAME = fusoin: must be a node of .*paper_synchronised.yaml: .*laser_pre, .*fusion' node fusoin "$drive" --virtual-time
expect 2 '--policy = fusion: must be NODE=required, NODE=restart or NODE=optional' launch "$drive" --policy fusion
expect 2 '--policy = fusion=never: must be NODE=' launch "$drive" --policy fusion=never
expect 2 'NAME = fusoin: must be a node of' launch "$drive" --policy fusoin=optional
expect 2 'must be given once for each node' launch "$drive" --policy fusion=optional --policy fusion=restart
sed 's/gdNIT: 386/gdNIT: 380/' "$cluster" >"$work/broken.yaml"
expect 2 'broken.yaml:[0-9]+: .*(gdNIT|gMacroPerCycle)' launch "$work/broken.yaml" --dry-run
sed "s#\.\./schedules#$source/schedules#; 0,/node: camera_pre/s//node: camera_per/" "$source/scenarios/faulty_bus.yaml" >"$work/typo.yaml"
expect 2 'camera_per: must be a node' launch "$work/typo.yaml" --dry-run

# What cannot run yet says so, and starts nothing.
expect 2 'launch needs --virtual-time' launch "$drive" --out "$work/real"
expect 2 'node needs --virtual-time' node fusion "$drive" --out "$work/real"
[[ -e $work/real ]] && fail "a launch that cannot be leaves a folder"

expect 2 '--policy = fusion=restart: must not be given with --virtual-time' \
  launch "$drive" --virtual-time --policy fusion=restart --out "$work/real"
[[ -e $work/real ]] && fail "a launch that is refused leaves a folder"

# The dry run: one command per node on standard output, words on the other; each command is taken as it stands.
"$program" launch "$drive" --virtual-time --seed 5 --duration 2.50 --out "$work/it's dry" --dry-run >"$work/commands" 2>"$work/words" ||
  fail "the dry run fails"
[[ -e "$work/it's dry" ]] && fail "the dry run leaves a folder"
grep -q 'paper_synchronised.yaml is consistent' "$work/words" || fail "the dry run does not say that the schedule is consistent"
nodes=$(sed -n '/^nodes:/,/^[a-z_]*:$/p' "$cluster" | grep -c '^  [a-z_]*:')
[[ $(wc -l <"$work/commands") -eq $nodes ]] || fail "$(wc -l <"$work/commands") commands for $nodes nodes"
grep -Eq -- " node fusion .*paper_scenario1.yaml --strategy tt --seed 5 --bus dds --session [^ ]* --duration 2.5 --virtual-time --out '" "$work/commands" ||
  fail "the dry run's commands are others: $(cat "$work/commands")"
while IFS= read -r line; do
  bash -c "$line --dry" >/dev/null 2>"$work/refused"
  grep -q 'not expected: --dry' "$work/refused" || fail "a shell does not take: $line"
done <"$work/commands"
"$program" launch "$drive" --strategy buff --time-scale 2.50 --bus socketcan:vcan_absent --policy fusion=restart --dry-run --json \
  >"$work/plan.json" || fail "the dry run's JSON fails"
python3 - "$work/plan.json" <<'PY' || fail "the dry run's JSON is another"
import json, sys
plan = json.load(open(sys.argv[1]))
assert plan["strategy"] == "buff" and plan["cluster"]["name"] == "paper_unsynchronised" and plan["time_scale"] == 2.5, plan
assert plan["virtual_time"] is False and plan["bus"] == "socketcan:vcan_absent" and plan["duration_s"] == 3.0, plan
absent = plan["preflight"][-1]
assert absent["good"] is False and "ip link add dev vcan_absent type vcan" in absent["commands"], absent
by_name = {node["name"]: node for node in plan["nodes"]}
assert by_name["fusion"]["policy"] == "restart" and by_name["laser_pre"]["policy"] == "required", plan
command = by_name["laser_pre"]["command"]
assert command[1:3] == ["node", "laser_pre"] and command[-4:-2] == ["--time-scale", "2.5"], command
PY

# A cluster file takes the default scene.
expect 0 'node fusion .*paper_unsynchronised.yaml --strategy adva' \
  launch "$source/schedules/paper_unsynchronised.yaml" --strategy adva --virtual-time --dry-run
expect 0 '"name": "paper_unsynchronised"' launch "$source/schedules/paper_unsynchronised.yaml" --dry-run --json

[[ $failures -eq 0 ]] && echo "launch: all as documented"
exit $((failures > 0))
