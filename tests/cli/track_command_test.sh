#!/usr/bin/env bash
# ttfusion track as in docs/use/track.md: the example there, the same bytes for the same seed, and the same final
# tracks for every order of arrival. Each kind of bad input gives one clear sentence.
#   track_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

# block N: the N-th fenced block of the page.
block() { awk -v n="$1" '/^```/ { inside = !inside; if (inside) ++count; next } inside && count == n' "$source/docs/use/track.md"; }

expect 0 "Example: ttfusion track" track --help

# The example of the page.
block 1 >"$work/observations.csv"
block 2 >"$work/track.yaml"
block 3 >"$work/tracks.csv"
block 4 >"$work/table.txt"
block 5 >"$work/buff.txt"
example=(track "$work/observations.csv" --config "$work/track.yaml")
"$program" "${example[@]}" >"$work/out.csv" 2>"$work/words" || fail "the example fails"
diff "$work/tracks.csv" "$work/out.csv" || fail "the example's tracks are not those of the page"
diff "$work/table.txt" "$work/words" || fail "the example's table is not that of the page"
"$program" "${example[@]}" --strategy buff -o "$work/buff.csv" >"$work/words" 2>/dev/null || fail "the example with buff fails"
diff "$work/buff.txt" "$work/words" || fail "the example's table with buff is not that of the page"
# All but when it was known.
[[ $(tail -1 "$work/tracks.csv" | cut -d, -f1,3-) == $(tail -1 "$work/buff.csv" | cut -d, -f1,3-) ]] ||
  fail "buff does not end as adva does"

# As JSON, next to a file.
"$program" "${example[@]}" -o "$work/again.csv" --json 2>/dev/null | python3 -c '
import json, sys
s = json.load(sys.stdin)
assert (s["strategy"], s["tracks"], s["rows"], s["damaged_rows"]) == ("adva", 1, 4, 0), s
assert s["all"]["fused_late"] == 2 and [x["name"] for x in s["sensors"]] == ["lidar", "radar"], s
assert s["sensors"][1]["longest_delay_ms"] == 80, s
' || fail "--json is not the documented JSON"
cmp -s "$work/again.csv" "$work/tracks.csv" || fail "--out writes something else than standard output"
expect 2 '^error: command line: --json: needs --out' "${example[@]}" --json

# Three cars, two sensors, ten seconds; noise of the linear congruential kind.
awk 'BEGIN {
  r = 12345
  print "time,sensor,x,y,class"
  for (ms = 0; ms < 10000; ms += 10)
    for (s = 0; s < 2; ++s)
      if (ms % (s ? 70 : 50) == 0)
        for (car = 0; car < 3; ++car) {
          r = (r * 1103515245 + 12345) % 2147483648; a = r / 2147483648 - 0.5
          r = (r * 1103515245 + 12345) % 2147483648; b = r / 2147483648 - 0.5
          printf "%.3f,%s,%.4f,%.4f,car\n", ms / 1000, s ? "radar" : "lidar", 10 + 30 * car + 8 * ms / 1000 + a, 2 * car + b
        }
}' >"$work/cars.csv"
# With the truth beside each row, the tracks are judged. The second file has the third car elsewhere.
awk -F, 'NR == 1 { print $0 ",gt_object,gt_x,gt_y"; next }
  { car = (NR - 2) % 3; printf "%s,car %d,%.4f,%.4f\n", $0, car, 10 + 30 * car + 8 * $1 + (car == 2 ? off : 0), 2 * car }' \
  off=0 "$work/cars.csv" >"$work/judged.csv"
awk -F, 'NR == 1 { print $0 ",gt_object,gt_x,gt_y"; next }
  { car = (NR - 2) % 3; printf "%s,car %d,%.4f,%.4f\n", $0, car, 10 + 30 * car + 8 * $1 + (car == 2 ? off : 0), 2 * car }' \
  off=100 "$work/cars.csv" >"$work/missed.csv"
printf 'judgement: {cut_off: 3.0, order: 1.0}\n' >"$work/judgement.yaml"
for judged in judged missed; do
  "$program" track "$work/$judged.csv" --config "$work/judgement.yaml" --noise lidar:position=0.3 --noise radar:position=0.3 \
    -o "$work/judged_tracks.csv" --json >"$work/$judged.json" 2>/dev/null || fail "the tracks of $judged.csv are not judged"
