#!/usr/bin/env bash
# `ttfusion export --format gnuplot`: gnuplot draws every script's picture without a message.
#   gnuplot_export_test.sh PROGRAM SOURCE_DIR      exit 77 without gnuplot
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"
command -v gnuplot >/dev/null || { echo "skipped: no gnuplot"; exit 77; }

# drawn FOLDER: draws every script there, one by one.
drawn() {
  local script name said
  for script in "$1"/*.gp; do
    name=${script%.gp}
    said=$(cd "$1" && gnuplot "$(basename "$script")" 2>&1) || fail "gnuplot $script fails"
    [[ -z $said ]] || fail "gnuplot $script says: $said"
    [[ $(head -c 5 "$name.pdf") == %PDF- && $(stat -c %s "$name.pdf") -gt 4000 ]] || fail "$name.pdf is no picture"
    [[ $(head -c 4 "$name.png" | tail -c 3) == PNG && $(stat -c %s "$name.png") -gt 8000 ]] ||
      fail "$name.png is no picture"
  done
}

# ---- a run with every strategy
"$program" run "$source/scenarios/paper_scenario2.yaml" --out "$work/run" >/dev/null 2>&1 || fail "the run fails"
expect 0 '^wrote .*/figures: 18 files; ' export "$work/run" --format gnuplot -o "$work/figures"
drawn "$work/figures"
for name in tt_positions errors nees ages; do
  [[ -s $work/figures/$name.pdf ]] || fail "no $name.pdf"
done
[[ $(sed -n 's/^image,.*/image/p' "$work/figures/tt_positions.csv" | wc -l) -gt 20 ]] || fail "few positions"
expect 0 '' export "$work/run"/{buff,adva,tt}.mcap --format gnuplot -o "$work/again"
for file in "$work"/again/*; do
  cmp "$file" "$work/figures/$(basename "$file")" || fail "$file is another when its logs are named"
done
head -c $(($(stat -c %s "$work/run/tt.mcap") * 2 / 3)) "$work/run/tt.mcap" >"$work/cut.mcap"
expect 0 'warning: .*cut.mcap' export "$work/cut.mcap" --format gnuplot -o "$work/cut"
drawn "$work/cut"

# ---- sensors look as the scenario says: the right laser is green, and so are its ages
"$program" run "$source/scenarios/two_lasers.yaml" --strategy tt --no-pictures --out "$work/lasers" >/dev/null 2>&1 ||
  fail "the drive with two lasers fails"
expect 0 '' export "$work/lasers/tt.mcap" --format gnuplot -o "$work/lasers_figures"
drawn "$work/lasers_figures"
for look in 'tt_positions left_laser.*pointtype 2 .*#d55e00' 'tt_positions right_laser.*pointtype 1 .*#009e73' \
  'tt_positions camera.*pointtype 8 .*#0072b2' 'ages right_laser.*#009e73'; do
  grep -q "${look#* }" "$work/lasers_figures/${look%% *}.gp" || fail "${look%% *}.gp has no ${look#* }"
done

# ---- an image that is used once
sed -e 's/^duration: .*/duration: 120 ms/' -e 's/^evaluate_from: .*/evaluate_from: 0 ms/' -e "s#\.\./#$source/#" \
  "$source/scenarios/paper_scenario1.yaml" >"$work/once.yaml"
"$program" run "$work/once.yaml" --strategy tt --no-pictures --out "$work/once" >/dev/null 2>&1 ||
  fail "the short run fails"
expect 0 '^wrote .*/once_figures: 8 files; ' export "$work/once" --format gnuplot -o "$work/once_figures"
[[ $(wc -l <"$work/once_figures/tt_errors.csv") -eq 2 ]] || fail "not one use"
drawn "$work/once_figures"

# ---- an experiment with an axis of numbers and one of labels, and one of a single run
experiment() {
  cat <<END
kind: sweep
name: small
question: Is it so?
scenario: $source/scenarios/dynamics.yaml
seed: 3
replications: $1
paradigms:
  adva: {strategy: adva, set: {duration: 600 ms, evaluate_from: 400 ms}}
  tt_ctrl: {strategy: tt, set: {duration: 600 ms, evaluate_from: 400 ms}}
$2
measures: [position_rmse_truth, nees, age_fused, spurious, precision]
END
}
experiment 3 'axes:
  noise: {keys: [world.acceleration_noise], values: [0.5, 5, 50]}
  road: {settings: {dry: {world.yaw_rate_noise: 0.05, world.own_speed: 0}, icy: {world.yaw_rate_noise: 0.2, world.own_speed: 0}}}' >"$work/small.yaml"
experiment 1 'axes:
  noise: {keys: [world.acceleration_noise], values: [2]}' >"$work/single.yaml"
for name in small single; do
  "$program" experiment "$work/$name.yaml" --out "$work/$name" >/dev/null 2>&1 || fail "the experiment $name fails"
  expect 0 '"files": \["position_rmse_truth.csv", "position_rmse_truth.gp"' \
    export "$work/$name" --format gnuplot --json -o "$work/${name}_figures"
  drawn "$work/${name}_figures"
done
[[ $(wc -l <"$work/small_figures/position_rmse_truth.csv") -eq 7 ]] || fail "not six points"

# ---- refused input
head -c 20000 "$work/run/tt.mcap" >"$work/begun.mcap"
expect 2 'begun.mcap: has no position, no use of an image' export "$work/begun.mcap" --format gnuplot \
  -o "$work/none"
mkdir "$work/empty"
expect 2 'empty: holds neither logs' export "$work/empty" --format gnuplot -o "$work/none"
expect 2 "small: must be alone" export "$work/small" "$work/run/tt.mcap" --format gnuplot -o "$work/none"
expect 2 'absent: cannot be read' export "$work/absent" --format gnuplot -o "$work/none"
[[ ! -e $work/none ]] || fail "what is refused leaves a folder"
: >"$work/file"
expect 1 'file/x: cannot be created' export "$work/run/tt.mcap" --format gnuplot -o "$work/file/x"
echo 'point,what' >"$work/empty/summary.csv"
expect 2 'summary.csv:1: must be the summary.csv of an experiment' export "$work/empty" --format gnuplot -o "$work/none"

[[ $failures -eq 0 ]] && echo "pictures for papers: as documented"
exit $((failures > 0))
