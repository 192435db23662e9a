#!/usr/bin/env bash
# Writes docs/keys and keys/schemas anew, as the program prints them; deletes the old ones first. [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/ttfusion}
"$program" --version >/dev/null   # before anything is deleted
find docs/keys -name '*.md' ! -name README.md -delete
find keys/schemas -name '*.schema.json' -delete
"$program" keys --format markdown -o docs/keys
"$program" keys --format json-schema -o keys/schemas
git status --short docs/keys keys/schemas