done
python3 - "$work" <<'END' || fail "the truth is not judged as documented"
import json, sys
good, bad = (json.load(open(f"{sys.argv[1]}/{name}.json"))["truth"] for name in ("judged", "missed"))
assert good["gospa"]["cut_off_m"] == 3 and good["gospa"]["order"] == 1, good
assert 0.05 < good["position_rmse_m"] < 0.5 and good["clear_mot"]["mota"] > 0.9, good
assert good["track_life"]["objects"] == good["track_life"]["mostly_tracked"] == 3, good
assert good["clear_mot"]["switches"] == 0 and good["spurious"] == 0, good
n = good["gospa"]["instants"]
assert good["compared"] + good["missed"] == 3 * n, good
# The third car is missed, and its track is false: 1.5 m each.
assert bad["track_life"]["mostly_lost"] == 1 and abs(bad["missed"] - good["missed"] - bad["spurious"]) == 0, bad
assert abs(bad["gospa"]["false"] - 1.5 * bad["spurious"] / n) < 1e-9 and bad["gospa"]["false"] > 1.4, bad
assert bad["gospa"]["distance_m"] > good["gospa"]["distance_m"] + 2.5, bad
END
expect 0 'MOTA \[%\]' track "$work/judged.csv" --noise lidar:position=0.3 -o "$work/judged_tracks.csv"
cars=(track "$work/cars.csv" --noise lidar:position=0.3 --noise radar:position=0.3)
delays=(--delay lidar=5ms..60ms --delay "radar=0.02s..150 ms")
last() { tail -3 "$1" | cut -d, -f1,4- | sort; }   # states of the last instant, without names and without when it was known
expect 0 '^3 tracks by adva, ' "${cars[@]}" -o "$work/in_order.csv"
expect 0 'delay \[ms\]' "${cars[@]}" "${delays[@]}" --seed 7 -o "$work/a.csv"
expect 0 '' "${cars[@]}" "${delays[@]}" --seed 7 -o "$work/b.csv"
expect 0 '' "${cars[@]}" "${delays[@]}" --seed 8 -o "$work/c.csv"
cmp -s "$work/a.csv" "$work/b.csv" || fail "the same seed gives other bytes"
cmp -s "$work/a.csv" "$work/c.csv" && fail "another seed gives the same bytes"
expect 0 '' "${cars[@]}" --shuffle 20 -o "$work/shuffled.csv"
(head -1 "$work/cars.csv"; grep radar "$work/cars.csv"; grep lidar "$work/cars.csv") >"$work/by_sensor.csv"
expect 0 '' track "$work/by_sensor.csv" "${cars[@]:2}" -o "$work/by_sensor_tracks.csv"
cmp -s "$work/in_order.csv" "$work/by_sensor_tracks.csv" || fail "the order of rows of different sensors counts"
for tracks in a c shuffled; do
  [[ $(last "$work/$tracks.csv") == $(last "$work/in_order.csv") ]] || fail "adva: $tracks.csv does not end as arrival in order does"
done
for strategy in buff tt; do
  expect 0 "^3 tracks by $strategy, " "${cars[@]}" --strategy $strategy --delay "radar=60ms" -o "$work/$strategy.csv"
  [[ $(last "$work/$strategy.csv") == $(last "$work/in_order.csv") ]] || fail "$strategy does not end as arrival in order does"
done
"$program" "${cars[@]}" --predict --delay lidar=30ms --delay radar=30ms 2>/dev/null | awk -F, 'NR > 1 && $1 != $2 { bad = 1 } END { exit bad }' ||
  fail "--predict does not show the instant of the fusion"

# Files as other programs write them.
(printf '\xef\xbb\xbf'; sed 's/radar/"radar"/; s/$/\r/' "$work/cars.csv") >"$work/windows.csv"
expect 0 '' track "$work/windows.csv" "${cars[@]:2}" -o "$work/windows_tracks.csv"
cmp -s "$work/in_order.csv" "$work/windows_tracks.csv" || fail "a byte order mark, quotes or Windows' line ends count"

# Damaged rows: all are reported, or left out and counted.
awk -F, -v OFS=, 'NR == 5 { $3 = "nan" } NR == 9 { $2 = "sonar" } NR == 12 { $0 = "0.07,radar" } 1' \
  "$work/cars.csv" >"$work/damaged.csv"
