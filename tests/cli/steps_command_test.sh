#!/usr/bin/env bash
# Steps of libraries, as `run` and `experiment` take them: allowed folders, refusals, failures, and the same records.
#   steps_command_test.sh PROGRAM SOURCE_DIR STEPS
set -u
program=$1
source=$2
steps=$3
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/small_sweep.sh"
example=$source/examples/step

# ---- a file alone loads no code, and needs none to be read
place='examples/step/cluster.yaml:[0-9]+: nodes.feature.tasks.warn.step = distance.so'
expect 2 "^error: .*$place: needs --steps FOLDER, the library's folder: a cluster file alone loads no code\$" \
  run "$example/scenario.yaml" --strategy tt --out "$work/none"
expect 2 "$place: needs --steps" launch "$example/scenario.yaml" --virtual-time --dry-run --out "$work/none"
expect 2 "$place: needs --steps" launch "$example/cluster.yaml" --virtual-time --dry-run --out "$work/none"
expect 2 "$place: needs --steps" node feature "$example/scenario.yaml" --virtual-time --out "$work/none"
expect 0 'consistent' schedule check "$example/cluster.yaml"
expect 0 'dashboard +show' schedule show "$example/cluster.yaml"
expect 0 '' schedule export "$example/cluster.yaml" --format fibex -o "$work/cluster.xml"

# ---- the options
expect 2 '--steps = .*/absent: must be a folder$' run "$example/scenario.yaml" --steps "$work/absent"
expect 2 '--step-limit = 3: goes with --steps$' run "$example/scenario.yaml" --step-limit 3
expect 2 '--step-limit = 0: must be a decimal number 0.1..3600 s$' run "$example/scenario.yaml" --steps "$steps" --step-limit 0
expect 2 '--steps = .*: is for sweeps: a campaign runs no steps$' experiment "$source/experiments/fault_campaign.yaml" --steps "$steps"
expect 0 "--steps $steps --step-limit 3 --out" launch "$example/scenario.yaml" --virtual-time --steps "$steps" --step-limit 3 \
  --dry-run --out "$work/dry"

# ---- the example, and its log
expect 0 's: lamp on, nearest object at 14\.[0-9]+ m' run "$example/scenario.yaml" --strategy tt --steps "$steps" --no-pictures \
  --out "$work/example"
for library in distance lamp; do
  grep -aq "hash.$library.so" "$work/example/tt.mcap" || fail "the log's manifest has no hash of $library.so"
done

mkdir "$work/distance_only"
cp "$steps/distance.so" "$work/distance_only"
expect 0 'wrote' report "$work/example" -o "$work/example.html"
grep -q -- '--strategy tt --seed [0-9]* --steps FOLDER$' "$work/example.html" || fail "the report's command has no --steps"

# ---- each process needs the libraries of its own nodes
launched() { expect "$1" "$2" launch "$example/scenario.yaml" --no-topics --dry-run --time-scale 10 --out "$work/real" "${@:3}"; }
launched 2 'nodes.dashboard.tasks.show.step = lamp.so: must be a file' --steps "$work/distance_only"
launched 0 '' --steps "$work/distance_only" --external dashboard

# ---- a library's gateway, in place of the program's own
with_gateway() {   # LIBRARY: a scenario whose gateway is the library's, in $work/LIBRARY.yaml
  sed "s/step: gateway/step: $1/" "$source/schedules/paper_synchronised.yaml" >"$work/$1.cluster.yaml"
  sed "s#\.\./schedules/paper_synchronised.yaml#$1.cluster.yaml#; s#\.\./schedules#$source/schedules#" \
    "$source/scenarios/paper_scenario1.yaml" >"$work/$1.yaml"
}
for library in copy other_version refuses hangs crashes exits fails; do with_gateway "$library.so"; done
drive() { local code=$1 says=$2 library=$3; shift 3; expect "$code" "$says" run "$work/$library.yaml" --strategy tt --no-pictures \
  --steps "$steps" --out "$work/$library" "$@"; }
