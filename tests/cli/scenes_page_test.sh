#!/usr/bin/env bash
# docs/fusion/world.md and docs/fusion/mixed_traffic.md are correct: their commands make their pictures, byte for byte, and they show all of them.
#   scenes_page_test.sh PROGRAM SOURCE_DIR
# When pictures have changed on purpose: scenes_page_test.sh PROGRAM SOURCE_DIR --update
set -euo pipefail
program=$1
source=$2
pages=("$source/docs/fusion/world.md" "$source/docs/fusion/mixed_traffic.md")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
ln -s "$source/scenarios" scenarios
ln -s "$source/schedules" schedules

mapfile -t commands < <(sed -n 's|^    build/release/ttfusion ||p' "${pages[@]}")
[[ ${#commands[@]} -eq 12 ]] || { echo "FAILED: the pages have ${#commands[@]} commands"; exit 1; }
for command in "${commands[@]}"; do
  # shellcheck disable=SC2086  # words as on the page
  "$program" $command >words 2>&1 || { echo "FAILED: $command"; cat words; exit 1; }
done
drawn=0
for picture in out/scene_*.svg; do
  name=$(basename "$picture")
  grep -Fq "/pictures/$name)" "${pages[@]}" || { echo "FAILED: no page shows $name"; exit 1; }
  if [[ ${3:-} == --update ]]; then
    cp "$picture" "$source/docs/pictures/$name"
  else
    cmp "$picture" "$source/docs/pictures/$name" ||
      { echo "FAILED: docs/pictures/$name is not what the pages' commands make; see --update"; exit 1; }
  fi
  drawn=$((drawn + 1))
done
[[ $drawn -eq 7 ]] || { echo "FAILED: only $drawn pictures"; exit 1; }
echo "$drawn pictures are as the pages' commands draw them"