printf 'sensors: {lidar: {}, radar: {}}\n' >"$work/two.yaml"
expect 2 '^error: .*damaged.csv:12: columns = 2: must be 5, as in the heading$' track "$work/damaged.csv" --config "$work/two.yaml"
expect 2 '^error: .*damaged.csv:5: x = nan: must be a number' track "$work/damaged.csv" --config "$work/two.yaml"
expect 2 '^error: .*damaged.csv:9: sensor = sonar: must be a sensor of .*two.yaml: lidar or radar$' \
  track "$work/damaged.csv" --config "$work/two.yaml" -o "$work/none.csv"
[[ -e $work/none.csv ]] && fail "a refused file leaves tracks"
expect 0 '^3 damaged rows left out$' track "$work/damaged.csv" --config "$work/two.yaml" --skip-damaged -o "$work/damaged_tracks.csv"
awk -F, -v OFS=, 'NR > 1 && NR % 3 { $3 = "nan" } 1' "$work/cars.csv" >"$work/most_damaged.csv"
rows=$(($(wc -l <"$work/most_damaged.csv") - 1)) damaged=$(grep -c nan "$work/most_damaged.csv")
expect 1 "^error: .*most_damaged.csv: most of the input was dropped: $damaged of $rows rows were damaged and left out\$" \
  track "$work/most_damaged.csv" "${cars[@]:2}" --skip-damaged -o "$work/damaged_tracks.csv"
[[ -s $work/damaged_tracks.csv ]] || fail "what came of a mostly damaged file is not written"
expect 0 '^warning: .*damaged.csv:12: columns' track "$work/damaged.csv" --config "$work/two.yaml" --skip-damaged

# Errors in a file, the configuration, or an option.
: >"$work/empty.csv"
expect 2 'empty.csv: holds no heading' track "$work/empty.csv"
expect 2 '--config: must have a value' track "$work/empty.csv" --config=
expect 2 'must' track "$work/empty.csv" -o ''
{ echo time,arrival,sensor,range,bearing,cov_11,cov_22; echo 0,0,radar,10,0,0.04,25; } >"$work/blurred.csv"
expect 2 'blurred.csv:2: cov_22 = 25: must be at most 0.25 rad\^2' track "$work/blurred.csv"
{ echo time,arrival,sensor,x,y; echo 0,0,lidar,1,2; echo 0,0,radar,one,2; } >"$work/one_damaged.csv"
expect 2 'one_damaged.csv:3: x = one' track "$work/one_damaged.csv" --delay radar=20ms..30ms
for waits in schedule measured fixed_lag; do
  echo "tracker: {buff_waits: $waits}" >"$work/waits.yaml"
  { echo time,arrival,sensor,x,y; echo 0,0.01,a,1,2; echo 0,0.01,b,1,2; echo 0.1,0.3,a,1,2; } >"$work/late.csv"
  expect 0 '' track "$work/late.csv" --config "$work/waits.yaml" --strategy buff
done
for late in rewind augmented clone adjoint al1 bl1 a b c; do
  echo "tracker: {late: $late}" >"$work/late.yaml"
  { echo time,arrival,sensor,x,y; echo 0,0.01,a,1,2; echo 0.1,0.11,a,1,2; echo 0.2,0.3,b,1,2
    echo 0.3,0.31,a,1,2; echo 0.3,0.41,b,1,2; echo 0.4,0.41,a,1,2; echo 0.35,0.42,b,1,2; } >"$work/late.csv"
  strategy=adva
  if [[ $late == clone ]]; then
    sed -i 's/^0.35/0.4/' "$work/late.csv"
    strategy=tt
  fi
  expect 0 '' track "$work/late.csv" --config "$work/late.yaml" --strategy $strategy
done
for late in augmented c; do
  printf 'tracker:\n  late: %s\n' $late >"$work/late.yaml"
  expect 2 "late.yaml:2: tracker.late = $late: must be rewind or clone with strategy tt" \
    track "$work/late.csv" --config "$work/late.yaml" --strategy tt
  expect 0 '' track "$work/late.csv" --config "$work/late.yaml" --strategy buff
