#!/usr/bin/env bash
# Mistakes on the command line, files of another kind, and files that are not there: one clear sentence each, and exit code 2.
#   arguments_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

cp -r "$source/scenarios" "$work/scenarios"
ln -s "$source/schedules" "$work/schedules"

one_sentence() {  # SENTENCE ARGS...: all that the program says, and exit code 2
  local sentence=$1 output
  shift
  output=$("$program" "$@" 2>&1)
  [[ $? -eq 2 && $output == "error: command line: $sentence" ]] || fail "$* does not say '$sentence': $output"
}
paper=$source/scenarios/paper_scenario1.yaml
for arguments in '' --help; do
  # shellcheck disable=SC2086
  expect 0 '^ttfusion drives clusters' $arguments
  # shellcheck disable=SC2086
  expect 0 '^  schedule +Validate, draw' $arguments
done
[[ $("$program" -V) == "$("$program" --version)" && -n $("$program" -V) ]] || fail "-V is not --version"
[[ -z $("$program" 2>&1 >/dev/null) ]] || fail "the help that no argument prints is an error"
for command in '' run launch node diagram export report track experiment keys 'schedule check' 'schedule export'; do
  # shellcheck disable=SC2086
  wide=$("$program" $command --help | awk 'length > 100 && !/ ttfusion /')   # examples are for copying
  [[ -z $wide ]] || fail "the help of '$command' has lines of more than 100 characters: $wide"
done
one_sentence 'scenario: must be given to `ttfusion run`: Scenario file or a shipped one'"'"'s name, or several to compare' run
one_sentence 'ttfusion schedule: must be followed by check, show, export, sequence or synthesize' schedule
commands='run, diagram, export, schedule, experiment, keys, launch, node, report, track or manual'
one_sentence "foo: is no command of \`ttfusion\`: must be $commands" foo --help
one_sentence 'rnu: is no command of `ttfusion`: did you mean run?' rnu "$paper"
one_sentence 'draw: is no command of `ttfusion schedule`: must be check, show, export, sequence or synthesize' schedule draw x.yaml
one_sentence '--fast: is no option of `ttfusion run`, whose --help lists them' run "$paper" --fast
one_sentence '-s: is no option of `ttfusion run`, whose --help lists them' run "$paper" -s
one_sentence '--startegy: is no option of `ttfusion run`: did you mean --strategy?' run "$paper" --startegy tt
one_sentence '--fromat: is no option of `ttfusion export`: did you mean --format?' export x.mcap --fromat=csv -o x.csv
one_sentence 'x.yaml: is one argument too many for `ttfusion launch`' launch "$paper" x.yaml
one_sentence '--seed: must have a value: Seed of every random stream, instead of the scenario'"'s" run "$paper" --seed
one_sentence '--seed: must be given once' run "$paper" --seed 1 --seed 2
one_sentence '--json = maybe: must have no value' run "$paper" --json=maybe
one_sentence '--channels: goes with --against only' schedule check x.yaml --channels A
one_sentence '--shard: must not be given with --merge' experiment x.yaml --shard 1/2 --merge a b
for command in run launch 'node fusion' track; do
  # shellcheck disable=SC2086
  one_sentence '--strategy = best: must be one of buff, adva, tt' $command "$paper" --strategy best
done
# Numbers, as typed.
for jobs in 0 1025 -1 2.5 010 0x10 many 99999999999999999999; do
  one_sentence "--jobs = $jobs: must be a whole number 1..1024" experiment x.yaml "--jobs=$jobs"
done
one_sentence '--replications = 0: must be a whole number 1..10000000' experiment x.yaml --replications 0
for seed in -1 2.5 one 4611686018427387905; do
  one_sentence "--seed = $seed: must be a whole number 0..4611686018427387904" experiment x.yaml "--seed=$seed"
done
one_sentence '--shuffle = 1001: must be a whole number 1..1000' track x.csv --shuffle 1001
one_sentence '--point = -1: must be a whole number 0..9999' report x --point -1 -o x.html
one_sentence '--frame = one: must be a whole number 0..999999999' diagram x.csv --kind boxes --frame one -o x.svg
for seconds in a -0.1 nan 1e3 1000000000.1 ''; do
  wanted="${seconds:+ = $seconds}: must be a decimal number 0..1000000000 s"
  for option in --from --to; do
    one_sentence "$option$wanted" diagram x.mcap "$option" "$seconds" -o x.svg
    one_sentence "$option$wanted" report "$work" "$option" "$seconds" -o x.html
    one_sentence "$option$wanted" schedule check "$source/schedules/paper_synchronised.yaml" --against x.pcapng \
      "$option" "$seconds"
  done
