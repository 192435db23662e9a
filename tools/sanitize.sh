#!/usr/bin/env bash
# Builds the program and the tests with clang++, warnings as errors, AddressSanitizer and UndefinedBehaviorSanitizer, and runs
# the tests. Those marked UNSANITIZED (cmake/modules.cmake) are left out, and those that run nothing of the build. Those of DDS and of
# a launch by the wall clock have three tries, as in tools/slow_tests.sh. The golden drives must give the same bits as with g++.
# tools/fuzz.sh uses the same build.
#   tools/sanitize.sh [--changed | --slow]
# --changed: only the tests that are touched (tools/touched.py) by the changes since the long checks last passed all of them.
# --slow: also the slow tests, and those by the wall clock.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh asan-ubsan --target help >/dev/null   # configured, nothing built
since=
[[ ${1:-} != --changed ]] || since=$(tools/last_passed.sh sanitizers)
ulimit -s 262144   # KiB: std::regex, in tests, calls itself for every character
export LSAN_OPTIONS=suppressions=$PWD/tools/lsan.supp:print_suppressions=0

# sanitized SELECTION [OPTION...]: builds and runs the touched ones of the tests that ctest's options in SELECTION choose.
sanitized() {
  local touched targets names
  read -ra selection <<<"$1"
  touched=$(tools/touched.py build/asan-ubsan "$since" "${selection[@]}" | grep -v ^vcan_ || true)   # tools/vcan_bed.sh has those
  echo "sanitizers: $(grep -c . <<<"$touched" || true) tests of $1 are touched${since:+ since $since}"
  [[ -n $touched ]] || return 0
  mapfile -t targets < <(cut -d' ' -f2- <<<"$touched" | tr ' ' '\n' | sort -u)
  names=$(cut -d' ' -f1 <<<"$touched" | paste -sd'|')
  tools/build.sh asan-ubsan --target "${targets[@]}"
  ctest --test-dir build/asan-ubsan --output-on-failure --no-tests=error -R "^($names)$" "${@:2}"
}

at_once=-j$(($(nproc) + 1))
sanitized '-LE realtime|slow' "$at_once"
sanitized '-R ^test_(dds_network|ros_network|launch_wall_clock)$' "$at_once" --repeat until-pass:3
[[ ${1:-} == --slow ]] || exit 0
sanitized '-LE realtime -L slow' "$at_once"
sanitized '-L realtime' "$at_once" --repeat until-pass:3
