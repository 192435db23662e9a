#!/usr/bin/env bash
# `ttfusion launch` and `ttfusion node` as a user meets them: plans, exit codes, and one clear sentence for
# bad input.
#   launch_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
drive=$source/scenarios/paper_scenario1.yaml
cluster=$source/schedules/paper_synchronised.yaml

expect 0 'Example: ttfusion launch' launch --help
expect 0 'Examples: ttfusion node' node --help
expect 2 'scenario: must be given to `ttfusion launch`' launch
expect 2 'scenario: must be given to `ttfusion node`' node fusion
expect 2 'absent.yaml: cannot be read' launch "$work/absent.yaml"

# Bad options, each in one sentence.
for command in launch "node fusion"; do
  # shellcheck disable=SC2086
  {
    expect 2 'strategy' $command "$drive" --strategy best
    expect 2 '--seed = 1x: must be a whole number 0..4611686018427387904' $command "$drive" --seed 1x
    expect 2 '--bus = can: must be dds, or socketcan: with one or two different interfaces' $command "$drive" --bus can
    expect 2 '--bus = socketcan:vcan0,vcan0: must be dds, or' $command "$drive" --bus socketcan:vcan0,vcan0
    expect 2 '--bus = socketcan:vcan0: must be dds with --virtual-time' $command "$drive" --bus socketcan:vcan0 \
      --virtual-time
    for scale in 0 0.09 1000.1 -1 nan 1e2; do
      expect 2 "--time-scale = $scale: must be a decimal number 0.1..1000" $command "$drive" "--time-scale=$scale"
    done
    expect 2 '--time-scale = 2: must not be given with --virtual-time' $command "$drive" --time-scale 2 --virtual-time
    for duration in 0.09 1.4 3600.1 x; do
      expect 2 "--duration = $duration: must be a decimal number 1.5..3600 s \(.*paper_scenario1.yaml is evaluated from 1.5 s on\)" \
        $command "$drive" --duration "$duration"
    done
    expect 2 '--duration = 0: must not be 0 with --virtual-time' $command "$drive" --duration 0 --virtual-time
    expect 2 '--duration = 1: must be a decimal number 1.5..3600 s \(the default scene is evaluated from' $command \
      "$cluster" --duration 1
    expect 2 '--bus = socketcan:sixteen_letters_: must be dds, or .* \(each 1..15 characters' $command "$drive" \
      --bus socketcan:sixteen_letters_
    expect 2 '--session: must be 1 to 64 letters' $command "$drive" --session ''
    expect 2 '--session = a b: must be 1 to 64 letters' $command "$drive" --session 'a b'
    expect 2 '--out: must not be empty' $command "$drive" --out ''
    pushd "$work" >/dev/null   # where it would be, were it taken for a folder
    expect 2 "--out = --virtual-time: must not .* begin with a '-'" $command "$drive" --out= --virtual-time
    popd >/dev/null
    expect 2 '--can = laser_can=can2: goes with --bus socketcan' $command "$drive" --can laser_can=can2
    can="$command $drive --bus socketcan:vcan0,vcan1 --can"
    for option in laser_can laser_can= =can2 laser_can=a/b laser_can=sixteen_letters_; do
      expect 2 "--can = $option: must (be NAME=IF, a CAN of|name a CAN of) .*paper_synchronised.yaml" $can "$option"
    done
    expect 2 '--can = lidar_can=can2: must name a CAN of .*: laser_can, camera_can, observation_can' $can lidar_can=can2
    expect 2 '--can = laser_can=can3: must be given once for each CAN' $can laser_can=can2 --can laser_can=can3
    expect 2 '--can = laser_can=vcan1: must differ from the interface of channel B' $can laser_can=vcan1
    expect 2 '--can = camera_can=laser_can: must differ from the interface of laser_can' $can camera_can=laser_can
    expect 2 'recordings are for `ttfusion run --input`' $command "$source/scenarios/laser_radar_recorded.yaml"
  }
done
for strategy in buff adva tt; do
  expect 0 'node right_laser' launch "$source/scenarios/two_lasers.yaml" --strategy $strategy --dry-run
