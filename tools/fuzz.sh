#!/usr/bin/env bash
# Builds the fuzz targets (clang, libFuzzer, AddressSanitizer, UndefinedBehaviorSanitizer: the preset asan-ubsan) and runs
# each for a while, two at a time. Exits with 1 if one of them finds something; the input is then in build/fuzz/findings.
#   tools/fuzz.sh [--changed] [--keep] [SECONDS_PER_TARGET] [TARGET...]   default: 20 s of every target (tests/fuzz/*_fuzz.cc)
# --changed: only the targets that are touched (tools/touched.py) by the changes since the long checks last passed `fuzz`.
# A run begins with the seeds, the inputs that earlier runs found (build/fuzz/corpus), and the kept corpus
# (tests/fuzz/corpus, an archive per target). --keep writes the kept corpus anew: the fewest inputs that reach the same code.
set -euo pipefail
cd "$(dirname "$0")/.."
since=
if [[ ${1:-} == --changed ]]; then
  since=$(tools/last_passed.sh fuzz)
  shift
fi
keep=0
if [[ ${1:-} == --keep ]]; then
  keep=1
  shift
fi
seconds=20
if [[ ${1:-} =~ ^[0-9]+$ ]]; then
  seconds=$1
  shift
fi
targets=("$@")
if [[ ${#targets[@]} -eq 0 ]]; then
  for file in tests/fuzz/*_fuzz.cc; do targets+=("$(basename "$file" _fuzz.cc)"); done
fi
tools/install_deps.sh --gates
if [[ -n $since ]]; then
  tools/build.sh asan-ubsan --target help >/dev/null   # configured, nothing built
  mapfile -t targets < <(tools/touched.py build/asan-ubsan "$since" "${targets[@]/#/fuzz_}" | sed 's/^fuzz_//')
  [[ ${#targets[@]} -gt 0 ]] || { echo "fuzz: nothing of the targets has changed since $since"; exit 0; }
fi
tools/build.sh asan-ubsan --target fuzz

programs=$PWD/build/asan-ubsan/tests/fuzz
build=$PWD/build/fuzz
findings=$build/findings
kept=$PWD/tests/fuzz/corpus
seeds=$build/seeds
mkdir -p "$findings" "$build/fuzz-logs"
"$programs/fuzz_seeds" "$seeds"

# Text gets room for a whole shipped file. Other inputs stay small, which keeps a run fast.
max_length() {
  case $1 in
    *_text) echo 20000 ;;
    log | capture | store) echo 16000 ;;
    *) echo 4000 ;;
  esac
}

run() {
  local target=$1 corpus=$build/corpus/$1 log=$build/fuzz-logs/$1.log program=$programs/fuzz_$1 dictionary=()
  mkdir -p "$corpus"
  [[ -f $seeds/$target.dict ]] && dictionary=("-dict=$seeds/$target.dict")
  [[ -f $kept/$target.tar.gz ]] && tar -xzf "$kept/$target.tar.gz" -C "$corpus"
  local inputs=("$corpus" "$seeds/$target") found=$findings/$target
  [[ -d tests/fuzz/regressions/$target ]] && inputs+=("tests/fuzz/regressions/$target")
  mkdir -p "$found"
  if "$program" "${inputs[@]}" "${dictionary[@]}" -max_total_time="$seconds" -timeout=10 \
    -rss_limit_mb=3000 -max_len="$(max_length "$target")" -print_final_stats=1 \
    -artifact_prefix="$found/" >"$log" 2>&1; then
    printf '%-16s %s\n' "$target" "$(grep -h 'Done ' "$log" | tail -1)"
  else
    printf '%-16s FOUND SOMETHING (%s)\n' "$target" "$log"
    grep -hE 'check failed|runtime error|^SUMMARY|ERROR: libFuzzer' "$log" | head -5 || true
    local input
    for input in $(sed -n 's/.*Test unit written to //p' "$log"); do echo "  again: $program $input"; done
    return 1
  fi
  [[ $keep -eq 0 ]] || pack "$target"
}

# Makes archives reproducible: the same inputs give the same bytes.
pack() {
  local target=$1 program=$programs/fuzz_$1 small=$build/corpus-small/$1
  rm -rf "$small"
  mkdir -p "$small" "$kept"
  "$program" -merge=1 -rss_limit_mb=3000 -max_len="$(max_length "$target")" "$small" "$build/corpus/$target" \
    >>"$build/fuzz-logs/$target.log" 2>&1
  (cd "$small" && LC_ALL=C ls | tar --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 -T - -cf -) |
    gzip -9n >"$kept/$target.tar.gz"
  printf '%-16s kept %s inputs, %s bytes\n' "$target" "$(ls "$small" | wc -l)" "$(stat -c %s "$kept/$target.tar.gz")"
}

failed=0
running=0
for target in "${targets[@]}"; do
  if [[ $running -ge 2 ]]; then
    wait -n || failed=1
    running=$((running - 1))
  fi
  run "$target" &
  running=$((running + 1))
done
while [[ $running -gt 0 ]]; do
  wait -n || failed=1
  running=$((running - 1))
done
[[ $failed -eq 0 ]] || echo "inputs that broke something: $findings" >&2
exit $failed
