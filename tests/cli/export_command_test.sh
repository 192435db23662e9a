#!/usr/bin/env bash
# `ttfusion export`: a log for other programs.
#   export_command_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
source "$(dirname "$0")/expect.sh"

expect 0 '' run "$source/scenarios/paper_scenario2.yaml" --strategy tt --seed 3 --duration 1.6 --no-pictures --out "$work"
head -c 200000 "$work/tt.mcap" >"$work/cut.mcap"
head -c 100 "$work/tt.mcap" >"$work/empty.mcap"
: >"$work/nothing.mcap"
: >"$work/file"

expect 0 'Examples: ttfusion export' export --help
expect 2 'pcapng' export "$work/tt.mcap" --format asc -o "$work/drive.asc"
expect 2 'README.md' export "$source/README.md" --format csv -o "$work/drive.csv"
expect 1 'absent/drive.csv: cannot be written' export "$work/tt.mcap" --format csv -o "$work/absent/drive.csv"
expect 1 'error: .*/file/x.csv: cannot be written: Not a directory' export "$work/tt.mcap" --format csv -o "$work/file/x.csv"
for file in empty nothing; do
  expect 2 "error: .*$file.mcap: (is not a log|holds only the beginning of a log)" export "$work/$file.mcap" --format csv \
    -o "$work/none.csv"
  [[ -e $work/none.csv ]] && fail "an export of nothing leaves a file"
done
cp "$work/tt.mcap" "$work/itself.mcap"
expect 2 '--out = .*itself.mcap: must be another file than the input' \
  export "$work/itself.mcap" --format csv -o "$work/./itself.mcap"
cmp -s "$work/tt.mcap" "$work/itself.mcap" || fail "a refused export changed its input"

expect 0 '^wrote .*/drive.pcapng: [1-9][0-9]* FlexRay and [1-9][0-9]* CAN frames and 0 symbols' export "$work/tt.mcap" --format pcapng \
  -o "$work/drive.pcapng"
expect 0 '"can_frames": [1-9]' export "$work/tt.mcap" --format candump --json -o "$work/drive.log"
grep -Evq '^\([0-9]{10}\.[0-9]{6}\) [a-z_]+ [0-9A-F]{3}#(#1)?([0-9A-F]{2})*$' "$work/drive.log" &&
  fail "export --format candump leaves a line canplayer does not read"
expect 0 'warning: .*cut.mcap' export "$work/cut.mcap" --format csv -o "$work/drive.csv"
grep -vq '^warning: \|^wrote ' <<<"$output" && fail "a line of a warning is not called one: $output"
[[ $(head -1 "$work/drive.csv") == time_ns,bus,channel,* ]] || fail "export --format csv leaves no header"

# The folder of a drive stands for its log.
for input in "$work/tt.mcap" "$work"; do
  expect 0 '^wrote ' export "$input" --format csv -o "$work/of_$(basename "$input").csv"
done
cmp "$work/of_tt.mcap.csv" "$work/of_$(basename "$work").csv" || fail "the frames of a folder are not its log's"
expect 2 '--out = .*tt.mcap: must be another file than the input' export "$work" --format foxglove -o "$work/tt.mcap"

# A trace for Perfetto.
expect 0 '"flows": [1-9]' export "$work/tt.mcap" --format perfetto --json -o "$work/drive.pftrace"
stated=$(sed -n '/^{/,/^}/p' <<<"$output" | python3 -c 'import json, sys; t = json.load(sys.stdin); print("%d slices, %d instants, %d counts, %d flows" %
    (t["slices"], t["instants"], t["counter_values"], t["flows"]))')
expect 0 'warning: .*cut.mcap' export "$work/cut.mcap" --format perfetto -o "$work/cut.pftrace"
protoc --decode=ttfusion.perfetto.Trace -I "$source/recording/exports" "$source/recording/exports/perfetto.proto" \
  <"$work/drive.pftrace" |
  grep -q 'name: "age of the newest measurement when used \[ms\]"' || fail "export --format perfetto leaves no trace"
