#!/usr/bin/env bash
# Man pages and completions: each has what --help has. Shells and man programs that are not there are left out.
#   manual_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source "$(dirname "$0")/expect.sh"

share=$work/share
expect 0 "^wrote $share\$" manual -o "$share"
expect 2 'must be given to `ttfusion manual`' manual

# Every command has a page, and the page has every option of its --help.
pages=$share/man/man1
while read -r command; do
  page=$pages/ttfusion-$command.1
  [[ -s $page ]] || fail "no page of $command"
  plain=$(sed 's/\\-/-/g; s/\\f[BIR]//g' "$page")
  while read -r option; do
    grep -q -- "$option" <<<"$plain" || fail "the page of $command has no $option"
  done < <("$program" "$command" --help | grep -oE '^  [^ ]*--[a-z-]+' | grep -oE -- '--[a-z-]+')
done < <("$program" --help | sed -n '/^Subcommands:/,/^$/p' | grep -oE '^  [a-z]+' | tr -d ' ')
[[ $(ls "$pages" | wc -l) -gt 10 ]] || fail "some pages are missing"
if command -v groff >/dev/null; then
  for page in "$pages"/*.1; do
    warnings=$(groff -man -Tutf8 -ww -z "$page" 2>&1)
    [[ -z $warnings ]] || fail "groff on $page: $warnings"
  done
fi

# bash: the last word is the one to complete.
complete() {
  bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _ttfusion; printf "%s\n" "${COMPREPLY[@]}"' \
    - "$share/bash-completion/completions/ttfusion" "$@" 2>&1
}
completes() {  # EXPECTED WORDS...: the completions, in one line
  local expected=$1 got
  shift
  got=$(complete "$@" | tr '\n' ' ')
  [[ $got == "$expected " ]] || fail "'$*' is completed by '$got', not '$expected'"
}
cd "$work" || exit 1
completes 'schedule' ttfusion sch
completes 'check show export sequence synthesize' ttfusion schedule ''
completes 'buff adva tt' ttfusion run x.yaml --strategy ''
completes 'paper_scenario1 paper_scenario2' ttfusion run paper_s
completes 'paper_synchronised' ttfusion schedule check paper_sy
completes '--no-log --no-pictures' ttfusion run --no-
completes 'share' ttfusion run --out sh
completes 'cluster' ttfusion keys clus
touch 'my drive.yaml'   # one name
for words in 'run my' 'run --out my'; do
  # shellcheck disable=SC2086
  [[ $(complete ttfusion $words) == 'my drive.yaml' ]] || fail "$words is completed by $(complete ttfusion $words)"
done
synopsis() { sed -n '/^.SH SYNOPSIS/{n;s/\\-/-/g;s/\\f[BIR]//g;p}' "$pages/ttfusion-$1.1"; }
[[ $(synopsis keys) == 'ttfusion keys [OPTIONS] [kind]' ]] || fail "the synopsis of keys is $(synopsis keys)"
[[ $(synopsis report) == 'ttfusion report [OPTIONS] --out TEXT folders...' ]] ||
  fail "the synopsis of report is $(synopsis report)"
for shell in zsh fish; do
  command -v "$shell" >/dev/null || continue
  for file in "$share/$shell"/*/*; do
    "$shell" -n "$file" || fail "$shell does not read $file"
  done
done

[[ $failures -eq 0 ]] && echo "manual: all as documented"
exit $((failures > 0))
