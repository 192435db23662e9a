#!/usr/bin/env bash
# Opens the report of a drive, of two side by side, of an experiment, of a thousand objects, and one with hostile names, in
# headless Chromium.
#
# page_test.sh PROGRAM SOURCE_DIR WORK_DIR      exit 77: skipped, with the reason
#
# Screenshots stay in WORK_DIR/pictures.
set -euo pipefail
program=$1 source=$2 work=$3
here=$(cd "$(dirname "$0")" && pwd)

skip() { echo "skipped: $*"; exit 77; }
chromium=$(command -v chromium || command -v chromium-browser) \
  || skip "chromium is not installed (tools/install_deps.sh --gates)"
command -v node >/dev/null || skip "node is not installed"
command -v npm >/dev/null || skip "npm is not installed"

mkdir -p "$work"
cp "$here/package.json" "$here/package-lock.json" "$here/.npmrc" "$here"/{layout,page,scene,timing}_check.mjs "$work/"
if ! cmp -s "$work/package-lock.json" "$work/fetched.json"; then
  (cd "$work" && timeout 120 npm ci --no-progress >npm.log 2>&1) || {
    rm -rf "$work/node_modules"
    skip "npm ci could not fetch playwright-core within 120 s (no network?)"
  }
  cp "$work/package-lock.json" "$work/fetched.json"
fi

cd "$work"
rm -rf runs pictures
for seed in 1 2; do
  "$program" run "$source/scenarios/paper_scenario1.yaml" --seed "$seed" --no-pictures --out "runs/seed$seed" \
    >/dev/null 2>&1
done
cat >small.yaml <<END
kind: sweep
name: small
question: Is it so?
scenario: $source/scenarios/dynamics.yaml
seed: 3
replications: 6
paradigms:
  adva: {strategy: adva, set: {duration: 700 ms, evaluate_from: 400 ms}}
  tt: {strategy: tt, set: {duration: 700 ms, evaluate_from: 400 ms}}
axes:
  noise: {keys: [world.acceleration_noise], values: [1, 10, 40]}
measures: [position_rmse_truth, age_fused]
END
"$program" experiment small.yaml --out runs/small >/dev/null 2>&1
# Names are arbitrary text.
mkdir -p runs/hostile
python3 - runs/seed1/summary.json runs/hostile/summary.json <<'END'
import json, sys
summary = json.load(open(sys.argv[1]))
hostile = '"><img src=x onerror="broken=1"></script><script>broken=1</script><!--'
summary["scenario"] = hostile
for one in summary["strategies"]:
    one["strategy"] += hostile
    one["log"] = one["log"].split("/")[-1]
json.dump(summary, open(sys.argv[2], "w"))
END
cp runs/seed1/*.mcap runs/hostile/

"$program" run "$source/scenarios/thousand.yaml" --strategy tt --no-pictures --out runs/many >/dev/null 2>&1

"$program" report runs/seed1 -o run.html
"$program" report runs/seed1 runs/seed2 -o compared.html
"$program" report runs/small -o experiment.html
"$program" report runs/hostile -o hostile.html
"$program" report runs/many -o many.html
# A scene is at most a megabyte.
[[ $(stat -c %s many.html) -lt 1500000 ]] || { echo "FAILED: many.html is larger than 1.5 MB"; exit 1; }
# For a drive of 3 s; each further timing diagram is half a megabyte.
[[ $(stat -c %s run.html) -lt 3000000 ]] || { echo "FAILED: run.html is larger than 3 MB"; exit 1; }
timeout 300 node page_check.mjs "$chromium" pictures run=run.html compared=compared.html experiment=experiment.html \
  hostile=hostile.html many=many.html
echo "screenshots: $work/pictures"