done
printf 'tracker: {late: clone}\n' >"$work/late.yaml"
{ echo time,arrival,sensor,x,y; echo 0,0,a,1,2; echo 0.1,0.2,a,1,2; } >"$work/irregular.csv"
expect 2 'late.yaml:1: tracker.late = clone: must not be clone if a sensor measures freely' \
  track "$work/irregular.csv" --config "$work/late.yaml"
printf 'tracker: {late: al1}\n' >"$work/late.yaml"
{ echo time,arrival,sensor,range,bearing,range_rate; for i in 0 1 2 3; do echo "0.$i,0.$i,radar,10.$i,0,1"; done; } >"$work/radar.csv"
expect 0 '' track "$work/radar.csv" --config "$work/late.yaml" -o "$work/late_radar.csv"
expect 2 'empty.csv: holds no heading' track "$work/empty.csv" --skip-damaged
printf 'time,sensor,x,y\n' >"$work/bare.csv"
expect 2 'bare.csv: holds no row' track "$work/bare.csv"
printf 'time,x,y\n0,1,1\n' >"$work/nameless.csv"
expect 2 'nameless.csv:1: sensor: is missing' track "$work/nameless.csv"
printf 'time,sensor,x,y\n1,a,0,0\n0,a,0,0\n' >"$work/backwards.csv"
expect 1 '^error: .*backwards.csv: no track came of 2 lists: 2 lists were used, and a track is confirmed by 3 hits' \
  track "$work/backwards.csv"
printf 'time,sensor,x,y,cov_11,cov_12,cov_22\n1,a,0,0,1,2,1\n' >"$work/indefinite.csv"
expect 2 'indefinite.csv:2: covariance: must be positive definite' track "$work/indefinite.csv"
expect 2 'indefinite.csv:2: covariance' track "$work/indefinite.csv" --skip-damaged
expect 2 'absent.csv: cannot be read' track "$work/absent.csv"
expect 2 'absent.yaml: cannot be read' track "$work/cars.csv" --config "$work/absent.yaml"
printf 'tracker: {proces_noise: 4}\n' >"$work/typo.yaml"
expect 2 'typo.yaml:1: tracker.proces_noise: is not a known key' track "$work/cars.csv" --config "$work/typo.yaml"
printf 'tracker: {motion: ctrv, systematic: consider}\n' >"$work/bend.yaml"
expect 2 'bend.yaml:1: tracker.systematic = consider: must be ignore unless motion is constant_velocity' track "$work/cars.csv" --config "$work/bend.yaml"
printf 'sensors:\n  lidar: {}\n  radar: {bias_sigma: {bearing: 1}}\n' >"$work/wrong.yaml"
expect 2 'wrong.yaml:3: sensors.radar.bias_sigma.bearing = 1: must be a number 0..0.5 rad' track "$work/cars.csv" --config "$work/wrong.yaml"
expect 2 '--delay = sonar=5ms: must begin with a sensor \(lidar, radar\)' "${cars[@]}" --delay sonar=5ms
expect 2 '--delay = radar: must be SENSOR=VALUE' "${cars[@]}" --delay radar
expect 2 '--delay = radar=5: must be SENSOR= and 0..3600 s with its unit' "${cars[@]}" --delay radar=5
expect 2 '--delay = radar=9ms..5ms: must be LEAST..MOST' "${cars[@]}" --delay radar=9ms..5ms
expect 2 '--delay = radar=2ms: must name each sensor once' "${cars[@]}" --delay radar=1ms --delay radar=2ms
expect 2 '--worst-delay = radar=2h: must be SENSOR= and 0..3600 s' "${cars[@]}" --worst-delay radar=2h
expect 2 '--period = radar=0ms: must be SENSOR= and 0.000001..3600 s' "${cars[@]}" --period radar=0ms
expect 2 '--noise = radar:colour=1: must name one of position, range' "${cars[@]}" --noise radar:colour=1
expect 2 '--noise = radar:range=0: must be a number 0.001..100 m' "${cars[@]}" --noise radar:range=0
expect 2 '--noise = radar=1: must be SENSOR:WHAT=SIGMA' "${cars[@]}" --noise radar=1
expect 2 '--seed = -1: must be a whole number' "${cars[@]}" --seed=-1
expect 2 'command line: --shuffle' "${cars[@]}" --shuffle 0
expect 2 'command line: --strategy' "${cars[@]}" --strategy best
expect 2 'must be another file than the input' "${cars[@]}" -o "$work/cars.csv"
expect 1 'cannot be written' "${cars[@]}" -o "$work/no/such/folder.csv"
printf 'time,sensor,x,y\n1,a,0,0\n' >"$work/once.csv"
expect 2 'command line: strategy = tt: needs the period of at least one sensor' track "$work/once.csv" --strategy tt
expect 1 '^0 tracks by tt, 0 rows written$' track "$work/once.csv" --strategy tt --period a=50ms

