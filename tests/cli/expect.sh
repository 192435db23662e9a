# Shared by the scripts that try the program; to be sourced with $program set. $work is their own folder,
# removed at their end. $failures counts the calls of fail().
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect CODE PATTERN ARGS...: checks the exit code, a pattern in the output on either stream, and that tables are not too wide.
expect() {
  local code=$1 pattern=$2 actual
  shift 2
  asked=$* output=$("$program" "$@" 2>&1)
  actual=$?
  [[ $actual -eq $code ]] || fail "$asked exits with $actual, not $code: $output"
  says "$pattern"
  local LC_ALL=C
  [[ $output =~ [^$'\n']{101} ]] || return 0
  # A table has gaps of blanks. A sentence may be longer, also behind its instant.
  local wide
  wide=$(awk 'length > 100 && /[^ ]  +[^ ].*[^ ]  +[^ ]/ && !/^ *[0-9.]+ ms  /' <<<"$output")
  [[ -z $wide ]] || fail "$asked prints a table that is wider than 100 columns: $wide"
}
# expect_full ARGS...: to a full device it is an error, exit code 1, that nothing more can be written.
expect_full() {
  [[ -c /dev/full ]] || return 0
  asked=$* output=$("$program" "$@" 2>&1 >/dev/full)
  [[ $? -eq 1 ]] || fail "$asked to a full device does not exit with 1"
  says '^error: .*No space left on device'
}
# says PATTERN...: checks patterns in the output of the last expect.
says() {
  local pattern
  for pattern; do has_line "$pattern" || fail "$asked does not say '$pattern': $output"; done
}
# Like grep -Eq, without a process for each pattern.
has_line() {
  local line lines
  [[ -z $1 ]] && return
  local IFS=$'\n' -
  set -f
  # shellcheck disable=SC2206
  lines=($output)
  for line in "${lines[@]}"; do [[ $line =~ $1 ]] && return; done
  return 1
}
