#!/usr/bin/env bash
# Builds and runs tests of a preset: those that ctest's options in SELECTION choose, as far as the changes since COMMIT touch them
# (tools/touched.py). An empty COMMIT stands for all.
#   tools/touched_tests.sh PRESET COMMIT SELECTION [OPTION...]      further options go to ctest
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1 commit=$2
read -ra selection <<<"$3"
shift 3
tools/build.sh "$preset" --target help >/dev/null   # configured, nothing built
# Tests of a vcan are skipped without one; tools/vcan_bed.sh has them.
touched=$(tools/touched.py "build/$preset" "$commit" "${selection[@]}" | grep -v '^vcan_\|^build_slow_tests' || true)
echo "$preset: $(grep -c . <<<"$touched" || true) tests of ${selection[*]} are touched${commit:+ since $commit}"
[[ -n $touched ]] || exit 0
mapfile -t targets < <(cut -d' ' -f2- <<<"$touched" | tr ' ' '\n' | sort -u)
names=$(cut -d' ' -f1 <<<"$touched" | paste -sd'|')
tools/build.sh "$preset" --target "${targets[@]}"
ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -FA slow_tests -R "^($names)$" "$@"
