#!/usr/bin/env bash
# An experiment on several ranks of mpirun: the rows of one process alone; a rank that dies; refusals,
# reported once.
#   ranks_test.sh PROGRAM SOURCE_DIR        exit code 77 without mpirun
set -u
program=$1
source=$2
command -v mpirun >/dev/null || { echo "skipped: no mpirun (Debian: openmpi-bin)"; exit 77; }
source "$(dirname "$0")/expect.sh"
source "$(dirname "$0")/small_sweep.sh"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1

small_sweep 200 "2 s" "300 ms" >"$work/small.yaml"
file=$work/small.yaml
expect 0 '' experiment "$file" --out "$work/alone"

alone=$program
program=mpirun
for ranks in 2 3; do
  expect 0 "small: 2 points, 2 paradigms, 200 replications, $ranks ranks" \
    -n $ranks "$alone" experiment "$file" --out "$work/ranks$ranks"
  for name in runs.csv summary.csv answer.txt answer.json; do
    cmp "$work/alone/$name" "$work/ranks$ranks/$name" || fail "$name of $ranks ranks is another"
  done
done

small_sweep 4 "700 ms" "400 ms" >"$work/seeded.yaml"
program=$alone
expect 0 '' experiment "$work/seeded.yaml" --seed 4 --out "$work/seed_alone"
program=mpirun
expect 0 '' -n 2 "$alone" experiment "$work/seeded.yaml" --seed 4 --out "$work/seed_ranks"
cmp "$work/seed_alone/runs.csv" "$work/seed_ranks/runs.csv" || fail "--seed on ranks drives other runs"

# ---- a rank that dies ends them all; earlier rows stay, and the rest is driven
mpirun -n 3 "$alone" experiment "$file" --out "$work/killed" >"$work/words" 2>&1 &
all=$!
for _ in $(seq 400); do
  rows=$(python3 -c "import sqlite3, sys
try: print(sqlite3.connect('file:' + sys.argv[1] + '?mode=ro', uri=True).execute('select count(*) from runs').fetchone()[0])
except sqlite3.Error: print(0)" "$work/killed/results.sqlite")
  [[ $rows -ge 10 ]] && break
  sleep 0.02
done
for rank in $(pgrep -P "$all"); do
  if grep -zqx OMPI_COMM_WORLD_RANK=2 "/proc/$rank/environ" 2>/dev/null; then victim=$rank; fi
done
kill -9 "${victim:?no rank 2}" || fail "rank 2 was done before it could be killed"
wait "$all" && fail "a rank that died leaves exit code 0"
expect 0 '' -n 2 "$alone" experiment "$file" --out "$work/killed" --resume
cmp "$work/alone/runs.csv" "$work/killed/runs.csv" || fail "after a rank's death and --resume there are other rows"

# ---- one rank reports a refusal
refused() {
  local pattern=$1 words code
  shift
  words=$(mpirun -n 3 "$alone" experiment "$@" 2>&1)
  code=$?
  [[ $code -eq 2 ]] || fail "$* exits with $code, not 2: $words"
  [[ $(grep -c '^error: ' <<<"$words") -eq 1 ]] || fail "$* is not refused in one sentence: $words"
  grep -Eq -- "$pattern" <<<"$words" || fail "$* does not say '$pattern': $words"
}
refused 'small.yaml: cannot be' "$work/none/small.yaml"
refused '--jobs.*: must not be given under mpirun' "$file" --jobs 2 --out "$work/never"
refused 'results.sqlite: exists already' "$file" --out "$work/alone"
refused 'kind = fault_campaign: must be sweep under mpirun' \
  "$source/experiments/fault_campaign.yaml" --out "$work/never"
[[ -e $work/never ]] && fail "what is refused leaves a folder behind"
[[ $failures -eq 0 ]] && echo "ranks: all as it must be"
exit "$((failures > 0))"