hash=$(sed -n 's/.*"paper_scenario1 tt": "\(.*\)".*/\1/p' "$source/tests/golden/content_hashes.json")
drive 0 "content hash of the log +$hash" copy.so
place='nodes.gateway.tasks.forward_laser.step ='
drive 2 "$place other_version.so: must be built with version 1 of ttfusion_step.h: .*/other_version.so is of version 2\$" other_version.so
drive 2 "$place refuses.so: is refused by the library: in of laser_objects is not what I read\$" refuses.so
place='nodes.gateway.tasks.forward_camera.step ='   # the camera's lists come more often
drive 1 "$place exits.so: a call ended the process\$" exits.so
drive 1 "$place fails.so: failed: ttf_step_run returned 7\$" fails.so
# A processor that others hold may let any call of this library last too long.
drive 1 "nodes.gateway.tasks.forward_[a-z]+.step = hangs.so: a call did not return within 0.2 s \\(--step-limit\\)\$" hangs.so --step-limit 0.2
(ulimit -c 0; drive 139 "$place crashes.so: a call crashed\$" crashes.so; exit "$failures") || fail "a crash is not said"
for library in other_version refuses; do [[ ! -e $work/$library.so/tt.mcap ]] || fail "what is refused leaves a log"; done

# ---- experiments: several workers, a step that fails, and another library under the same name
mkdir "$work/steps"
cp "$steps/copy.so" "$work/steps"
sweep() {   # LIBRARY
  small_sweep 4 "700 ms" "400 ms" | sed "s#/scenarios/dynamics.yaml#/scenarios/paper_scenario1.yaml#; /^  adva:/d
    s#tt: {strategy: tt,#tt: {strategy: tt, cluster: $work/$1.cluster.yaml,#; /^paradigms/a\\  own: {strategy: tt, set: {duration: 700 ms, evaluate_from: 400 ms}}"
}
sweep copy.so >"$work/sweep.yaml"
expect 2 "nodes.gateway.tasks.forward_laser.step = copy.so: needs --steps" experiment "$work/sweep.yaml" --out "$work/sweep"
expect 0 'no difference of position_rmse_truth' experiment "$work/sweep.yaml" --steps "$work/steps" --jobs 2 --out "$work/sweep"
python3 - "$work/sweep/runs.csv" <<'PY' || fail "a library's copy of the gateway measures something else"
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
by = {}
for row in rows: by.setdefault(tuple(v for k, v in row.items() if k != "paradigm"), set()).add(row["paradigm"])
assert len(rows) == 16 and all(both == {"own", "tt"} for both in by.values()), rows
PY
# The page's commands name --steps, whether or not its runs were driven again.
repeats() {   # PAGE
  for command in 'sweep.yaml --steps FOLDER --out again' 'sweep.yaml --replay 0/[a-z]*/0 --steps FOLDER --out one'; do
    grep -q -- "$command" "$1" || fail "$1 does not say '$command'"
  done
}
expect 0 'wrote' report "$work/sweep" --no-drives -o "$work/no_drives.html"
repeats "$work/no_drives.html"
expect 0 'warning: No drive is shown here: .*copy.so: needs --steps' report "$work/sweep" -o "$work/without.html"
repeats "$work/without.html"
expect 0 'wrote' report "$work/sweep" --steps "$work/steps" -o "$work/with.html"
repeats "$work/with.html"
cp "$steps/fails.so" "$work/steps/copy.so"
expect 2 'must belong to this experiment' experiment "$work/sweep.yaml" --steps "$work/steps" --resume --out "$work/sweep"
expect 1 'forward_camera.step = copy.so: failed: ttf_step_run returned 7' experiment "$work/sweep.yaml" --steps "$work/steps" \
  --out "$work/failed"
says "ttfusion experiment $work/sweep.yaml --replay 0/tt/0 --steps $work/steps --out out/one"

[[ $failures -eq 0 ]] && echo "steps: loaded where it is allowed, and all failures are sentences"
exit $((failures > 0))
