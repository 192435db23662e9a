#!/usr/bin/env bash
# Prints the commit on which a check last passed in tools/long_checks.sh, if this repository has that commit.
#   tools/last_passed.sh CHECK
set -euo pipefail
cd "$(dirname "$0")/.."
commit=$(awk -v check="$1" '$1 == check { print $2 }' tools/long_checks.passed)
git cat-file -e "${commit:-none}^{commit}" 2>/dev/null || commit=
echo "$commit"
