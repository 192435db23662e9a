# Shared by the scripts that try the program; to be sourced with $program set. $work is their own folder,
# removed at their end. $failures counts the calls of fail().
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect CODE PATTERN ARGS...: checks the exit code, and a pattern in the output on either stream.
expect() {
  local code=$1 pattern=$2 output actual
  shift 2
  output=$("$program" "$@" 2>&1)
  actual=$?
  [[ $actual -eq $code ]] || fail "$* exits with $actual, not $code: $output"
  grep -Eq -- "$pattern" <<<"$output" || fail "$* does not say '$pattern': $output"
}