# As other programs read it, by Perfetto's own numbers: valid, and complete by the export's own count.
said=$(python3 "$source/tests/cli/perfetto_reader.py" "$work/drive.pftrace") || fail "drive.pftrace: $said"
[[ $said == *" tracks, $stated" ]] || fail "the trace has $said, the export says $stated"
cat "$work/cut.pftrace" "$work/cut.pftrace" >"$work/twice.pftrace"
python3 "$source/tests/cli/perfetto_reader.py" "$work/twice.pftrace" >"$work/said" && fail "two traces in one are sound"
python3 "$source/tests/cli/perfetto_reader.py" "$work/cut.pftrace" >"$work/said" || fail "cut.pftrace: $(cat "$work/said")"
expect 1 'absent/x.pftrace: cannot be written' export "$work/tt.mcap" --format perfetto -o "$work/absent/x.pftrace"
if [[ -c /dev/full ]]; then
  expect 1 '/dev/full: cannot be written: No space left' export "$work/tt.mcap" --format perfetto -o /dev/full
fi

# A scene for Foxglove, which is no log.
expect 0 '^wrote .*/scene.mcap: [1-9][0-9]* instants of truth, [1-9][0-9]* lists of observations, [1-9][0-9]* images and [1-9][0-9]* uses$' \
  export "$work/tt.mcap" --format foxglove -o "$work/scene.mcap"
expect 0 '"left_out": \[\]' export "$work/tt.mcap" --format foxglove --json -o "$work/again.mcap"
cmp -s "$work/scene.mcap" "$work/again.mcap" || fail "the same log gives another scene"
expect 2 'scene.mcap: profile = x-ttfusion-scene: is an MCAP file, but its profile must be ttfusion' export "$work/scene.mcap" --format csv -o "$work/none.csv"
expect 2 'scene.mcap: profile = x-ttfusion-scene: is an MCAP file' report "$work/scene.mcap" -o "$work/none.html"
expect 0 'warning: .*cut.mcap' export "$work/cut.mcap" --format foxglove -o "$work/cut_scene.mcap"
expect 2 '--out = .*itself.mcap: must be another file than the input' \
  export "$work/itself.mcap" --format foxglove -o "$work/itself.mcap"
expect 1 'absent/x.mcap: cannot be created' export "$work/tt.mcap" --format foxglove -o "$work/absent/x.mcap"
if [[ -c /dev/full ]]; then
  expect 1 '/dev/full: cannot be written: No space left' export "$work/tt.mcap" --format foxglove -o /dev/full
fi

# Tables: each row has a field for each name. Rows are in the order of time, and no row is there twice.
expect 0 '^wrote .*/tables: [1-9][0-9]* rows of truth.csv, [1-9].* tracks.csv, .* images.csv, .* ages.csv, .* errors.csv, .* tasks.csv, [1-9].* frames.csv$' \
  export "$work/tt.mcap" --format tables -o "$work/tables"
expect 0 '"errors.csv": [1-9]' export "$work/tt.mcap" --format tables --json -o "$work/again"
diff -rq "$work/tables" "$work/again" || fail "the same log gives other tables"
python3 - "$work/tables" <<'EOF' || fail "the tables are none"
import csv, sys
KEYS = {"truth": ["time_s", "object"], "tracks": ["time_s", "track", "for_image"], "images": ["image", "track"],
        "ages": ["time_s", "sensor"], "errors": ["time_s", "object"], "tasks": ["time_s", "node", "task"], "frames": None}
for table, key in KEYS.items():
    rows = list(csv.DictReader(open(f"{sys.argv[1]}/{table}.csv", newline="")))
    assert rows and all(None not in row and None not in row.values() for row in rows), table
    times = [float(row["time_s"]) for row in rows]
    assert times == sorted(times), f"{table} is not in the order of time"
    assert key is None or len({tuple(row[k] for k in key) for row in rows}) == len(rows), f"{table} has a row twice"
errors = {(row["time_s"], row["object"]) for row in csv.DictReader(open(f"{sys.argv[1]}/errors.csv", newline=""))}
truth = {(row["time_s"], row["object"]) for row in csv.DictReader(open(f"{sys.argv[1]}/truth.csv", newline=""))}
assert errors <= truth, "an error has no truth"
EOF
diff <(cut -d, -f2- "$work/tables/frames.csv") <("$program" export "$work/tt.mcap" --format csv -o "$work/f.csv" 2>"$work/said" && cut -d, -f2- "$work/f.csv") ||
  fail "the frames of the tables are not those of csv"
expect 1 'error: .*/file: cannot be created' export "$work/tt.mcap" --format tables -o "$work/file"
expect 2 'x.csv: must not end in .csv with --format tables' export "$work/tt.mcap" --format tables -o "$work/x.csv"
cp "$work/tt.mcap" "$work/again/truth.csv"
expect 2 '--out = .*truth.csv: must be another file than the input' export "$work/again/truth.csv" --format tables -o "$work/again"

