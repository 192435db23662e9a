#!/usr/bin/env bash
# `ttfusion diagram` and `report`: pictures of logs, whole and cut off.
#   diagram_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy tt --seed 3 --no-pictures --out "$work"
expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy adva --seed 3 --no-pictures --out "$work"

expect 0 '^wrote .*/timing.pdf$' diagram "$work/tt.mcap" --from 1.5 --to 1.6 -o "$work/timing.pdf"
expect 2 'command line: --from = 1e300: must be a decimal number 0..1000000000 s' \
  diagram "$work/tt.mcap" --from 1e300 -o "$work/timing.pdf"
expect 2 'must be after --from' diagram "$work/tt.mcap" --from 1.5 --to 1.5 -o "$work/timing.pdf"
expect 0 '' diagram "$work/tt.mcap" "$work/adva.mcap" --kind plane -o "$work/plane.svg"
# On paper.
for kind in timing position plane; do
  expect 0 '' diagram "$work/tt.mcap" --kind $kind --from 1.5 --to 1.6 --width 88mm --font-size 8 -o "$work/paper.svg"
  grep -q '<svg [^>]*width="88.0000mm"' "$work/paper.svg" || fail "the $kind picture is not 88 mm wide"
  [[ $(grep -o 'font-size="[^"]*"' "$work/paper.svg" | sort -u | wc -l) -eq 1 ]] || fail "the $kind picture has several sizes of text"
done
expect 0 '' diagram "$work/tt.mcap" --kind scene --at 1.5 --width 88mm --font-size 8 -o "$work/paper.svg"
grep -q '<svg [^>]*width="88.0000mm"' "$work/paper.svg" || fail "the scene is not 88 mm wide"
for width in 3.5in 8.89cm 252pt "88.9 mm"; do   # the same width
  expect 0 '' diagram "$work/tt.mcap" --kind plane --width "$width" -o "$work/$width.pdf"
  cmp "$work/$width.pdf" "$work/3.5in.pdf" || fail "3.5 in is not $width"
done
grep -Eaq '/MediaBox \[ 0 0 252(\.0000[0-9]*)? ' "$work/252pt.pdf" || fail "the PDF is not 252 pt wide: $(grep -a MediaBox "$work/252pt.pdf")"
expect 2 '^error: command line: --width = 88: must be a number of up to six decimals and mm, cm, in or pt, as in 88mm$' \
  diagram "$work/tt.mcap" --width 88 -o "$work/none.svg"
expect 2 '^error: command line: --width = 3ft: must be a number of up to six decimals and mm' diagram "$work/tt.mcap" --width 3ft -o "$work/none.svg"
expect 2 '^error: command line: --width = 1500 mm: must be 30..1000 mm$' diagram "$work/tt.mcap" --width 150cm -o "$work/none.svg"
expect 2 '^error: command line: --font-size = 3: must be a decimal number 4..72 pt$' \
  diagram "$work/tt.mcap" --width 88mm --font-size 3 -o "$work/none.svg"
expect 2 '--font-size = 8: goes with --width only' diagram "$work/tt.mcap" --font-size 8 -o "$work/none.svg"
expect 2 '--width = 88 mm: must be at least 141.2 mm with a font size of 20 pt' \
  diagram "$work/tt.mcap" --width 88mm --font-size 20 -o "$work/none.svg"
[[ -e $work/none.svg ]] && fail "a refused size leaves a picture"
expect 0 '' diagram "$work/tt.mcap" --kind plane --object 0 -o "$work/object.svg"
expect 2 '--object = 7: must be an object of the log, which has 0..0$' diagram "$work/tt.mcap" --kind plane --object 7 -o "$work/none.svg"
expect 2 '--object = 0: goes with --kind position or plane only' diagram "$work/tt.mcap" --object 0 -o "$work/none.svg"
# A folder stands for its logs.
mkdir "$work/folder" "$work/bare"
cp "$work/adva.mcap" "$work/tt.mcap" "$work/folder/"
expect 0 '' diagram "$work/folder" --kind plane -o "$work/folder.svg"
expect 0 '' diagram "$work/adva.mcap" "$work/tt.mcap" --kind plane -o "$work/plane.svg"
cmp "$work/folder.svg" "$work/plane.svg" || fail "the picture of a folder is not that of its logs"
expect 2 "folder: must be the folder of one drive, and there are 2: name a log of one, as in .*/folder/adva.mcap" \
  diagram "$work/folder" -o "$work/none.svg"