done
expect 0 'node fusion .* --duration 3600 ' launch "$drive" --duration 0 --dry-run
# In real time: the cluster's requirements at the time scale; no faults.
edited() \
  { sed "$1" "$cluster" >"$work/edited.yaml"; cmp -s "$cluster" "$work/edited.yaml" && fail "'$1' changes nothing"; }
expect 2 'flexray_demo.yaml:[0-9]+: topology = star: must be bus in real time' launch \
  "$source/schedules/flexray_demo.yaml" --dry-run
expect 0 'node fusion' launch "$source/schedules/flexray_demo.yaml" --virtual-time --dry-run
edited '/^real_time:/d'
expect 2 'edited.yaml:[0-9]+: real_time: is missing: .* for virtual time only' launch "$work/edited.yaml" --dry-run
expect 0 'node fusion' launch "$work/edited.yaml" --virtual-time --dry-run
edited 's/late: 500 us/late: 2 ms/'
expect 2 'edited.yaml:10: real_time.late = 2000 us: must be at most 581 us at time scale 1: .*; --time-scale 3.442341 or more' \
  node fusion "$work/edited.yaml"
expect 2 'must be at most 1999.999 us at time scale 3.44234:' \
  node fusion "$work/edited.yaml" --time-scale 3.44234
expect 0 'node fusion .* --time-scale 3.442341 ' launch "$work/edited.yaml" --time-scale 3.442341 --dry-run
edited 's/observation_can/observation_can_/g'
expect 2 'edited.yaml:[0-9]+: can.observation_can_: needs --can NAME=IF on SocketCAN' launch "$work/edited.yaml" \
  --bus socketcan:vcan0 --dry-run
expect 1 'can observation_can_=vcan_absent' launch "$work/edited.yaml" --bus socketcan:vcan0 \
  --can observation_can_=vcan_absent --dry-run
edited '0,/slot: 6, channels: AB/s//slot: 6, channels: B/'
expect 2 \
  '--bus = socketcan:vcan0: must name an interface for channel B, too: slot 6 of .*edited.yaml is sent on B alone' \
  launch "$work/edited.yaml" --bus socketcan:vcan0 --dry-run
expect 1 'node fusion' launch "$work/edited.yaml" --bus socketcan:vcan0,vcan_absent --dry-run
expect 2 'faulty_bus.yaml:[0-9]+: faults: need --virtual-time' launch "$source/scenarios/faulty_bus.yaml" \
  --dry-run
expect 0 'node fusion' launch "$source/scenarios/faulty_bus.yaml" --virtual-time --dry-run

# A node without a supervisor.
expect 2 '--start-at = 1: must not be given with --virtual-time' node fusion "$drive" --start-at 1 --virtual-time
expect 2 '--rejoin: must not be given with --virtual-time' node fusion "$drive" --rejoin --virtual-time
expect 2 '--host = a: must not be given with --virtual-time' node fusion "$drive" --host a --virtual-time
expect 2 '--host = two words: must be 1..255 printable ASCII characters without blanks' node fusion "$drive" \
  --host 'two words'
expect 2 '--host: must have a value' node fusion "$drive" "--host="
expect 2 '--host: is no option of `ttfusion launch`' launch "$drive" --host a
for start in -1 1e9 4102444801 now 0.0000000001; do
  expect 2 "--start-at = $start: must be a decimal number 0..4102444800 s" node fusion "$drive" "--start-at=$start"
done
for rejoin in '' --rejoin; do
  # shellcheck disable=SC2086
  expect 2 'command line: --start-at: must be given to a node without a supervisor' \
    node fusion "$drive" $rejoin --out "$work/by_hand"
done
expect 2 '--start-at = 1: must be in the future' node fusion "$drive" --start-at 1 --no-topics --session "refused-$$" \
  --out "$work/by_hand"
[[ $(ls "$work/by_hand" 2>/dev/null) == '' ]] || fail "a node that is refused leaves a log"
expect 2 '--rejoin: is no option of `ttfusion launch`' launch "$drive" --rejoin
expect 2 '--start-at: is no option of `ttfusion launch`' launch "$drive" --start-at 1

