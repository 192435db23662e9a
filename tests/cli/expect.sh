# What the scripts that try the program share; to be sourced where $program is set. $work is a folder of their own, gone
# when they end; $failures counts what fail() told.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect CODE PATTERN ARGS...: exit code, and a pattern in what is printed on either stream.
expect() {
  local code=$1 pattern=$2 output actual
  shift 2
  output=$("$program" "$@" 2>&1)
  actual=$?
  [[ $actual -eq $code ]] || fail "$* exits with $actual, not $code: $output"
  grep -Eq -- "$pattern" <<<"$output" || fail "$* does not say '$pattern': $output"
}
