#!/usr/bin/env bash
# `ttfusion experiment` of a sweep: killed and resumed, in shards, one run again, and refused input.
#   sweep_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/small_sweep.sh"

small_sweep 20 "700 ms" "400 ms" >"$work/small.yaml"
file=$work/small.yaml

expect 0 'position_rmse_truth of tt is less than that of adva at|no difference of position_rmse_truth between tt and adva' experiment "$file" --out "$work/whole"
[[ $(cd "$work/whole" && echo *) == "answer.json answer.txt results.sqlite runs.csv summary.csv" ]] ||
  fail "other files: $(cd "$work/whole" && echo *)"
[[ -s $work/whole/answer.json && -s $work/whole/summary.csv ]] || fail "an empty file"
[[ $(wc -l <"$work/whole/runs.csv") -eq 81 ]] || fail "not 80 runs: $(wc -l <"$work/whole/runs.csv")"
expect 2 'results.sqlite: exists already: --resume continues it' experiment "$file" --out "$work/whole"

# ---- killed before there was a store: the options are lost, and --resume says so
expect 2 '--resume: needs .*/not_begun/results.sqlite, which is not there: begin without --resume, with all other' \
  experiment "$file" --out "$work/not_begun" --resume
[[ -e $work/not_begun ]] && fail "what is refused leaves a folder behind"

# watch STORE PID ROWS [hold]: waits until the process has written more rows than these, and prints their number.
# "hold": then reads one row, and does not let go until the process ends.
watch() {
  python3 - "$@" <<'END'
import sqlite3, sys, time
store, sweep, before, *hold = sys.argv[1:]
def is_there():  # and no zombie
    try: return open(f"/proc/{sweep}/stat").read().split()[2] != "Z"
    except OSError: return False
rows = 0
while rows <= int(before) and is_there():
    try:
        reader = sqlite3.connect(f"file:{store}?mode=ro", uri=True).cursor()
        rows = reader.execute("select count(*) from runs").fetchone()[0]
    except sqlite3.Error:
        time.sleep(0.01)
    time.sleep(0.02)
print(rows)
if hold:
    row = reader.execute("select * from runs").fetchone()
    while is_there(): time.sleep(0.05)
    sys.exit(row is None)
END
}

# ---- a reader that does not let go; long enough to be read, since finished runs are written twice a second
small_sweep 100 "2 s" "400 ms" >"$work/long.yaml"
"$program" experiment "$work/long.yaml" --out "$work/read" >"$work/words" 2>&1 &
sweep=$!
watch "$work/read/results.sqlite" "$sweep" 0 hold >/dev/null || fail "the store cannot be read while it is written"
wait "$sweep" || fail "a reader ends the sweep: $(cat "$work/words")"

# ---- killed twice at any point, and resumed with the same result
rows=0
for resume in "" --resume; do
  # shellcheck disable=SC2086
  "$program" experiment "$work/long.yaml" --out "$work/killed" --jobs 1 $resume >/dev/null 2>&1 &
  victim=$!
  rows=$(watch "$work/killed/results.sqlite" "$victim" "$rows")
  kill -9 "$victim" 2>/dev/null || fail "it was done before it could be killed: $resume"
  wait "$victim" 2>/dev/null
done
expect 0 '^wrote ' experiment "$work/long.yaml" --out "$work/killed" --resume
for name in runs.csv summary.csv answer.txt answer.json; do
  cmp "$work/read/$name" "$work/killed/$name" || fail "$name of a run that was read is not that of one that was killed twice"
done
[[ $(cd "$work/killed" && echo results.sqlite*) == results.sqlite ]] || fail "a finished store has files beside it"

# ---- in two shards
expect 0 '' experiment "$file" --shard 1/2 --out "$work/first"
expect 0 '' experiment "$file" --shard 2/2 --out "$work/second"
expect 0 '' experiment "$file" --merge "$work/second" "$work/first" --out "$work/both"
cmp "$work/whole/runs.csv" "$work/both/runs.csv" || fail "two shards put together are not the whole"

# ---- fewer for a quick look, and the missing ones later; in shards, too
expect 0 '' experiment "$file" --replications 5 --out "$work/quick"
[[ $(wc -l <"$work/quick/runs.csv") -eq 21 ]] || fail "5 replications are not 20 runs"
cp "$work/quick/runs.csv" "$work/five.csv"
expect 0 '5 replications' experiment "$file" --out "$work/quick" --resume
cmp "$work/five.csv" "$work/quick/runs.csv" || fail "going on forgets how many were asked for"
expect 2 '--replications = 4: must be at least 5, as in .*quick/results.sqlite' \
  experiment "$file" --out "$work/quick" --resume --replications 4
expect 0 '' experiment "$file" --out "$work/quick" --resume --replications 20
for name in runs.csv summary.csv answer.txt answer.json; do
  cmp "$work/whole/$name" "$work/quick/$name" || fail "$name of 5 replications and the rest is another"
