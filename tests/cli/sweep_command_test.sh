#!/usr/bin/env bash
# `ttfusion experiment` of a sweep: killed and resumed, in shards, one run again, and refused input.
#   sweep_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/small_sweep.sh"

small_sweep 40 "700 ms" "400 ms" >"$work/small.yaml"
file=$work/small.yaml

expect 0 'position_rmse_truth of tt is less than that of adva at|no difference of position_rmse_truth between tt and adva' experiment "$file" --out "$work/whole"
[[ $(cd "$work/whole" && echo *) == "answer.json answer.txt results.sqlite runs.csv summary.csv" ]] ||
  fail "other files: $(cd "$work/whole" && echo *)"
[[ -s $work/whole/answer.json && -s $work/whole/summary.csv ]] || fail "an empty file"
[[ $(wc -l <"$work/whole/runs.csv") -eq 161 ]] || fail "not 160 runs: $(wc -l <"$work/whole/runs.csv")"
expect 2 'results.sqlite: exists already: --resume continues it' experiment "$file" --out "$work/whole"

# ---- killed before there was a store: the options are lost, and --resume says so
expect 2 '--resume: needs .*/not_begun/results.sqlite, which is not there: begin without --resume, with all other' \
  experiment "$file" --out "$work/not_begun" --resume
[[ -e $work/not_begun ]] && fail "what is refused leaves a folder behind"