done
nameless="must not be empty or begin with a '-' (write ./-NAME instead)"
one_sentence "--out: $nameless" diagram x.mcap -o ''
one_sentence "--out: $nameless" export x.mcap --format csv -o ''
one_sentence "--out = --json: $nameless" experiment x.yaml --out= --json
one_sentence "--out = --format: $nameless" schedule export x.yaml --out= --format fibex
one_sentence '--out = x.pdf: must end in .html: a report is one HTML page' report "$work" -o x.pdf
other_format() {  # FILE END FORMAT OTHER ARGS...: ARGS write FORMAT, but FILE ends as a file of OTHER does
  one_sentence "--out = $1: must not end in $2 with --format $3: that is a file of --format $4" "${@:5}" --format "$3" -o "$1"
}
other_format x.xml .xml dbc fibex schedule export "$source/schedules/paper_synchronised.yaml"
other_format x.dbc .dbc fibex dbc schedule export "$source/schedules/paper_synchronised.yaml"
other_format x.yml .yml fibex yaml schedule export "$source/schedules/paper_synchronised.yaml"
other_format x.csv .csv pcapng csv export x.mcap
other_format x.pftrace .pftrace csv perfetto export x.mcap
other_format x.csv .csv foxglove csv export x.mcap

# A file of another kind is one sentence.
other_kind() {  # KIND WANTED ARGS...: the last argument is the file
  local output kind=$1 wanted=$2
  shift 2
  output=$("$program" "$@" 2>&1)
  [[ $? -eq 2 && $output == "error: ${!#}: this is $kind, not $wanted; "* && $output != *$'\n'* ]] ||
    fail "$* does not say that it is $kind: $output"
}
cluster=$source/schedules/paper_synchronised.yaml
experiment=$source/experiments/process_noise.yaml
campaign=$source/experiments/fault_campaign.yaml
faults=$source/experiments/faults/camera_crash.yaml
echo 'tracker: {process_noise: 1}' >"$work/tracker.yaml"
: >"$work/rows.csv"
other_kind 'a cluster' 'a scenario' run "$cluster"
other_kind 'an experiment' 'a scenario' run "$experiment"
other_kind 'an experiment' 'a scenario' launch --dry-run "$campaign"
other_kind 'a fault list' 'a scenario' run "$faults"
other_kind 'a track configuration' 'a scenario' node fusion "$work/tracker.yaml"
other_kind 'a scenario' 'a cluster' schedule check "$paper"
other_kind 'an experiment' 'a cluster' schedule show "$experiment"
other_kind 'an experiment' 'a cluster' schedule export --format dbc "$campaign"
other_kind 'a scenario' 'an experiment' experiment "$paper"
other_kind 'a cluster' 'an experiment' experiment "$cluster"
other_kind 'a scenario' 'a track configuration' track "$work/rows.csv" --config "$paper"
other_kind 'a cluster' 'a track configuration' track "$work/rows.csv" --config "$cluster"
for file in "$cluster" "$paper" "$experiment"; do
  kind=$(case $file in "$cluster") echo a cluster ;; "$paper") echo a scenario ;; *) echo an experiment ;; esac)
  other_kind "$kind" 'a recording' track "$file"
  other_kind "$kind" 'a recording' track --format laser_radar "$file"
  other_kind "$kind" 'a recording' run "$source/scenarios/laser_radar_recorded.yaml" --input "$file"
  other_kind "$kind" 'a recording' diagram -o x.svg --kind boxes "$file"
done
expect 2 '; `ttfusion schedule check` takes it$' run "$cluster"
# So is a file of another format.
fibex=$work/bus.xml
dbc=$source/schedules/paper_synchronised.dbc
expect 0 '' schedule export "$cluster" --format fibex -o "$fibex"
for file in "$fibex" "$dbc"; do
  kind=$([[ $file == "$dbc" ]] && echo a DBC file || echo a FIBEX file)
  other_kind "$kind" 'a scenario' run "$file"
  other_kind "$kind" 'a scenario' launch --dry-run "$file"
  other_kind "$kind" 'an experiment' experiment "$file"
  other_kind "$kind" 'a track configuration' track "$work/rows.csv" --config "$file"
  other_kind "$kind" 'a recording' track "$file"
done
other_kind 'a DBC file' 'a cluster' schedule check "$dbc"
other_kind 'a DBC file' 'a FIBEX file' schedule export --format yaml "$dbc"
expect 0 '^name: ' schedule export --format yaml "$cluster"
# A log and a capture are recognised by their first bytes.
log=$work/run/tt.mcap
expect 0 '' run "$paper" --strategy tt --no-pictures --duration 1.6 --out "$work/run"
expect 0 '' export "$log" --format pcapng -o "$work/run.pcapng"
for file in "$log" "$work/run.pcapng"; do
  kind=$([[ $file == "$log" ]] && echo a log || echo a capture)
  other_kind "$kind" 'a scenario' run "$file"
  other_kind "$kind" 'a cluster' schedule check "$file"
  other_kind "$kind" 'an experiment' experiment "$file"
  other_kind "$kind" 'a recording' track "$file"