done
expect 0 '' experiment "$file" --shard 1/2 --replications 5 --out "$work/five_first"
expect 0 '' experiment "$file" --shard 2/2 --replications 5 --out "$work/five_second"
expect 0 '' experiment "$file" --merge "$work/five_first" "$work/five_second" --out "$work/five"
cmp "$work/five.csv" "$work/five/runs.csv" || fail "two shards of 5 replications put together are others"
expect 1 '12 of 32 runs are missing' \
  experiment "$file" --merge "$work/five_first" "$work/five_second" --replications 8 --out "$work/eight"
expect 2 'must be at least 5' experiment "$file" --merge "$work/five_first" --replications 3 --out "$work/never"
expect 2 '--replications = 10000000: must make at most 100000000 drives' \
  experiment "$source/experiments/process_noise.yaml" --replications 10000000 --out "$work/never"
expect 2 '--replications = 5: is for sweeps' experiment "$source/experiments/fault_campaign.yaml" --replications 5
expect 0 'noise 40, tt, replication 20: done' experiment "$file" --replay 1/tt/20 --replications 21
expect 2 'replications 0..19' experiment "$file" --replay 1/tt/20
[[ -e $work/never ]] && fail "a count that cannot be leaves a folder behind"

# ---- one run again is the row
expect 0 'noise 40, tt, replication 7: done' experiment "$file" --replay 1/tt/7 --out "$work/one"
value=$("$program" experiment "$file" --replay 1/tt/7 | awk '$1 == "position_rmse_truth" {print $2}')
grep -q "^1,40,7,tt,done,$value," "$work/whole/runs.csv" || fail "the run that is driven again is another: $value"
expect 0 '' diagram "$work/one/tt.mcap" --from 0.5 --to 0.55 -o "$work/one.svg"
expect 2 '--replay = 1/tt: must be point/paradigm/replication, of points 0..1 and replications 0..19' \
  experiment "$file" --replay 1/tt
expect 2 'must be point/paradigm/replication' experiment "$file" --replay 2/tt/0
expect 2 'must be point/paradigm/replication' experiment "$file" --replay 1/buff/0

# ---- another seed than the file's: as a copy of the file with that seed, in a folder of its own
sed 's/seed: 3/seed: 4/' "$file" >"$work/other.yaml"
expect 0 '' experiment "$work/other.yaml" --out "$work/copy"
expect 0 '' experiment "$file" --seed 4 --out "$work/seed"
for name in runs.csv summary.csv answer.txt; do
  cmp "$work/copy/$name" "$work/seed/$name" || fail "$name with --seed 4 is not that of a copy of the file"
done
cmp -s "$work/whole/runs.csv" "$work/seed/runs.csv" && fail "another seed drives the same"
grep -q '"seed": 4,' "$work/seed/answer.json" || fail "answer.json does not name the seed"
expect 0 '' experiment "$work/other.yaml" --out "$work/seed" --resume
expect 0 '' experiment "$file" --seed 3 --out "$work/whole" --resume
expect 2 'must belong to this experiment: the file, its seed, a file' experiment "$file" --seed 4 --out "$work/whole" --resume
expect 2 'must belong to this experiment: the file, its seed, a file' experiment "$file" --out "$work/seed" --resume
expect 2 'must belong to this experiment' experiment "$file" --seed 4 --merge "$work/first" "$work/second" --out "$work/never"
value=$("$program" experiment "$file" --seed 4 --replay 1/tt/7 | awk '$1 == "position_rmse_truth" {print $2}')
[[ -n $value ]] || fail "--replay with --seed prints no value"
grep -qE "^1,[^,]*,7,tt,done,.*$value" "$work/seed/runs.csv" || fail "--replay with --seed drives another run"
expect 0 '' report "$work/seed" -o "$work/seed.html"
grep -q 'No drive is shown here' "$work/seed.html" && fail "the report cannot drive a run of another seed again"
expect 0 '' experiment "$source/experiments/process_noise.yaml" --seed 4611686018427387904 --replay 0/tt/0
sed 's/^seed: 3$/seed: many/' "$file" >"$work/no_seed.yaml"
expect 2 'no_seed.yaml:5: seed = many: must be' experiment "$work/no_seed.yaml" --seed 4 --out "$work/never"
sed '/^seed: 3$/d' "$file" >"$work/no_seed.yaml"
expect 2 'no_seed.yaml.*: seed: is missing' experiment "$work/no_seed.yaml" --seed 4 --out "$work/never"

# ---- refused input, and unexpected results
expect 2 'must belong to this experiment: the file, its seed, a file that it names or the program has changed' \
  experiment "$work/other.yaml" --out "$work/whole" --resume
expect 2 'must belong to this experiment' experiment "$work/other.yaml" --merge "$work/first" --out "$work/none"
expect 2 'none/results.sqlite: cannot be opened' experiment "$file" --merge "$work/first" "$work/none" \
  --out "$work/none"
