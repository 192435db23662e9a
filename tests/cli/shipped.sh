# Copies of the shipped schedules and scenarios in $work, to be changed. To be sourced after expect.sh, with $source set.
mkdir "$work/schedules" "$work/scenarios"
cp "$source"/schedules/*.yaml "$work/schedules"
cp "$source"/scenarios/*.yaml "$work/scenarios"

# mutate FROM SED TO: a shipped file with one mistake.
mutate() {
  sed "$2" "$source/$1" >"$3"
  cmp -s "$source/$1" "$3" && fail "mutation '$2' of $1 changes nothing"
}
