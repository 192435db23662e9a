#!/usr/bin/env bash
# `ttfusion schedule check --task-set`: responses and chains of bare tasks, as text and as JSON, and mistakes of its file.
#   task_set_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

shipped=$source/schedules/task_sets/braking.csv
expect 0 '^braking: all deadlines and ages are kept$' schedule check --task-set "$shipped"
says '^processor camera_ecu \(preemptive\), load 55.0 %, priorities as given$' '^bus camera_can \(can\), load ' \
  '^chain braking: exposure > detection > objects > planner > command > brake \(bound\)$' \
  '^chain command alone: planner > command > brake \(exact\)$' \
  '^  together +42.500 +22.500 +42.500 +32.500$'
(cd "$work" && "$program" schedule check --task-set braking) >"$work/by_name" || fail "a shipped task set is not found by its name"
grep -q '^chain braking' "$work/by_name" || fail "a shipped task set has no chain"
expect 2 '^error: brakin: is neither a file nor the name of a shipped task set; did you mean braking\?$' \
  schedule check --task-set brakin
"$program" schedule check --task-set "$shipped" --json >"$work/set.json" || fail "a task set as JSON fails"
python3 - "$work/set.json" <<'PY' || fail "a task set is wrong as JSON"
import json, sys
check = json.load(open(sys.argv[1]))
assert check["holds"] is True and check["misses"] == [], check
assert [r["name"] for r in check["resources"]] == ["camera_ecu", "drive_ecu", "brake_ecu", "camera_can", "backbone"], check
tasks = {t["name"]: t for r in check["resources"] for t in r["tasks"]}
assert len(tasks) == 10 and all(t["met"] for t in tasks.values()), tasks
assert (tasks["planner"]["response_ms"], tasks["planner"]["quality"]) == (4, "exact"), tasks["planner"]
assert tasks["objects"]["jitter_ms"] == 9 and tasks["objects"]["quality"] == "bound", tasks["objects"]
figures = ["reaction_time", "reduced_reaction_time", "data_age", "reduced_data_age"]
assert [c["exact"] for c in check["chains"]] == [False, True], check["chains"]
for c in check["chains"]:
    assert c["met"] and c["reaction_time"]["ms"] == c["data_age"]["ms"] <= c["largest_age_ms"], c
    for figure in figures:
        parts = sum(s[p] for s in c[figure]["shares"] for p in ("waits_ms", "runs_ms", "stays_ms"))
        assert abs(parts - c[figure]["ms"]) < 1e-6, (c["name"], figure)
        assert c[figure]["ms"] <= c["reaction_time"]["ms"], c
PY

# A dynamic segment, slots of TDMA, and CANs with errors.
buses=$source/schedules/task_sets/buses.csv
expect 0 '^buses: all deadlines and ages are kept$' schedule check --task-set "$buses"
says '^processor brake_ecu \(tdma\), load 17.0 %$' '^  brake +10.000 +0.000 +6.000 +10.000  exact$' '^bus dynamic \(dynamic\), load 17.8 %$' \
  '^bus body_can \(can\), load 2.4 %, errors 10 ms apart or more, priorities as given$' \
  '^  damper .*  late at most 2.4e-12$'
"$program" schedule check --task-set "$buses" --json >"$work/buses.json" || fail "buses as JSON fail"
python3 - "$work/buses.json" <<'PY' || fail "buses are wrong as JSON"
import json, sys
check = json.load(open(sys.argv[1]))
resources = {r["name"]: r for r in check["resources"]}
assert resources["body_can"]["errors_apart_ms"] == 10 and resources["chassis_can"]["errors_per_s"] == 30, resources
late = [t["late_probability"] for t in resources["chassis_can"]["tasks"]]
assert len(late) == 2 and all(0 < p < 1e-9 for p in late), late
assert [c["without_errors"] for c in check["chains"]] == [False, False], check["chains"]
PY
sed 's/, 10 ms$/, 20\/s/; s/pedal, body_can, 10 ms, , , , 4/pedal, body_can, 10 ms, , , , 9/' "$buses" >"$work/nine.csv"
expect 2 '^error: .*/nine.csv:[0-9]+: pedal.worst = 9: must be a whole number 0..8 bytes$' schedule check --task-set "$work/nine.csv"

# A limit that is not kept, an overload, and a mistake.
sed 's/brake, 70 ms/brake, 42 ms/' "$shipped" >"$work/late.csv"
expect 1 '^  command alone: data may be 42500 us old, more than 42 ms$' schedule check --task-set "$work/late.csv"
says '^  largest age allowed +42.000  missed$' '^late: not kept:$'
"$program" schedule check --task-set "$work/late.csv" --json >"$work/late.json"
[[ $? -eq 1 ]] || fail "an age that is not kept, as JSON, does not exit with 1"
grep -q '"holds": false' "$work/late.json" || fail "an age that is not kept holds as JSON"
sed 's/1 ms, 1 ms$/6 ms, 6 ms/' "$shipped" >"$work/overload.csv"
expect 1 '^  planner: no bound found for its response$' schedule check --task-set "$work/overload.csv"
says '^  braking: no times: no bound found for the response of planner$'
sed 's/21 ms, , 2/21 ms, , 1/' "$shipped" >"$work/wrong.csv"
expect 2 '^error: .*/wrong.csv:[0-9]+: detection.priority = 1: must be another one than that of exposure$' \
  schedule check --task-set "$work/wrong.csv"
expect 2 '^error: .*paper_synchronised.yaml: this is a cluster.*, not a task set; ' schedule check --task-set \
  "$source/schedules/paper_synchronised.yaml"
"$program" schedule check --task-set "$work/wrong.csv" --json 2>"$work/words" >"$work/wrong.json"
[[ $? -eq 2 ]] || fail "a wrong file as JSON does not exit with 2"
python3 - "$work/wrong.json" <<'PY' || fail "a wrong file has no findings as JSON"
import json, sys
finding, = json.load(open(sys.argv[1]))["findings"]
assert (finding["key"], finding["value"]) == ("detection.priority", "1") and finding["line"] > 0, finding
PY
expect 2 'csv: cannot be read' schedule check --task-set "$work/absent.csv"
expect 2 '--medium: must not be given with --task-set' schedule check --task-set "$shipped" --medium can-fd:1M/5M
expect_full schedule check --task-set "$shipped"
[[ $failures -eq 0 ]] && echo "task sets: all as documented"
exit $((failures > 0))