expect 2 'bare: holds no logs \(.mcap\)' diagram "$work/bare" -o "$work/none.svg"
expect 0 '' diagram "$work" --from 1.5 --to 1.6 -o "$work/folder.svg"   # its summary names adva.mcap alone
expect 0 '' diagram "$work/adva.mcap" --from 1.5 --to 1.6 -o "$work/timing.svg"
cmp "$work/folder.svg" "$work/timing.svg" || fail "the picture of a folder is not that of the log that its summary names"
expect 2 '--from = 50: must be before the end of the log' diagram "$work/tt.mcap" --from 50 -o "$work/none.svg"
expect 2 'tt.mcap: has no lateness: the run was not in real time' \
  diagram "$work/tt.mcap" --kind lateness -o "$work/none.svg"
expect 2 '--to = 1.5: does not go with --kind lateness' \
  diagram "$work/tt.mcap" --kind lateness --to 1.5 -o "$work/none.svg"
expect 0 '^wrote .*/scene.svg$' diagram "$work/tt.mcap" --kind scene --at 1.75 -o "$work/scene.svg"
for part in 'at 1.750 s' 'class="truth"' 'class="track"' 'class="ellipse"' 'class="field"' 'class="observation"'; do
  grep -q "$part" "$work/scene.svg" || fail "the scene has no $part"
done
expect 2 '--at = 50: must be at most .* s, the end of the log' \
  diagram "$work/tt.mcap" --kind scene --at 50 -o "$work/none.svg"
expect 2 '--at = soon: must be a decimal number 0..1000000000 s' \
  diagram "$work/tt.mcap" --kind scene --at soon -o "$work/none.svg"
expect 2 '--from = 1: does not go with --kind scene' \
  diagram "$work/tt.mcap" --kind scene --from 1 -o "$work/none.svg"
expect 2 '--at = 1: goes with --kind scene only' diagram "$work/tt.mcap" --at 1 -o "$work/none.svg"
expect 2 '--frame = 3: goes with --kind boxes' diagram "$work/tt.mcap" --frame 3 -o "$work/none.svg"
head -c 100 "$work/tt.mcap" >"$work/empty.mcap"
expect 2 'empty.mcap: holds only the beginning of a log: 100 bytes, no manifest, no record' \
  diagram "$work/empty.mcap" -o "$work/none.svg"
: >"$work/nothing.mcap"
expect 2 '(is not a log|holds only the beginning of a log)' diagram "$work/nothing.mcap" -o "$work/none.svg"
mkdir "$work/reported"
cp "$work/tt.mcap" "$work/reported/"
expect 2 '--out = .*tt.mcap: must end in .html' report "$work/reported" -o "$work/reported/./tt.mcap"
ln "$work/reported/tt.mcap" "$work/reported.html"
expect 2 '--out = .*.html: must be another file than the input' report "$work/reported" -o "$work/reported.html"
cmp -s "$work/tt.mcap" "$work/reported/tt.mcap" || fail "a refused report changed its input"
head -c 200000 "$work/tt.mcap" >"$work/cut.mcap"
expect 0 'warning: .*cut.mcap' diagram "$work/cut.mcap" -o "$work/cut.svg"
: >"$work/file"
expect 1 'error: .*/file/x.svg: cannot be written' diagram "$work/tt.mcap" -o "$work/file/x.svg"
mkdir "$work/picture.svg"
expect 1 'error: .*/picture.svg: cannot be written' diagram "$work/tt.mcap" -o "$work/picture.svg"
expect 2 'scenario|MCAP|mcap' diagram "$source/README.md" -o "$work/none.svg"

[[ $failures -eq 0 ]] && echo "diagram command: all as documented"
exit $((failures > 0))