# The requirements of ROS 2's topics are checked before anything starts.
for domain in 232 -1 0.5 one; do
  export ROS_DOMAIN_ID=$domain
  expect 2 "environment: ROS_DOMAIN_ID = $domain: must be a whole number 0..231" launch "$drive" --out "$work/real"
  [[ -e $work/real ]] && fail "a launch that is refused leaves a folder"
  expect 2 "environment: ROS_DOMAIN_ID = $domain: must be" node fusion "$drive" --start-at 4000000000 --out "$work/real"
  [[ -e $work/real ]] && fail "a node that is refused leaves a folder"
  expect 0 'node fusion .*--no-topics' launch "$drive" --no-topics --dry-run
  expect 0 'node fusion .*--virtual-time' launch "$drive" --virtual-time --dry-run
done
unset ROS_DOMAIN_ID

expect 2 'name = fusoin: must name a node of .*paper_synchronised.yaml: .*laser_pre, .*fusion' node fusoin "$drive" \
  --virtual-time
expect 2 '--policy = fusion: must be NODE=required, NODE=restart or NODE=optional' launch "$drive" --policy fusion
expect 2 '--policy = fusion=never: must be NODE=' launch "$drive" --policy fusion=never
expect 2 '--policy = fusoin=optional: must name a node of' launch "$drive" --policy fusoin=optional
expect 2 'must be given once for each node' launch "$drive" --policy fusion=optional --policy fusion=restart
sed 's/gdNIT: 386/gdNIT: 380/' "$cluster" >"$work/broken.yaml"
expect 2 'broken.yaml:[0-9]+: .*(gdNIT|gMacroPerCycle)' launch "$work/broken.yaml" --dry-run
sed "s#\.\./schedules#$source/schedules#; 0,/node: camera_pre/s//node: camera_per/" \
  "$source/scenarios/faulty_bus.yaml" >"$work/typo.yaml"
expect 2 'camera_per: must be a node' launch "$work/typo.yaml" --dry-run

# Real nodes in place of a launch's own.
expect 2 '--external = feature: must not be given with --virtual-time: a real node keeps real time' launch "$drive" \
  --virtual-time --external feature
expect 0 'partition  real_session' launch "$drive" --external feature --session real_session --dry-run
expect 2 '--external = feature,fusion: must not name the node itself' node fusion "$drive" --external feature,fusion
on_can="launch $drive --bus socketcan:vcan_absent --dry-run --external"
for nodes in fusoin '' feature, ,feature; do
  expect 2 "--external( = $nodes)?: must name a node of .*paper_synchronised.yaml: laser" $on_can "$nodes"
done
expect 2 '--external = laser,fusion,laser: must name each node once' $on_can laser,fusion,laser
expect 2 '--external = .*: must leave at least one node' $on_can \
  laser,camera,laser_pre,camera_pre,gateway,fusion,feature
expect 2 '--policy = camera_pre=restart: must be NODE=required or NODE=optional for a node of --external' $on_can \
  camera_pre --policy camera_pre=restart
expect 1 '900 us into cycles 1 \+ 8n' $on_can camera_pre --policy camera_pre=optional
# shellcheck disable=SC2086
"$program" $on_can camera_pre,laser >"$work/commands" 2>"$work/duties"
grep -qE 'node (camera_pre|laser) ' "$work/commands" && fail "commands for real nodes"
[[ $(wc -l <"$work/commands") -eq 5 ]] || fail "not five commands: $(cat "$work/commands")"
[[ $(grep -c 'is a real node' "$work/duties") -eq 2 ]] || fail "$(cat "$work/duties")"
sed '1,/is a real node/d' "$work/duties" | awk 'length($0) > 100' | grep . && fail "wider than 100 columns"
# shellcheck disable=SC2086
"$program" $on_can camera_pre --json 2>"$work/duties" | python3 -c '
import json, sys
node = json.load(sys.stdin)["nodes"][3]
assert node["name"] == "camera_pre" and node["external"] and "command" not in node
slot, = node["must_send"]["slots"]
assert slot["header"] == "38 02 39 F6 C0" and slot["due_us"] == 91, slot' || fail "the plan as JSON"
grep -qF '0x38, 0x02, 0x39, 0xF6, 0xC0' "$source/examples/real_node.c" || fail "examples/real_node.c has another header"