# Rows in any order, and one stamp that leaps: the rest counts.
(head -1 "$work/cars.csv"; tail -n +2 "$work/cars.csv" | sort -t, -k3,3) >"$work/by_place.csv"
awk -F, -v OFS=, 'NR == 101 { $1 = 9999 } 1' "$work/cars.csv" >"$work/leap.csv"
expect 0 '^3 tracks by adva, ' track "$work/by_place.csv" "${cars[@]:2}" -o "$work/by_place_tracks.csv"
expect 2 '^error: .*leap.csv:101: time = 9999: must be near the stamps of (lidar|radar) above and below it' track "$work/leap.csv"
expect 0 '^1 damaged row left out$' track "$work/leap.csv" "${cars[@]:2}" --skip-damaged -o "$work/leap_tracks.csv"
[[ $(last "$work/leap_tracks.csv") == 9.95,* ]] || fail "the rows after a leap are lost: $(last "$work/leap_tracks.csv")"

# Nothing came of it: the reasons, and exit code 1.
awk 'BEGIN { print "time,sensor,x,y"; for (i = 0; i < 40; ++i) printf "%d,a,%g,2\n", i, 10 + i }' >"$work/seconds.csv"
expect 1 'error: .*seconds.csv: no track came of 40 lists: the middle gap .* is 1 s: .*delete_position_sigma' \
  track "$work/seconds.csv"
"$program" track "$work/seconds.csv" -o "$work/none_tracks.csv" --json 2>/dev/null | python3 -c '
import json, sys
s = json.load(sys.stdin)
assert s["did_its_work"] is False and len(s["reasons"]) == 1, s
' || fail "--json does not say that nothing was done"
awk 'BEGIN { for (k = -320; k <= 320; ++k) printf "0,%.2f,%.3f,1\n", k / 4, 20 + (k > 0) }' >"$work/degrees.csv"
awk -F, -v OFS=, '{ $2 *= 3.14159265 / 180 } 1' "$work/degrees.csv" |
  awk -F, '$2 > -0.05 && $2 < 0.05' >"$work/radians.csv"
expect 2 '^error: .*degrees.csv:1: azimuth_rad = -80.00: must be -6.283..6.283 rad: 5[0-9][0-9] of 641 azimuths are beyond a whole turn, so they may be in degrees$' \
  diagram "$work/degrees.csv" --kind boxes -o "$work/degrees.svg"
expect 0 '' diagram "$work/radians.csv" --kind boxes -o "$work/radians.svg"

# A recording of laser and radar.
printf 'L\t1.0\t0.1\t1000000\t1.0\t0.1\t5.0\t0.0\t0.0\t0.0\nX\t1\n' >"$work/short.txt"
expect 2 'short.txt:2: sensor = X: must be L' track "$work/short.txt" --format laser_radar
recording=${TTF_RECORDINGS:-$source/../shared/data}/laser_radar/measurements.txt
if [[ -r $recording ]]; then
  expect 0 '^1 track by adva, 49[0-9] rows written$' track "$recording" --format laser_radar -o "$work/recorded.csv"
  expect 0 '^radar +250 +250 ' track "$recording" --format laser_radar --strategy buff --delay radar=20ms..90ms -o "$work/late.csv"
  [[ $(tail -1 "$work/recorded.csv" | cut -d, -f1,3-) == $(tail -1 "$work/late.csv" | cut -d, -f1,3-) ]] ||
    fail "the recording's tracks end otherwise with a late radar"
else
  echo "laser and radar: skipped, there is no recording $recording;" \
    "set TTF_RECORDINGS to the folder that holds laser_radar/measurements.txt"
fi

