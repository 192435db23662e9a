#!/usr/bin/env python3
"""Runs the shipped drives and compares their content hashes with those kept here.

    golden_runs.py TTFUSION REPOSITORY            compare; exit 1 and name every difference
    golden_runs.py TTFUSION REPOSITORY --update   write what was computed, after showing the difference

The hash covers every record of a log bit for bit, so every build (compiler, optimisation level, sanitizers) must arrive
at the same one. Two pages show the first drive's hashes; they are held to the same file.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

DRIVES = ["paper_scenario1", "paper_scenario2", "turning_ego", "laser_and_radar"]
PAGES = ["README.md", "docs/use/reading_the_table.md"]   # show the first drive's hashes


def computed(ttfusion, repository):
    hashes = {}
    for drive in DRIVES:
        with tempfile.TemporaryDirectory() as out:
            run = subprocess.run(
                [ttfusion, "run", f"{repository}/scenarios/{drive}.yaml", "--no-pictures", "--json", "--out", out],
                check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for strategy in json.loads(run.stdout)["strategies"]:
            hashes[f"{drive} {strategy['strategy']}"] = strategy["content_hash"]
    return hashes


def main():
    ttfusion, repository = sys.argv[1], pathlib.Path(sys.argv[2])
    update = sys.argv[3:] == ["--update"]
    golden_file = repository / "tests/golden/content_hashes.json"
    golden = json.loads(golden_file.read_text()) if golden_file.exists() else {}
    now = computed(ttfusion, repository)
    differences = [f"{run}: {golden.get(run, 'none')} is kept, {now.get(run, 'none')} was computed"
                   for run in sorted(golden.keys() | now.keys()) if golden.get(run) != now.get(run)]
    for difference in differences:
        print(difference)
    if update:
        golden_file.write_text(json.dumps(now, indent=2) + "\n")
        return 0
    missing = [(page, run) for page in PAGES for run, value in golden.items()
               if run.startswith(DRIVES[0]) and value not in (repository / page).read_text()]
    for page, run in missing:
        print(f"{run}: {page} shows another content hash than {golden[run]}")
    return 1 if differences or missing else 0


if __name__ == "__main__":
    sys.exit(main())