# A drive that cannot run reports why, and starts nothing.
for dry in '' --dry-run; do
  # shellcheck disable=SC2086
  {
    expect 1 'ip link add dev vcan_absent type vcan' launch "$drive" --bus socketcan:vcan_absent $dry --out "$work/real"
    expect 1 'to do without CANs: --bus dds .* tools/test_bed.sh' launch "$drive" --bus socketcan:vcan_absent $dry \
      --out "$work/real"
  }
done
[[ -x $source/tools/test_bed.sh ]] || fail "there is no test bed"
[[ -e $work/real ]] && fail "a launch that cannot be leaves a folder"
expect 2 '--policy = fusion=restart: must not be given with --virtual-time' \
  launch "$drive" --virtual-time --policy fusion=restart --out "$work/real"
[[ -e $work/real ]] && fail "a launch that is refused leaves a folder"

# A failure to write is no error of the command line, not even in a dry run, which leaves no files.
touch "$work/file"
for dry in '' --dry-run; do
  for time in '' --virtual-time; do
    # shellcheck disable=SC2086
    {
      expect 1 'file/run: cannot be created: Not a directory' launch "$drive" $time $dry --out "$work/file/run"
      expect 1 '/proc/ttfusion/run: cannot be created' launch "$drive" $time $dry --out /proc/ttfusion/run
    }
  done
done
expect 1 'file/run: cannot be created: Not a directory' run "$drive" --out "$work/file/run"
expect 1 'file/run: cannot be created: Not a directory' node fusion "$drive" --virtual-time --out "$work/file/run"
expect 0 'node fusion' launch "$drive" --dry-run --out "$work/several/folders/deep"
[[ -e $work/several ]] && fail "the dry run leaves folders"
mkdir "$work/there"
expect 0 'node fusion' launch "$drive" --dry-run --out "$work/there/run"
[[ -d $work/there && $(ls -A "$work/there") == '' ]] || fail "the dry run changes what was there"

# A log has one writer, by hand too.
mkdir "$work/written"
exec 9>"$work/written/fusion.mcap"
flock 9
expect 2 '--out = .*/written: must be another folder: another process writes .*/written/fusion.mcap' \
  node fusion "$drive" --virtual-time --session "written-$$" --out "$work/written"
exec 9>&-

# The configuration of DDS is tried before anything starts.
export CYCLONEDDS_URI=file://$work/absent.xml
for arguments in "launch $drive" \
  "launch $drive --virtual-time" "launch $drive --dry-run" "node fusion $drive --virtual-time" \
  "node fusion $drive --start-at 4000000000"; do
  # shellcheck disable=SC2086
  expect 2 "environment: CYCLONEDDS_URI = file://.*absent.xml: must be a configuration .* Cyclone DDS says: can't open configuration file" \
    $arguments --out "$work/real"
  [[ -e $work/real ]] && fail "'$arguments' with a wrong CYCLONEDDS_URI leaves a folder"
done
CYCLONEDDS_URI='<CycloneDDS><Domain><Gneral/></Domain></CycloneDDS>'
expect 2 'Cyclone DDS says: config: //CycloneDDS/Domain: Gneral: unknown element' launch "$drive" --out "$work/real"
CYCLONEDDS_URI=file://$source/bus/dds/loopback.xml
expect 0 'node fusion' launch "$drive" --dry-run
unset CYCLONEDDS_URI

# An unreadable cluster: the sentence names the reference and its place. An invalid duration limits nothing
# else.
sed 's#\.\./schedules/paper_sync#absent/paper_sync#' "$drive" >"$work/wanting.yaml"
line=$(grep -n '^ *tt:' "$drive" | cut -d: -f1)
for command in launch run; do
  expect 2 "wanting.yaml:$line: clusters.tt = .*absent/paper_synchronised.yaml: must be a cluster file, but it cannot be read: No such file" \
    $command "$work/wanting.yaml" --strategy tt
  sed 's/^duration: .*/duration: forever/' "$source/scenarios/faulty_bus.yaml" >"$work/forever.yaml"
  [[ $("$program" $command "$work/forever.yaml" 2>&1) =~ ^'error: '[^$'\n']*'forever.yaml:'[0-9]+': duration = forever: must be a time'[^$'\n']*$ ]] ||
    fail "$command with a duration that is none says more than that"
