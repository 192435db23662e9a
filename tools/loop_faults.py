#!/usr/bin/env python3
"""Faults in a closed loop, one at a time while the vehicle brakes: their outcome in metres, as a table.

    loop_faults.py PROGRAM REPOSITORY [--drives N] [--jobs N]            print the table
    loop_faults.py PROGRAM REPOSITORY [--drives N] [--jobs N] --update   write it into docs/results/loop_faults.md

Each drive has its own seed. The fault begins at a drawn instant, the same one for all paradigms and faults.
"""
import argparse
import functools
import json
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

SCENARIO = "scenarios/acc_braking_lead.yaml"
PARADIGMS = ("tt", "adva", "buff")
# The vehicle ahead brakes from 6 s to 9.7 s.
FIRST_MS, LAST_MS, DURATION_MS = 6000, 9500, 1500
NOISE = "signal: noise, length: 200 us, interval: 100 us"
# The fault, or none. Behind the name of a guardian's row the bus is a star with one.
GUARDED = ", star with guardian"
FAULTS = {
    "none": None,
    "crash of `feature`, the services' node": "kind: crash, node: feature",
    "crash of `actuator`": "kind: crash, node: actuator",
    "crash of `fusion`": "kind: crash, node: fusion",
    "crash of `laser_pre`": "kind: crash, node: laser_pre",
    "crash of `camera_pre`": "kind: crash, node: camera_pre",
    "crash of `odometry_pre`": "kind: crash, node: odometry_pre",
    "`gateway` babbles without a pause": f"kind: babbling_idiot, node: gateway, {NOISE}",
    "`gateway` babbles once a millisecond": "kind: babbling_idiot, node: gateway",
    "`gateway` babbles without a pause" + GUARDED: f"kind: babbling_idiot, node: gateway, {NOISE}",
}
TABLE = re.compile(r"\| fault \|[^\n]*\n\|---[^\n]*\n(?:\|[^\n]*\n)+")


def driven(program, repository, name, paradigm, seed):
    """The findings of one drive."""
    fault = FAULTS[name]
    text = (repository / SCENARIO).read_text(encoding="utf-8")
    if fault:
        begin = random.Random(seed).randrange(FIRST_MS, LAST_MS)
        text += f"faults:\n  - {{{fault}, from: {begin} ms, duration: {DURATION_MS} ms}}\n"
    with tempfile.TemporaryDirectory() as folder:
        for cluster in (repository / "schedules").glob("*.yaml"):
            schedule = cluster.read_text(encoding="utf-8")
            if name.endswith(GUARDED) and cluster.name.startswith("closed_loop_"):
                schedule += "\ntopology: star\nguardian: true\n"
            pathlib.Path(folder, cluster.name).write_text(schedule, encoding="utf-8")
        scenario = pathlib.Path(folder) / "drive.yaml"
        scenario.write_text(text.replace("../schedules/", ""), encoding="utf-8")
        command = [program, "run", scenario, "--strategy", paradigm, "--seed", str(seed), "--no-pictures", "--json",
                   "--out", folder]
        # Exit code 1 says that the fault showed.
        run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if run.returncode not in (0, 1) or not run.stdout:
        sys.exit(f"{name}, {paradigm}, seed {seed}: {run.stderr}")
    return json.loads(run.stdout)["strategies"][0]["driving"]


def spread(values, worst):
    """Median and worst value."""
    return f"{statistics.median(values):.2f} / {worst(values):.2f}" if values else "-"


def row(name, paradigm, drives):
    stops = [one["stopping_distance_m"] for one in drives if one["stopping_distance_m"] is not None]
    hits = [one["collision"]["closing_mps"] for one in drives if one["collision"]]
    cells = [name, paradigm, str(len(hits)), f"{max(hits):.1f}" if hits else "-",
             spread([one["smallest_gap_m"] for one in drives], min), spread(stops, max),
             str(sum(one["emergency_brakings"]["wrong"] for one in drives)),
             str(sum(one["emergency_brakings"]["missed"] for one in drives))]
    return f"| {' | '.join(cells)} |"


def table(program, repository, drives, jobs):
    rows = ["| fault | paradigm | collisions | fastest [m/s] | smallest gap, median / worst [m] "
            "| stopping distance, median / worst [m] | wrong brakings | missed |", "|---|---|---|---|---|---|---|---|"]
    with ThreadPoolExecutor(jobs) as pool:
        for name in FAULTS:
            for paradigm in PARADIGMS:
                one = functools.partial(driven, program, repository, name, paradigm)
                rows.append(row(name, paradigm, list(pool.map(one, range(1, drives + 1)))))
    return "\n".join(rows) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("repository", type=pathlib.Path)
    parser.add_argument("--drives", type=int, default=10)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    repository = arguments.repository.resolve()
    made = table(arguments.program, repository, arguments.drives, arguments.jobs)
    if not arguments.update:
        print(made, end="")
        return
    path = repository / "docs/results/loop_faults.md"
    page = path.read_text(encoding="utf-8")
    if len(TABLE.findall(page)) != 1:
        sys.exit(f"{path}: must have one table of faults")
    path.write_text(TABLE.sub(lambda _: made, page), encoding="utf-8")


if __name__ == "__main__":
    main()
