#!/usr/bin/env bash
# The checks that take too long for .ci/run: hours on two cores, started by hand. Each one that passes writes the commit and
# the day into tools/long_checks.passed, which is committed.
#   tools/long_checks.sh [CHECK...]      default: all of those below
set -euo pipefail
cd "$(dirname "$0")/.."
kept=tools/long_checks.passed

plain_g++() { tools/plain_build.sh g++; }                              # everything, as a build without presets does
plain_clang++() {                                                      # so, too; the presets' warnings are errors
  CXXFLAGS=$(grep -o ' -W[a-z=0-9-]*' CMakePresets.json | sort -u | tr -d '\n') tools/plain_build.sh clang++ all benchmarks slow_tests
}
slow() { tools/slow_tests.sh; }                                        # all slow tests, and those by the wall clock
sanitizers() { tools/sanitize.sh; }                                    # all tests of which .ci/run has the touched ones
sanitizers_slow() { tools/sanitize.sh --slow; }                        # slow tests, and those by the wall clock
threads() { tools/threads.sh; }                                        # as sanitizers
threads_wide() {                                                       # the thread sanitizer, all of these modules' tests
  tools/threads.sh test_sweep test_experiments test_runner test_recording test_dds test_dds_network test_dds_live
}
tidy() { tools/tidy.sh; }                                              # every source and header of the modules
fuzz() { tools/fuzz.sh 300; }                                          # five minutes a target
results() { tools/results.py check; }                                  # all kept replications of every page

all=(plain_g++ plain_clang++ slow sanitizers sanitizers_slow threads threads_wide tidy fuzz results)
[[ $# -gt 0 ]] || set -- "${all[@]}"
tools/install_deps.sh --gates
[[ -z $(git status --porcelain) ]] || { echo "error: commit first: what passes is kept with its commit" >&2; exit 2; }
commit=$(git rev-parse --short=12 HEAD)
failed=0
for check; do
  declare -F "$check" >/dev/null || { echo "error: $check is no check: must be one of ${all[*]}" >&2; exit 2; }
  echo "== $check"
  start=$SECONDS
  # A condition would switch -e off inside.
  set +e
  (set -e; "$check")
  result=$?
  set -e
  if [[ $result -eq 0 ]]; then
    { grep -v "^$check " "$kept" || true; echo "$check $commit $(date -u +%F) $((SECONDS - start)) s"; } | LC_ALL=C sort >"$kept.new"
    mv "$kept.new" "$kept"
  else
    failed=1
  fi
  echo "== $check: $([[ $result -eq 0 ]] && echo passed || echo failed), $((SECONDS - start)) s"
done
exit $failed