done
expect 2 '--out: must not be empty' run "$drive" --out ''

# A node that rejoins a drive before its start reports that it waits.
timeout 3 "$program" node fusion "$drive" --no-topics --session "early-$$" --rejoin --start-at $(($(date +%s) + 100)) \
  --out "$work/early" >"$work/early.words" 2>&1
grep -Eq '^the drive begins in (9[0-9]|100)\.[0-9] s \(--start-at\); --rejoin finds no cluster before that$' \
  "$work/early.words" ||
  fail "nobody says what is waited for: $(cat "$work/early.words")"

# The dry run: one command per node on standard output, words on the other. Each command works as printed.
"$program" launch "$drive" --virtual-time --seed 5 --duration 2.50 --out "$work/it's dry" \
  --dry-run >"$work/commands" 2>"$work/words" ||
  fail "the dry run fails"
[[ -e "$work/it's dry" ]] && fail "the dry run leaves a folder"
grep -q 'paper_synchronised.yaml is consistent' "$work/words" ||
  fail "the dry run does not say that the schedule is consistent"
nodes=$(sed -n '/^nodes:/,/^[a-z_]*:$/p' "$cluster" | grep -c '^  [a-z_]*:')
[[ $(wc -l <"$work/commands") -eq $nodes ]] || fail "$(wc -l <"$work/commands") commands for $nodes nodes"
grep -Eq -- " node fusion .*paper_scenario1.yaml --strategy tt --seed 5 --bus dds --session [^ ]* --duration 2.5 --virtual-time --out '" "$work/commands" ||
  fail "the dry run's commands are others: $(cat "$work/commands")"
while IFS= read -r line; do
  bash -c "$line --dry" >/dev/null 2>"$work/refused"
  grep -q -- '--dry: is no option of `ttfusion node`' "$work/refused" || fail "a shell does not take: $line"
done <"$work/commands"
"$program" launch "$drive" --strategy buff --time-scale 2.50 --bus socketcan:vcan_absent --can camera_can=can7 \
  --policy fusion=restart --dry-run --json \
  >"$work/plan.json"
[[ $? -eq 1 ]] || fail "the dry run's JSON does not fail where no CAN is"
python3 - "$work/plan.json" <<'PY' || fail "the dry run's JSON is another"
import json, sys
plan = json.load(open(sys.argv[1]))
assert plan["strategy"] == "buff" and plan["cluster"]["name"] == "paper_unsynchronised" and plan["time_scale"] == 2.5, plan
assert plan["virtual_time"] is False and plan["bus"] == "socketcan:vcan_absent" and plan["duration_s"] == 3.0, plan
looked_at = {item["what"]: item for item in plan["preflight"]}
assert list(looked_at)[2:] == ["vcan_absent", "laser_can", "can7", "observation_can"], looked_at
absent = looked_at["vcan_absent"]
assert absent["good"] is False and "ip link add dev vcan_absent type vcan" in absent["commands"], absent
assert looked_at["laser_can"]["commands"][0] == "ip link add dev laser_can type vcan", looked_at
by_name = {node["name"]: node for node in plan["nodes"]}
assert by_name["fusion"]["policy"] == "restart" and by_name["laser_pre"]["policy"] == "required", plan
command = by_name["laser_pre"]["command"]
assert command[1:3] == ["node", "laser_pre"] and command[-4:-2] == ["--time-scale", "2.5"], command
cans = [value for option, value in zip(command, command[1:]) if option == "--can"]
assert cans == ["laser_can=laser_can", "camera_can=can7", "observation_can=observation_can"], command
PY

# A cluster file takes the default scene.
expect 0 'node fusion .*paper_unsynchronised.yaml --strategy adva' \
  launch "$source/schedules/paper_unsynchronised.yaml" --strategy adva --virtual-time --dry-run
expect 0 '"name": "paper_unsynchronised"' launch "$source/schedules/paper_unsynchronised.yaml" --dry-run --json

[[ $failures -eq 0 ]] && echo "launch: all as documented"
exit $((failures > 0))
