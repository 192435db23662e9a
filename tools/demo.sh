#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 and runs both of the paper's drives with all three strategies. Says first what 20
# seeds of each can decide, then prints a comparison table of one seed. Leaves pictures, logs, an index page and reports in
# out/demo, or in the folder given.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-out/demo}
tools/install_deps.sh
echo "building (a few minutes the first time) ..."
tools/build.sh release --target ttfusion
mkdir -p "$out"
build/release/ttfusion run scenarios/paper_scenario1.yaml scenarios/paper_scenario2.yaml --out "$out" >"$out/drives.txt"
# One drive is one draw: more seeds, without logs.
rm -rf "$out/seeds"
build/release/ttfusion experiment experiments/paper_drives.yaml --out "$out/seeds" >"$out/paper_drives.txt"
build/release/ttfusion report "$out/seeds" --no-drives -o "$out/seeds.html"
{
  tools/seeds_sentence.py "$out/seeds/answer.json"
  echo
  echo "Seed 1 alone, which the pictures show:"
  cat "$out/drives.txt"
} >"$out/comparison.txt"
{
  cat <<'HTML'
<!doctype html><html lang="en"><meta charset="utf-8"><title>ttfusion: the paper's drives</title>
<body style="font-family: sans-serif; max-width: 80em; margin: 2em auto">
<h1>The paper's drives</h1>
<ul>
<li><a href="paper_scenario1/index.html">Scenario 1: a car ahead accelerates</a></li>
<li><a href="paper_scenario2/index.html">Scenario 2: a car approaches and turns</a></li>
<li><a href="report.html">Report of both, with plots and timing diagrams to zoom into</a></li>
<li><a href="seeds.html">Report of 20 seeds of each, with cars of drawn sizes</a></li>
</ul>
<pre>
HTML
  cat "$out/comparison.txt"
  echo "</pre></body></html>"
} >"$out/index.html"
echo
cat "$out/comparison.txt"
echo
build/release/ttfusion report "$out/paper_scenario1" "$out/paper_scenario2" -o "$out/report.html"
echo "pictures, logs and tables: $out/index.html"
echo "report of both drives:     $out/report.html"
echo "report of 20 seeds:        $out/seeds.html"