done
other_kind 'a log' 'a capture' schedule check "$cluster" --against "$log"
other_kind 'a cluster' 'a capture' schedule check "$cluster" --against "$cluster"
other_kind 'a log' 'a folder of results' report -o x.html "$log"
expect 2 "; \`ttfusion report $work/run\` takes its folder$" report "$log" -o x.html
for file in "$paper" "$cluster" "$work/run.pcapng" "$fibex"; do
  kind=$(case $file in "$paper") echo a scenario ;; "$cluster") echo a cluster ;; "$fibex") echo a FIBEX file ;; *) echo a capture ;; esac)
  other_kind "$kind" 'a log' diagram -o x.svg "$file"
  other_kind "$kind" 'a log' export --format csv -o x.csv "$file"
  other_kind "$kind" 'a folder of results' report -o x.html "$file"
done
sed "s#paper_synchronised.yaml#paper_synchronised.dbc#" "$paper" >"$work/scenarios/mixed.yaml"
expect 2 '^error: .*/paper_synchronised.dbc: this is a DBC file, not a cluster; ' run "$work/scenarios/mixed.yaml" --strategy tt
sed "s#paper_synchronised.yaml#../scenarios/paper_scenario2.yaml#" "$paper" >"$work/scenarios/mixed.yaml"
expect 2 '^error: .*/paper_scenario2.yaml: this is a scenario, not a cluster; ' run "$work/scenarios/mixed.yaml" --strategy tt
mkdir "$work/experiments"
mixed=$work/experiments/mixed.yaml
sed 's#^scenario: .*#scenario: ../schedules/paper_synchronised.yaml#' "$experiment" >"$mixed"
expect 2 '^error: .*/paper_synchronised.yaml: this is a cluster, not a scenario; ' experiment "$mixed" --out "$work/none"
# A file that is not there is a mistake of the entry that names it.
sed 's#^scenario: .*#scenario: absent.yaml#' "$experiment" >"$mixed"
line=$(grep -n '^scenario:' "$experiment" | cut -d: -f1)
expect 2 "mixed.yaml:$line: scenario = .*/absent.yaml: must be a scenario file, but it cannot be read: No such file" \
  experiment "$mixed" --out "$work/none"
sed "s#^scenario: .*#scenario: $source/scenarios/dynamics.yaml#; s#../schedules/paper_event_triggered#absent#" \
  "$experiment" >"$mixed"
line=$(grep -n '^  can_adva:' "$experiment" | cut -d: -f1)
expect 2 "mixed.yaml:$line: paradigms.can_adva.cluster = .*/absent.yaml: must be a cluster file, but it cannot be read" \
  experiment "$mixed" --out "$work/none"
sed 's#^cluster: .*#cluster: absent.yaml#' "$campaign" >"$mixed"
line=$(grep -n '^cluster:' "$campaign" | cut -d: -f1)
expect 2 "mixed.yaml:$line: cluster = .*/absent.yaml: must be a cluster file, but it cannot be read" experiment "$mixed"
# Shipped files by name, in a folder that has none; a file of one's own goes first.
mkdir "$work/elsewhere"
cd "$work/elsewhere" || exit 1
shipped() {  # ARGS...: what the program says of a schedule
  "$program" schedule check "$@" 2>&1 | head -n 1
}
[[ -n $(shipped "$cluster") ]] || fail "schedule check says nothing"
for name in paper_synchronised paper_synchronised.yaml schedules/paper_synchronised.yaml; do
  [[ $(shipped $name) == "$(shipped "$cluster")" ]] || fail "$name is not the shipped schedule: $(shipped $name)"
done
mkdir two_lasers   # a folder of results is no scenario
expect 0 '' launch two_lasers --virtual-time --dry-run
expect 0 '' launch flexray_demo --virtual-time --dry-run
echo 'name: mine' | tee crowd_25.yaml >paper_synchronised
expect 2 '^error: paper_synchronised:1: ' schedule check paper_synchronised
expect 2 '^error: crowd_25.yaml:1: ' run crowd_25
expect 2 '^error: paper_scenaro1.yaml: is neither a file nor the name of a shipped scenario; did you mean paper_scenario1\?$' \
  run paper_scenaro1.yaml
expect 2 '^error: crowd_52: is neither .* scenario or schedule; did you mean crowd_25' launch crowd_52 --virtual-time
expect 2 '^error: zzz: is neither a file nor the name of a shipped experiment$' experiment zzz
expect 2 '^error: scenarios/zzz.yaml: is neither a file nor the name of a shipped scenario$' run scenarios/zzz.yaml
expect 2 '^error: scenarios/paper_scenari1: is neither .* shipped scenario; did you mean paper_scenario1\?$' \
  launch scenarios/paper_scenari1 --virtual-time
expect 2 '^error: own/zzz.yaml: cannot be read: No such file' run own/zzz.yaml
expect 0 '^ttfusion [0-9.]+, commit ([0-9a-f]{12}(-dirty)?|unknown)$' --version
says '^compiled by ' '^with DDS '

[[ -e $work/none ]] && fail "what is refused leaves a folder behind"

[[ $failures -eq 0 ]] && echo "arguments: all as documented"
exit $((failures > 0))