# Scans: a car's rear, 20 m ahead and coming nearer, a pole, and a wall behind both.
scans() {   # scans FRAMES HEADING ROW-FORMAT
  echo "$2"
  awk -v frames="$1" -v row="$3" 'BEGIN {
    r = 12345
    for (f = 0; f < frames; ++f)
      for (k = -200; k <= 200; ++k) {
        a = k * 0.00436; near = 20 - 0.4 * f; y = near * sin(a) / cos(a)
        range = y > -0.9 && y < 0.9 ? near / cos(a) : 40 / cos(a)
        if (k >= 98 && k <= 101) range = 8
        r = (r * 1103515245 + 12345) % 2147483648; range += 0.04 * (r / 2147483648 - 0.5)
        if (row == "polar") printf "%d,%.5f,%.4f,1\n", f, a, range
        else if (row == "degrees") printf "%d,%.3f,%.4f,1\n", f, a * 57.29578, range
        else printf "%.1f,%.6f,%.6f\n", f / 10, range * cos(a), range * sin(a)
      }
  }'
}
scans 15 frame,azimuth_rad,range_m,intensity polar >"$work/scans.csv"
scans 15 time,x,y plane >"$work/plane.csv"
scans 15 '# frame,azimuth_rad,range_m,intensity' degrees >"$work/scan_degrees.csv"
"$program" track "$work/scans.csv" --format scans -o "$work/scan_tracks.csv" --picture "$work/street.svg" --json \
  >"$work/scans.json" 2>/dev/null || fail "scans are not tracked"
python3 - "$work" <<'END' || fail "the counts of scans are not as documented"
import csv, json, sys
s = json.load(open(f"{sys.argv[1]}/scans.json"))
of = s["scans"]
assert (of["scans"], of["returns"], s["tracks"]) == (15, 15 * 401, 1), s
assert of["segments"]["thin"] == 15 and of["segments"]["large"] >= 15, of
assert of["overlapping_pairs"] == of["overlaps"] == 0 and of["lifetime_s"]["median"] >= 1, of
last = list(csv.DictReader(open(f"{sys.argv[1]}/scan_tracks.csv")))[-1]
assert abs(float(last["width"]) - 1.8) < 0.15 and abs(float(last["vx"]) + 4) < 1, last
END
grep -q 'Scan 14: 401 returns, 1 track' "$work/street.svg" || fail "the picture does not show the last scan"
grep -q 'class="heading"' "$work/street.svg" || fail "the picture shows no heading of the rear"
expect 0 '^lifetime \[s\]: median' track "$work/plane.csv" --format scans -o "$work/plane_tracks.csv"
cmp -s <(cut -d, -f1,3 "$work/plane_tracks.csv") <(cut -d, -f1,3 "$work/scan_tracks.csv") ||
  fail "scans by x and y give other tracks than by azimuth and range"
expect 2 '^error: .*scan_degrees.csv:2: azimuth_rad = -49.962: must be -6.283..6.283 rad: [0-9]+ of 6015 azimuths .* degrees$' \
  track "$work/scan_degrees.csv" --format scans
awk 'BEGIN { for (f = 0; f < 5; ++f) for (k = -20; k < 20; ++k) printf "%d,%.4f,%.2f,1\n", f, k * 0.0436, 10 + 10 * (k % 2 == 0) }' >"$work/specks.csv"
expect 1 '^error: .*specks.csv: no box came of 5 scans: 200 of 200 segments have fewer than 3 returns' \
  track "$work/specks.csv" --format scans
expect 1 '^error: .*specks.csv: Scan 0: 40 returns, 0 boxes: 40 of 40 segments have fewer than 3 returns' \
  diagram "$work/specks.csv" --kind boxes -o "$work/specks.svg"
[[ -s $work/specks.svg ]] || fail "a scan without a box has no picture"
: >"$work/no_scan.csv"
expect 2 'no_scan.csv' diagram "$work/no_scan.csv" --kind boxes -o "$work/no_scan.svg"
printf 'time,frame,x,y\n0,0,1,1\n' >"$work/both.csv"
expect 2 'both.csv:1: heading: must have either frame or time' track "$work/both.csv" --format scans
printf 'time,x,y\n1,1,1\n0,1,1\n' >"$work/back.csv"
expect 1 'back.csv: no box came of 2 scans' track "$work/back.csv" --format scans
# Rows in any order, and one stamp that leaps: the rest counts.
(head -1 "$work/plane.csv"; tail -n +2 "$work/plane.csv" | tac | sort -s -t, -k3,3) >"$work/shuffled_scans.csv"
(head -1 "$work/plane.csv"; tail -n +2 "$work/plane.csv" | sort -s -t, -k3,3 | sort -s -t, -k1,1g) >"$work/sorted_scans.csv"
for order in shuffled sorted; do
  expect 0 '^1 track by adva, ' track "$work/${order}_scans.csv" --format scans -o "$work/${order}_tracks.csv"
