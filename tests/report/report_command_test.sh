#!/usr/bin/env bash
# `ttfusion report`: of a run, of logs alone, of several runs, of an experiment; and refused input.
#   report_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$source/tests/cli/expect.sh"
source "$source/tests/cli/small_sweep.sh"
cd "$work" || exit 1

# has: the page contains it. lacks: the page does not.
has() { grep -Fq -- "$2" "$1" || fail "$1 does not have '$2'"; }
lacks() { ! grep -Eq -- "$2" "$1" || fail "$1 has '$2'"; }

for seed in 1 2 3; do
  expect 0 'wrote' run "$source/scenarios/paper_scenario1.yaml" --seed $seed --no-pictures --out "seed$seed"
done
expect 0 'wrote run.html: [0-9.]+ MB' report seed1 -o run.html
has run.html 'A car ahead accelerates along the sensor vehicle'
# The first sentence has the summary's errors, to three digits.
errors=$(python3 - <<'END'
import json, math
reported = {s["strategy"]: s["rmse_truth"]["position_m"] for s in json.load(open("seed1/summary.json"))["strategies"]}
text = {name: f"{error:.{2 - math.floor(math.log10(error))}f}" for name, error in reported.items()}
print(f"buff is off by {text['buff']} m in position, adva by {text['adva']} m, tt by {text['tt']} m")
END
)
has run.html "In this one drive $errors"
has run.html 'One drive is one draw of the noise'
has run.html "ttfusion run scenarios/paper_scenario1.yaml --strategy tt --seed 1"
has run.html \
  "$(python3 -c 'import json; print(json.load(open("seed1/summary.json"))["strategies"][2]["content_hash"])')"
lacks run.html 'seed 1 --duration'
expect 0 '' run "$source/scenarios/paper_scenario1.yaml" --strategy tt --duration 2 --no-pictures --out short
expect 0 '' report short -o short.html
has short.html "ttfusion run scenarios/paper_scenario1.yaml --strategy tt --seed 1 --duration 2"
# Each drive is there from above, with the fields of its scenario's sensors, and every image of its log.
python3 - <<'END' || fail "the scenes of the page are not those of the logs"
import base64, json, re
page = open("run.html", encoding="utf-8").read()
scenes = json.loads(re.search(r'<script type="application/json" id="scenes">(.*?)</script>', page, re.S)[1])
reported = json.load(open("seed1/summary.json"))["strategies"]
assert [s["label"] for s in scenes] == [s["strategy"] for s in reported]
for scene in scenes:
    assert scene["note"] == "" and [s["name"] for s in scene["sensors"]] == ["laser", "camera"]
    assert all(len(s["edge"]) > 30 for s in scene["sensors"])
    assert len(base64.b64decode(scene["images"]["at"])) == 8 * (75 + 1)   # and the end of the last one
END
# The timing diagrams go over the whole drive, as a reader of the page unpacks them.
python3 - <<'END' || fail "the timing diagrams of the page do not go over the whole drive"
import base64, json, re, zlib
page = open("run.html", encoding="utf-8").read()
timings = json.loads(re.search(r'<script type="application/json" id="timings">(.*?)</script>', page, re.S)[1])
assert len(timings) == 3
for one in timings:
    windows = one["windows"]
    assert windows[0][0] == 0 and windows[-1][1] >= 3000 and [1500, 1660] in windows
    assert all(a[1] == b[0] for a, b in zip(windows, windows[1:]))
    chunks = [json.loads(zlib.decompress(base64.b64decode(chunk))) for chunk in one["chunks"]]
    assert [len(chunk["order"]) for chunk in chunks] == [min(6, len(windows) - at) for at in range(0, len(windows), 6)]
    assert all(len(order) > 100 for chunk in chunks for order in chunk["order"])
END
# Ages were within the bounds of the schedule, stage by stage.
has run.html 'was within the bounds of the schedule'
[[ $(grep -c 'stage by stage</summary>' run.html) == 2 ]] || fail "not both sensors have their stages"
# The page loads no other files.
lacks run.html '(src|href)="(https?:)?//|@import|url\(["'"'"']?http'
# The same folder makes the same page.
expect 0 '' report seed1 -o again.html
cmp run.html again.html || fail "the same folder makes another page"
# The curves are the run's: their root mean square from the start of judgement is the summary's figure.
python3 - <<'END' || fail "the position errors of the page are not those of summary.json"
import json, math, re, sys
page = open("run.html", encoding="utf-8").read()
plots = json.loads(re.search(r'<script type="application/json" id="plots">(.*?)</script>', page, re.S)[1])
curves = next(plot for plot in plots if plot["heading"] == "Error over time")["views"][0]["curves"]
summary = json.load(open("seed1/summary.json"))["strategies"]
assert [c["label"] for c in curves] == [s["strategy"] for s in summary]
for curve, reported in zip(curves, summary):
    judged = [y for x, y in zip(curve["x"], curve["y"]) if x >= 1.501]
    rmse = math.sqrt(sum(y * y for y in judged) / len(judged))
    if len(judged) != reported["objects"]["compared"] or abs(rmse - reported["rmse_truth"]["position_m"]) > 1e-5:
        sys.exit(f"{curve['label']}: {len(judged)} {rmse}, {reported['rmse_truth']}")
