#!/usr/bin/env bash
# docs/schedules/flexray_constraints.md is correct: its two commands make its picture, byte for byte, and the log contains its
# quotations.
#   startup_page_test.sh PROGRAM SOURCE_DIR
# When the picture has changed on purpose: startup_page_test.sh PROGRAM SOURCE_DIR --update
set -euo pipefail
program=$1
source=$2
page=$source/docs/schedules/flexray_constraints.md
picture=$source/docs/pictures/startup.svg
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
ln -s "$source/scenarios" scenarios
ln -s "$source/schedules" schedules

mapfile -t commands < <(sed -n 's|^    build/release/ttfusion ||p' "$page")
[[ ${#commands[@]} -eq 2 ]] || { echo "FAILED: the page has ${#commands[@]} commands"; exit 1; }
for command in "${commands[@]}"; do
  # shellcheck disable=SC2086  # words as on the page
  "$program" $command >>words 2>&1
done
if [[ ${3:-} == --update ]]; then
  cp out/startup.svg "$picture"
  exit
fi
cmp out/startup.svg "$picture" || { echo "FAILED: $picture is not what the page's commands make; see --update"; exit 1; }

quoted=0
while IFS= read -r sentence; do
  quoted=$((quoted + 1))
  escaped=$(sed "s/'/\&apos;/g" <<<"$sentence")
  grep -Fq -- "$sentence" out/startup.svg || grep -Fq -- "$escaped" out/startup.svg ||
    { echo "FAILED: the log does not say \"$sentence\""; exit 1; }
done < <(grep '^|' "$page" | grep -o '"[^"]*"' | tr -d '"')
[[ $quoted -ge 11 ]] || { echo "FAILED: only $quoted sentences are quoted"; exit 1; }

# And `run` prints when each node became active. Words that do not fit are below their row.
sed -i -e ':all' -e 'N' -e '$!ball' -e 's/\n    / /g' words
for line in 'fusion .* 6 .*normal active: another coldstart node' 'feature .* 7 .*along with others for three cycles' \
  'camera .* 8 .*two pairs of startup frames'; do
  grep -Eq -- "^$line" words || { echo "FAILED: run does not say '$line'"; cat words; exit 1; }
done
echo "the picture and $quoted sentences are as the page has them"
