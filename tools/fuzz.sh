#!/usr/bin/env bash
# Builds the fuzz targets (clang, libFuzzer, AddressSanitizer, UndefinedBehaviorSanitizer) and runs each for a while, two
# at a time. Exits with 1 if one of them finds something; the input is then in build/fuzz/findings.
#   tools/fuzz.sh [SECONDS_PER_TARGET] [TARGET...]        default: 20 s of every target (tests/fuzz/*_fuzz.cc)
# What a target learns stays in build/fuzz/corpus and is where the next run begins.
set -euo pipefail
cd "$(dirname "$0")/.."
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
tools/build.sh fuzz --target fuzz

build=$PWD/build/fuzz
findings=$build/findings
seeds=$build/seeds
mkdir -p "$findings" "$build/fuzz-logs"
"$build/tests/fuzz/fuzz_seeds" "$seeds"

# Text gets room for a whole shipped file and more; the rest stays small, and so fast.
max_length() {
  case $1 in
    *_text) echo 20000 ;;
    log | capture) echo 16000 ;;
    *) echo 4000 ;;
  esac
}

run() {
  local target=$1 corpus=$build/corpus/$1 log=$build/fuzz-logs/$1.log program=$build/tests/fuzz/fuzz_$1 dictionary=()
  mkdir -p "$corpus"
  [[ -f $seeds/$target.dict ]] && dictionary=("-dict=$seeds/$target.dict")
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