END

# ---- several runs: paired intervals over their seeds
expect 0 'wrote' report seed1 seed2 seed3 -o runs.html
has runs.html '3 runs of paper_scenario1'
has runs.html 'means of 3 runs, 95 % intervals'
has runs.html 'The first 6 of 9 drives are drawn.'

# ---- two scenarios: an answer each
expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --no-pictures --out other
expect 0 'wrote' report seed1 other -o scenarios.html
has scenarios.html "paper_scenario1: In this one drive $errors"
has scenarios.html 'paper_scenario2: In this one drive buff is off by'
lacks scenarios.html 'has the smallest'

# ---- logs alone, and a run without logs
mkdir logs
cp seed1/tt.mcap logs/
expect 0 'wrote' report logs -o logs.html
has logs.html 'There is no summary.json'
expect 0 '' run "$source/scenarios/paper_scenario1.yaml" --strategy tt --no-log --out without
expect 0 'wrote' report without -o without.html
has without.html 'tt kept no log'
has without.html 'There is no log: slot problems and missed deadlines are in the table above only'
for heading in 'The drive from above' 'Errors and ages' 'Positions' 'How to repeat it' 'No fault was injected'; do
  lacks without.html "$heading"
done
expect 0 'wrote' report seed1 without -o some.html
has some.html 'There is no log of without tt: slot problems'
has some.html 'no deadline was missed in the logs.'

# ---- faults, and another window
expect 0 '' run "$source/scenarios/faulty_bus.yaml" --strategy tt --no-pictures --out faulty
expect 0 'wrote' report faulty --from 0.5 --to 0.52 -o faulty.html
has faulty.html 'is drawn, first 20 ms from 0.5 s on'
has faulty.html 'byzantine_clock'

# An end before the drive is judged (1.5 s): the window is before it.
expect 0 'wrote' report seed1 --to 1 -o before.html
has before.html 'is drawn, first 160 ms from 0.84 s on'
expect 0 'wrote' report seed1 --to 0.1 -o first.html
has first.html 'is drawn, first 100 ms from 0 s on'

# ---- an experiment
small_sweep 4 "700 ms" "400 ms" | sed 's/^question: .*/question: Is it <so>?/' >small.yaml
expect 0 'wrote' experiment small.yaml --out small
expect 0 'wrote' report small -o small.html
has small.html 'Is it &lt;so&gt;?'
grep -Eq 'For certain .* has the smallest position_rmse_truth at|cannot tell which paradigm has the smallest' small.html ||
  fail "small.html has no answer"
has small.html 'root mean square of the position error against the truth'
has small.html 'ttfusion experiment small.yaml --replay 0/adva/0 --out one'
# A run of each paradigm is driven again, with the draws of the first replication that all of them have done.
mkdir scratch
export TMPDIR=$PWD/scratch
expect 0 '^small: 2 runs of point 0, replication 0, again' report small -o small.html
has small.html 'The runs of point 0 (noise 1), replication 0, driven again'
has small.html 'is drawn, first 160 ms from 0.4 s on'
for words in '"note":""' 'data-label="adva"' 'data-label="tt"' 'Ages of measurements' '"heading":"Precision"' \
  'No fault was injected, no slot had a problem'; do
  has small.html "$words"
done
expect 0 'wrote' report small -o small_again.html
cmp small.html small_again.html || fail "the same experiment makes another page"
[[ -z $(ls -A scratch) ]] || fail "the runs that were driven again are left behind"
unset TMPDIR
# Its curves are those of the run's own page.
expect 0 'wrote tt' experiment small.yaml --replay 0/tt/0 --out tt
expect 0 'wrote' report tt -o tt.html
python3 - <<'END' || fail "the curves in the experiment's page are not those of the run"
import json, re
def views(name):
    plots = json.loads(re.search(r'id="plots">(.*?)</script>', open(name, encoding="utf-8").read(), re.S)[1])
    return {(plot["heading"], view["label"]): view["curves"] for plot in plots for view in plot["views"]}
of_all, alone = views("small.html"), views("tt.html")
for key in [("Age over time", "newest of the sensors"), ("Error over time", "position"), ("Precision", "precision")]:
    curve = next(c for c in of_all[key] if c["label"] == "tt")
    assert curve["x"] and [curve["x"], curve["y"]] == [alone[key][0]["x"], alone[key][0]["y"]], key
END
expect 0 'wrote' report small --point 1 --from 0.5 --to 0.52 -o point.html
has point.html 'The runs of point 1 (noise 40), replication 0'
has point.html 'is drawn, first 20 ms from 0.5 s on'
expect 0 'wrote' report small --no-drives -o none.html
lacks none.html 'One drive of each paradigm|class="diagram"|id="scenes"'