# The same tables in one file: names, columns and values are equal, and an absent value is NULL.
expect 0 '^wrote .*/tables.sqlite: [1-9][0-9]* rows of truth, [1-9].* tracks, .* images, .* ages, .* errors, .* tasks, [1-9].* frames$' \
  export "$work/tt.mcap" --format sqlite -o "$work/tables.sqlite"
expect 0 '"format": "sqlite"' export "$work/tt.mcap" --format sqlite --json -o "$work/again.sqlite"
cmp "$work/tables.sqlite" "$work/again.sqlite" || fail "the same log gives another database"
python3 - "$work/tables" "$work/tables.sqlite" <<'EOF' || fail "the database is not the tables"
import csv, pathlib, sqlite3, sys
READ = {"REAL": float, "INTEGER": int, "TEXT": str}
database = sqlite3.connect(sys.argv[2])
files = sorted(pathlib.Path(sys.argv[1]).glob("*.csv"))
assert [f.stem for f in files] == [n for (n,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name")]
for file in files:
    heads, *rows = csv.reader(open(file, newline=""))
    columns = [(name, kind) for _, name, kind, *_ in database.execute(f"PRAGMA table_info({file.stem})")]
    assert [name for name, _ in columns] == heads, file.stem
    kept = database.execute(f"SELECT * FROM {file.stem} ORDER BY rowid").fetchall()
    assert len(kept) == len(rows), file.stem
    for row, there in zip(rows, kept):
        read = tuple(READ[kind](field) if field else None for field, (_, kind) in zip(row, columns))
        assert read == there and [type(f) for f in read] == [type(f) for f in there], (file.stem, read, there)
JOINED = "FROM errors JOIN truth USING (time_s, object) JOIN ages USING (time_s) JOIN images USING (image)"
plan = [step for *_, step in database.execute(f"EXPLAIN QUERY PLAN SELECT * {JOINED}")]
assert len([step for step in plan if step.startswith("SEARCH") and "_by_" in step]) == 3, plan
matched, errors = (database.execute(f"SELECT count(*) {which}").fetchone() for which in
                   ("FROM errors JOIN truth USING (time_s, object)", "FROM errors"))
assert matched == errors, "an error has no truth"
EOF
expect 1 'absent/x.sqlite: cannot be written' export "$work/tt.mcap" --format sqlite -o "$work/absent/x.sqlite"
expect 1 'error: /dev/null: cannot be written: is no file' export "$work/tt.mcap" --format sqlite -o /dev/null
expect 2 'x.csv: must not end in .csv with --format sqlite' export "$work/tt.mcap" --format sqlite -o "$work/x.csv"
expect 2 '--out = .*itself.mcap: must be another file than the input' \
  export "$work/itself.mcap" --format sqlite -o "$work/itself.mcap"

# The example draws them, or says what is missing.
for tables in "$work/tables" "$work/tables.sqlite"; do
  picture=$work/figure_of_$(basename "$tables").svg
  if said=$(python3 "$source/examples/table_figure.py" "$tables" "$picture" 2>&1); then
    grep -q '</svg>' "$picture" || fail "the example leaves no picture"
  elif [[ $said != "error: matplotlib is missing: install Debian's python3-matplotlib" ]]; then
    fail "the example draws nothing: $said"
  else
    echo "skipped: the figure of the tables: $said"
  fi
done
python3 -B - "$source/examples" "$work/tables" "$work/tables.sqlite" <<'EOF' || fail "the example reads another figure from the database"
import pathlib, sys
sys.path.insert(0, sys.argv[1])
import table_figure as figure
one, other = map(pathlib.Path, sys.argv[2:])
assert figure.position_errors(one) == figure.position_errors(other) and figure.ages(one) == figure.ages(other)
EOF
said=$(python3 "$source/examples/table_figure.py" "$work/drive.pcapng" "$work/figure.svg" 2>&1) && fail "the example draws a capture"
grep -q '^error: .*drive.pcapng: not the tables of a drive: ' <<<"$said" || fail "the example does not refuse a capture: $said"
said=$(python3 "$source/examples/table_figure.py" "$work/absent" "$work/figure.svg" 2>&1) && fail "the example draws nothing and says nothing"
grep -q '^error: .*absent/errors.csv' <<<"$said" || fail "the example does not name the missing table: $said"

[[ $failures -eq 0 ]] && echo "export command: all as documented"
exit $((failures > 0))