# ---- killed twice at any point, and resumed with the same result; long enough to be killed, since finished
# runs are written twice a second
small_sweep 200 "2 s" "400 ms" >"$work/long.yaml"
expect 0 '' experiment "$work/long.yaml" --out "$work/undisturbed"
for round in 1 2; do
  resume=()
  [[ $round -eq 1 ]] || resume=(--resume)
  "$program" experiment "$work/long.yaml" --out "$work/killed" --jobs 2 "${resume[@]}" >/dev/null 2>&1 &
  victim=$!
  for _ in $(seq 200); do
    rows=$(python3 -c "import sqlite3, sys
try: print(sqlite3.connect('file:' + sys.argv[1] + '?mode=ro', uri=True).execute('select count(*) from runs').fetchone()[0])
except sqlite3.Error: print(0)" "$work/killed/results.sqlite")
    [[ $rows -ge $((round * 20)) ]] && break
    sleep 0.05
  done
  kill -9 "$victim" 2>/dev/null || fail "round $round: it was done before it could be killed"
  wait "$victim" 2>/dev/null
done
expect 0 '^wrote ' experiment "$work/long.yaml" --out "$work/killed" --resume
for name in runs.csv summary.csv answer.txt answer.json; do
  cmp "$work/undisturbed/$name" "$work/killed/$name" || fail "$name of a run that was killed twice is another"
done

[[ $(cd "$work/killed" && echo results.sqlite*) == results.sqlite ]] || fail "a finished store has files beside it"

# ---- a reader that does not let go
"$program" experiment "$work/long.yaml" --out "$work/read" >"$work/words" 2>&1 &
sweep=$!
python3 - "$work/read/results.sqlite" "$sweep" <<'END' || fail "the store cannot be read while it is written"
import sqlite3, sys, time
path, sweep = sys.argv[1:]
def is_there():  # and no zombie
    try: return open(f"/proc/{sweep}/stat").read().split()[2] != "Z"
    except OSError: return False
rows = 0
while rows == 0 and is_there():
    try:
        reader = sqlite3.connect(f"file:{path}?mode=ro", uri=True).cursor()
        rows = reader.execute("select count(*) from runs").fetchone()[0]
    except sqlite3.Error:
        time.sleep(0.01)
reader.execute("select * from runs")
row = reader.fetchone()
while is_there(): time.sleep(0.05)
sys.exit(row is None)
END
wait "$sweep" || fail "a reader ends the sweep: $(cat "$work/words")"
cmp "$work/undisturbed/runs.csv" "$work/read/runs.csv" || fail "the rows of a store that was read are others"

# ---- in two shards
expect 0 '' experiment "$file" --shard 1/2 --out "$work/first"
expect 0 '' experiment "$file" --shard 2/2 --out "$work/second"
expect 0 '' experiment "$file" --merge "$work/second" "$work/first" --out "$work/both"
cmp "$work/whole/runs.csv" "$work/both/runs.csv" || fail "two shards put together are not the whole"

# ---- fewer for a quick look, and the missing ones later; in shards, too
expect 0 '' experiment "$file" --replications 10 --out "$work/quick"
[[ $(wc -l <"$work/quick/runs.csv") -eq 41 ]] || fail "10 replications are not 40 runs"
cp "$work/quick/runs.csv" "$work/ten.csv"
expect 0 '10 replications' experiment "$file" --out "$work/quick" --resume
cmp "$work/ten.csv" "$work/quick/runs.csv" || fail "going on forgets how many were asked for"
expect 2 '--replications = 9: must be at least 10, as in .*quick/results.sqlite' \
  experiment "$file" --out "$work/quick" --resume --replications 9
expect 0 '' experiment "$file" --out "$work/quick" --resume --replications 40
for name in runs.csv summary.csv answer.txt answer.json; do
  cmp "$work/whole/$name" "$work/quick/$name" || fail "$name of 10 replications and the rest is another"
done
expect 0 '' experiment "$file" --shard 1/2 --replications 10 --out "$work/ten_first"
expect 0 '' experiment "$file" --shard 2/2 --replications 10 --out "$work/ten_second"
expect 0 '' experiment "$file" --merge "$work/ten_first" "$work/ten_second" --out "$work/ten"
cmp "$work/ten.csv" "$work/ten/runs.csv" || fail "two shards of 10 replications put together are others"
expect 1 '20 of 60 runs are missing' \
  experiment "$file" --merge "$work/ten_first" "$work/ten_second" --replications 15 --out "$work/fifteen"
expect 2 'must be at least 10' experiment "$file" --merge "$work/ten_first" --replications 5 --out "$work/never"
expect 2 '--replications = 10000000: must make at most 100000000 drives' \
  experiment "$source/experiments/process_noise.yaml" --replications 10000000 --out "$work/never"
expect 2 '--replications = 5: is for sweeps' experiment "$source/experiments/fault_campaign.yaml" --replications 5
expect 0 'noise 40, tt, replication 40: done' experiment "$file" --replay 1/tt/40 --replications 41
expect 2 'replications 0..39' experiment "$file" --replay 1/tt/40
[[ -e $work/never ]] && fail "a count that cannot be leaves a folder behind"

# ---- one run again is the row
expect 0 'noise 40, tt, replication 7: done' experiment "$file" --replay 1/tt/7 --out "$work/one"
value=$("$program" experiment "$file" --replay 1/tt/7 | awk '$1 == "position_rmse_truth" {print $2}')
grep -q "^1,40,7,tt,done,$value," "$work/whole/runs.csv" || fail "the run that is driven again is another: $value"
expect 0 '' diagram "$work/one/tt.mcap" --from 0.5 --to 0.55 -o "$work/one.svg"
expect 2 '--replay = 1/tt: must be point/paradigm/replication, of points 0..1 and replications 0..39' \
  experiment "$file" --replay 1/tt
expect 2 'must be point/paradigm/replication' experiment "$file" --replay 2/tt/0
expect 2 'must be point/paradigm/replication' experiment "$file" --replay 1/buff/0

# ---- refused input, and unexpected results
sed 's/seed: 3/seed: 4/' "$file" >"$work/other.yaml"
expect 2 'must belong to this experiment: the file, a file that it names or the program has changed' \
  experiment "$work/other.yaml" --out "$work/whole" --resume
expect 2 'must belong to this experiment' experiment "$work/other.yaml" --merge "$work/first" --out "$work/none"
expect 2 'none/results.sqlite: cannot be opened' experiment "$file" --merge "$work/first" "$work/none" \
  --out "$work/none"
expect 2 '--shard = 3/2' experiment "$file" --shard 3/2 --out "$work/none"
[[ -e $work/none ]] && fail "what is refused leaves a folder behind"
expect 1 '80 of 160 runs are missing: --resume drives them' experiment "$file" --merge "$work/first" \
  --out "$work/half"
expect 0 '' experiment "$file" --out "$work/half" --resume
cmp "$work/whole/runs.csv" "$work/half/runs.csv" || fail "a shard and the rest are not the whole"
cp -r "$work/first" "$work/foreign"
python3 -c "import sqlite3, sys
with sqlite3.connect(sys.argv[1]) as store: store.execute('update runs set paradigm = 5 where point = 1 and replication = 0 and paradigm = 1')" \
  "$work/foreign/results.sqlite"
expect 2 'runs = 1/5/0: must be a run of this experiment' experiment "$file" --out "$work/foreign" --resume
sed 's/replications: 40/replications: 4/' "$file" >"$work/few.yaml"
echo "expect: [{measure: age_fused, less: adva, than: tt}, {measure: age_fused, less: tt, than: adva}]" >>"$work/few.yaml"
expect 1 'than of adva: does not hold$' experiment "$work/few.yaml" --out "$work/few"
echo "surplus: 1" >>"$work/few.yaml"
expect 2 'few.yaml:14: surplus' experiment "$work/few.yaml" --out "$work/never"
[[ -e $work/never ]] && fail "a broken file leaves a folder behind"

# ---- the values of an axis, and an interaction
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