expect 2 '--shard = 3/2' experiment "$file" --shard 3/2 --out "$work/none"
[[ -e $work/none ]] && fail "what is refused leaves a folder behind"
expect 1 '40 of 80 runs are missing: --resume drives them' experiment "$file" --merge "$work/first" \
  --out "$work/half"
expect 0 '' experiment "$file" --out "$work/half" --resume
cmp "$work/whole/runs.csv" "$work/half/runs.csv" || fail "a shard and the rest are not the whole"
cp -r "$work/first" "$work/foreign"
python3 -c "import sqlite3, sys
with sqlite3.connect(sys.argv[1]) as store: store.execute('update runs set paradigm = 5 where point = 1 and replication = 0 and paradigm = 1')" \
  "$work/foreign/results.sqlite"
expect 2 'runs = 1/5/0: must be a run of this experiment' experiment "$file" --out "$work/foreign" --resume
sed 's/replications: 20/replications: 4/' "$file" >"$work/few.yaml"
echo "expect: [{measure: age_fused, less: adva, than: tt}, {measure: age_fused, less: tt, than: adva}]" >>"$work/few.yaml"
expect 1 'than of adva: does not hold$' experiment "$work/few.yaml" --out "$work/few"
echo "surplus: 1" >>"$work/few.yaml"
expect 2 'few.yaml:14: surplus' experiment "$work/few.yaml" --out "$work/never"
[[ -e $work/never ]] && fail "a broken file leaves a folder behind"

# ---- the values of an axis, and an interaction
small_sweep 4 "700 ms" "400 ms" | sed 's/age_fused]/track_lost]/' >"$work/lost.yaml"
expect 0 'An object lost its track in [0-8] of 8 drives of adva' experiment "$work/lost.yaml" --out "$work/lost"
python3 - "$work/lost" <<'END' || fail "answer.json does not count the lost tracks of runs.csv"
import csv, json, sys
lost = json.load(open(f"{sys.argv[1]}/answer.json"))["lost_tracks"]
rows = list(csv.DictReader(open(f"{sys.argv[1]}/runs.csv")))
for name in ("adva", "tt"):
    of = [float(row["track_lost"]) for row in rows if row["paradigm"] == name]
    assert lost["paradigms"][name] == {"drives": 8, "lost": int(sum(of))} and len(of) == 8, lost
left_out = {(row["point"], row["replication"]) for row in rows if float(row["track_lost"]) > 0}
assert lost["replications"] == len(left_out), lost
END
small_sweep 4 "700 ms" "400 ms" >"$work/compare.yaml"
cat >>"$work/compare.yaml" <<END
compare: {axis: noise, baseline: 1}
interactions: [{axis: noise, lowers: tt, more_than: adva}]
END
expect 0 '^(Yes|No|No, it only raises tt less|There is no difference that these drives can tell): noise from 1 to 40 ' \
  experiment "$work/compare.yaml" --out "$work/compare"
python3 - "$work/compare/answer.json" <<'END' || fail "answer.json does not have the comparison"
import json, sys
answer = json.load(open(sys.argv[1]))
assert answer["compared_axis"] == "noise" and answer["baseline"] == "1" and answer["comparisons"] == 2
cells = [point["paradigms"]["tt"]["position_rmse_truth"] for point in answer["points"]]
assert "difference" not in cells[0]
difference = cells[1]["difference"]
assert abs(difference["mean"] - (cells[1]["mean"] - cells[0]["mean"])) < 1e-9
assert abs(difference["percent"]["mean"] - 100 * difference["mean"] / cells[0]["mean"]) < 1e-6
[interaction] = answer["interactions"]
assert [interaction[k] for k in ("measure", "by", "axis", "from", "to", "lowers", "more_than")] == [
    "position_rmse_truth", "ratio", "noise", "1", "40", "tt", "adva"]
[point] = interaction["points"]
first, second, both = (point[k]["percent"]["mean"] for k in ("first", "second", "interaction"))
assert abs((1 + first / 100) / (1 + second / 100) - (1 + both / 100)) < 1e-9
assert point["interaction"]["count"] == 4 and 0 <= point["interaction"]["p"] <= 1
assert answer["answer"].startswith(open(sys.argv[1].replace("json", "txt")).read().split("\n")[2])
END
sed -i 's/lowers: tt/lowers: buff/' "$work/compare.yaml"
expect 2 'compare.yaml:14: interactions\[0\].lowers = buff: must be one of the paradigms: adva, tt$' \
  experiment "$work/compare.yaml" --out "$work/never"

echo "kind: other" >"$work/kind.yaml"
expect 2 'kind = other: must be sweep or fault_campaign' experiment "$work/kind.yaml"
touch "$work/no_folder"
expect 1 'no_folder' experiment "$file" --out "$work/no_folder/results"

[[ $failures -eq 0 ]] && echo "sweeps: as documented"
exit $((failures > 0))