# ---- a changed experiment is not driven again as if it were the same, and the page reports it
mkdir changed away
sed 's/^replications: .*/replications: 5/' small.yaml >changed/small.yaml
(cd changed && "$program" report ../small -o page.html >/dev/null 2>said) || fail "no page where the file is another"
grep -q '^warning: No drive is shown here: small.yaml, or a file that it names, has changed' changed/said ||
  fail "another file is not named: $(cat changed/said)"
has changed/page.html 'No drive is shown here: small.yaml, or a file that it names, has changed'
lacks changed/page.html 'class="diagram"'
(cd away && "$program" report ../small -o page.html >/dev/null 2>&1) || fail "no page where there is no file"
has away/page.html 'No drive is shown here: the experiment cannot be driven again (small.yaml'
(cd away && "$program" report ../small --file ../small.yaml -o page.html >/dev/null 2>&1) || fail "--file is not taken"
has away/page.html 'class="diagram"'
expect 2 '^error: command line: --file = changed/small.yaml: cannot be driven again: ' \
  report small --file changed/small.yaml -o x.html
expect 2 '^error: nowhere.yaml: ' report small --file nowhere.yaml -o x.html
expect 2 '^error: command line: --point = 2: must be a point of small, 0 to 1' report small --point 2 -o x.html
expect 2 '^error: command line: --point: goes with an experiment' report seed1 --point 0 -o x.html
expect 2 '^error: command line: --step-limit: goes with an experiment' report seed1 --step-limit 3 -o x.html
# Figures that differ from the rows': they are not this drive's.
cp -r small forged
cp -r small holes
python3 - <<'END'
import sqlite3
first = "WHERE point = 0 AND replication = 0 AND paradigm = 1"
for name, changes in [("forged", [f"UPDATE runs SET age_fused = age_fused + 1e-9 {first}"]),
                      ("holes", [f"UPDATE runs SET status = 'failed' {first}",
                                 "DELETE FROM runs WHERE point = 0 AND replication = 1 AND paradigm = 0"])]:
    store = sqlite3.connect(f"{name}/results.sqlite")
    for change in changes:
        store.execute(change)
    store.commit()
END
expect 0 'wrote' report forged -o forged.html
has forged.html 'No drive is shown here: tt, driven again, gave other numbers than in results.sqlite.'
# A replication that one of them has not done is passed over.
expect 0 '^small: 2 runs of point 0, replication 2, again' report holes -o holes.html
# The commands it shows work.
expect 0 'wrote one' experiment small.yaml --replay 0/adva/0 --out one
expect 0 'wrote' report one -o one.html
# Drives with different starts of judgement: each timing diagram gives its window.
expect 0 'wrote' report seed1 one -o windows.html
has windows.html 'A window of each drive; the slider'
has windows.html 'data-label="one adva, first 160 ms from 0.4 s on"'
has windows.html 'data-label="seed1 tt, first 160 ms from 1.5 s on"'

# ---- a log that was cut off is read up to there, with a warning
mkdir torn
head -c 300000 seed1/tt.mcap >torn/tt.mcap
expect 0 '^warning: .*cut off at byte 300000' report torn -o torn.html
has torn.html 'cut off at byte 300000'

# ---- refused input, in a sentence each
mkdir nothing
expect 2 '^error: nothing: is neither a run .* nor an experiment' report nothing -o x.html
expect 2 '^error: nowhere: must be a folder of results' report nowhere -o x.html
expect 2 '^error: .*small: must be one experiment, or only runs' report small seed1 -o x.html
expect 2 '^error: .*--out' report seed1
mkdir damaged
head -c 1000 small/answer.json >damaged/answer.json
expect 2 '^error: damaged/answer.json:[0-9]+: must be JSON: it is damaged here, or cut off' report damaged -o x.html
echo '{"experiment": "x", "question": 3}' >damaged/answer.json
expect 2 '^error: damaged/answer.json: question: must be text' report damaged -o x.html
python3 - <<'END'
import json
answer = json.load(open("small/answer.json"))
del answer["points"][1]["paradigms"]["tt"]["age_fused"]["half_width"]
json.dump(answer, open("damaged/answer.json", "w"))
END
expect 2 'answer.json: points\[1\].paradigms.tt.age_fused.half_width.*: is missing' report damaged -o x.html
cp small/answer.json damaged/answer.json
echo nonsense >damaged/results.sqlite
expect 2 '^error: damaged/results.sqlite' report damaged -o x.html
mkdir unreadable
cp seed1/summary.json unreadable/
echo nonsense >unreadable/tt.mcap
cp seed1/adva.mcap seed1/buff.mcap unreadable/
expect 2 '^error: unreadable/tt.mcap: ' report unreadable -o x.html
echo '[]' >unreadable/summary.json
expect 2 '^error: unreadable/summary.json: must be the summary of a run' report unreadable -o x.html
expect 1 '^error: nowhere/x.html: cannot be written: No such file' report seed1 -o nowhere/x.html
[[ ! -e x.html ]] || fail "a page was written all the same"

echo "$failures failures"
[[ $failures -eq 0 ]]