done
cmp -s "$work/shuffled_tracks.csv" "$work/sorted_tracks.csv" || fail "the order of scans counts"
awk -F, -v OFS=, 'NR == 2000 { $1 = 9999 } 1' "$work/plane.csv" >"$work/scan_leap.csv"
expect 2 '^error: .*scan_leap.csv:2000: time = 9999: must be near the stamps above and below it, 0.4 s and 0.4 s' \
  track "$work/scan_leap.csv" --format scans
expect 0 '^1 damaged row left out$' track "$work/scan_leap.csv" --format scans --skip-damaged -o "$work/leap_tracks.csv"
[[ $(tail -1 "$work/leap_tracks.csv") == 1.4,* ]] || fail "the scans after a leap are lost: $(tail -1 "$work/leap_tracks.csv")"
# 3,200 of 15 x 401 returns are damaged: returns are counted, not boxes.
awk -F, -v OFS=, 'NR > 1 && NR % 401 > 80 && NR % 401 <= 320 && damaged < 3200 { $2 = "nan"; ++damaged } 1' "$work/plane.csv" >"$work/most_scans.csv"
expect 1 ': 3200 of 6015 rows were damaged and left out' track "$work/most_scans.csv" --format scans --skip-damaged -o "$work/most_tracks.csv"
expect 2 '--picture = .*: goes with --format scans only' "${cars[@]}" --picture "$work/cars.svg"
expect 2 '--width = 88mm: goes with --picture only' track "$work/scans.csv" --format scans --width 88mm
expect 2 '--width = 10 mm: must be 30..1000 mm' track "$work/scans.csv" --format scans --picture "$work/x.svg" --width 10mm
expect 0 '' track "$work/scans.csv" --format scans --picture "$work/paper.svg" --width 88mm -o "$work/paper_tracks.csv"
grep -q '<svg [^>]*width="88.0000mm"' "$work/paper.svg" || fail "the picture of a scan is not 88 mm wide"
expect 2 '--frame = 15: must be 0..14: the recording has 15 scans' track "$work/scans.csv" --format scans --picture "$work/x.svg" --frame 15
printf 'scans: {period: 50 ms}\n' >"$work/scanner.yaml"
expect 2 'scanner.yaml:1: scans: goes with --format scans only' "${cars[@]}" --config "$work/scanner.yaml"
expect 0 '' track "$work/scans.csv" --format scans --config "$work/scanner.yaml" -o "$work/twice_as_fast.csv"
[[ $(tail -1 "$work/twice_as_fast.csv") == 0.7,* ]] || fail "the period of scans does not count"

# A real street, where the recording is there (docs/use/track.md).
street=${TTF_RECORDINGS:-$source/../shared/data}/lidar_scans/scans.csv
if [[ -e $street ]]; then
  printf 'scans: {silhouette_weight: 1, preprocessing: {join_gap: 0, split_step: 0, thinnest: 0, roughest: 100}}\ntracker: {overlaps: keep}\n' \
    >"$work/before.yaml"
  "$program" track "$street" --format scans --config "$work/before.yaml" -o "$work/street.csv" --json >"$work/before.json" 2>/dev/null ||
    fail "the street is not tracked without shapes"
  "$program" track "$street" --format scans -o "$work/street.csv" --json >"$work/after.json" 2>/dev/null ||
    fail "the street is not tracked"
  python3 - "$work" <<'END' || fail "the street has more or worse tracks than documented"
import json, sys
before, after = (json.load(open(f"{sys.argv[1]}/{name}.json")) for name in ("before", "after"))
assert after["scans"]["overlaps"] == 0 < before["scans"]["overlaps"], (before, after)
assert 0 < after["tracks"] < before["tracks"], (before, after)
assert abs(after["scans"]["lifetime_s"]["median"] - 0.9) < 0.05, (before, after)
END
else
  echo "skipped: there is no $street"
fi

[[ $failures -eq 0 ]] && echo "track: all as documented"
exit $((failures > 0))
