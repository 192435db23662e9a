#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy) on sources, and compiles each header alone.
#   tools/tidy.sh             all modules
#   tools/tidy.sh --changed   the files changed since the long checks last passed (tools/long_checks.passed; if they never did,
#                             those of the last commit). The newest come first, until 70 seconds are over; long_checks.sh
#                             has the rest
#   tools/tidy.sh FILE...
# Exit code 1 if something is found. The preset asan-ubsan supplies the compiler's flags.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/asan-ubsan
[[ -f $build/compile_commands.json ]] || tools/build.sh asan-ubsan
until=$((SECONDS + 100000))
case ${1:-} in
  --changed)
    until=$((SECONDS + 70))
    since=$(tools/last_passed.sh tidy)
    changed=$(git log --format= --name-only --diff-filter=AM "${since:-HEAD~1}..HEAD" -- '*.h' '*.cc' ':!tests')
    mapfile -t files < <(awk 'NF && !seen[$0]++' <<<"$changed")
    ;;
  "") mapfile -t files < <(git ls-files '*.h' '*.cc' ':!tests') ;;
  *) files=("$@") ;;
esac

flags=(-std=c++20 -march=x86-64-v3 -ffp-contract=off -DTTF_VERSION='""' -DTTF_WITH_DDS=1 -I. "-isystem$build"
  -I/usr/include/eigen3 $(pkg-config --cflags ompi-c librsvg-2.0 CycloneDDS 2>/dev/null || pkg-config --cflags ompi-c librsvg-2.0))
check() {
  local file=$1
  [[ $SECONDS -lt $until && -f $file ]] || return 0
  case $file in
    *.h) clang++ "${flags[@]}" -fsyntax-only -Wno-pragma-once-outside-header -x c++ "$file" ;;
    *) clang-tidy --quiet "$file" -- "${flags[@]}" 2> >(grep -v ' warnings\? generated' >&2) ;;
  esac || { echo "$file: see above" >&2; return 1; }
  checked=$((checked + 1))
}

# Two processes take every second file each.
half() {
  local i checked=0 failed=0
  for ((i = $1; i < ${#files[@]}; i += 2)); do check "${files[i]}" || failed=1; done
  echo "$checked of $(((${#files[@]} + 1 - $1) / 2)) files checked"
  return $failed
}
half 0 &
failed=0
half 1 || failed=1
wait $! || failed=1
exit $failed
