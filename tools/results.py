#!/usr/bin/env python3
"""Drives the experiments of docs/results, makes their tables, and checks that today's program still gives them.

    results.py drive PAGE ... [--jobs N]    runs each page's commands, fills its tables, keeps its first replications
    results.py fill PAGE ...                fills an edited page's tables from the kept answer
    results.py check [PAGE ...] [--jobs N] [--replications 2..3]
                                            drives a part of each page, and holds it against what the page prints
    results.py printed [PAGE ...]           holds each page's tables against the kept answer, without a drive

A table may name further seeds. The page's command is then driven with `--seed`, too, and of each seed is kept what the tables have.

The pages say what their tables are (result_tables.py). Kept are the answer of each page's drive, and the first
replications of each paradigm and point (tests/golden/results). The check drives the same ones, or fewer of them. Their
mean must not be further from the kept one than the printed interval is wide to one side. The random numbers are the same, so any
difference is the program's. A small change of the program passes. One that a table would show does not.
"""
import argparse
import copy
import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import result_tables

TOP = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = TOP / "build/release/ttfusion"
DRIVEN = TOP / "build/results"
KEPT = TOP / "tests/golden/results"
REPLICATIONS = 3    # kept of each point
STEADY = 0.05       # share of a figure without an interval that it may change by
COMMAND = re.compile(r"\n    build/release/ttfusion experiment (\S+)([^\n]*)")
FIGURE = re.compile(r"^\**([-+]?[0-9.]+) (?:± ([0-9.]+)|\(([-+]?[0-9.]+) to ([-+]?[0-9.]+)\))\**$")


class Page:
    def __init__(self, path):
        self.path, self.text = path, path.read_text(encoding="utf-8")
        commands = COMMAND.findall(self.text)
        self.experiment, self.options = commands[0] if commands else (None, "")
        self.options = re.sub(r"--out \S+", "", self.options).split()
        self.kept = KEPT / f"{path.stem}.csv"
        self.kept_answer = KEPT / f"{path.stem}.json"
        self.driven = DRIVEN / pathlib.Path(self.experiment or path.stem).stem
        self.tables = result_tables.tables_of(self.text)
        self.seed = None  # the file's

    def of_seed(self, seed):
        """The page with another seed's tables, files and options."""
        other = copy.copy(self)
        other.seed = seed
        other.options = [*self.options, "--seed", seed]
        other.kept, other.kept_answer, other.driven = (at.with_name(f"{at.stem}_seed_{seed}{at.suffix}")
                                                       for at in (self.kept, self.kept_answer, self.driven))
        other.tables = [(directive, text) for directive, text in self.tables if seed in dict(directive.numbers())]
        return other

    def all_seeds(self):
        seeds = {seed for directive, _ in self.tables for seed, _ in directive.numbers()}
        return [self, *(self.of_seed(seed) for seed in sorted(seeds, key=int))]

    def left_out(self):
        """The replications of this seed that a column leaves out."""
        return sorted({one for directive, _ in self.tables for seed, one in directive.numbers() if seed == self.seed and one})

    def answer(self):
        """The kept answer, with those of the other seeds."""
        own, *others = (json.loads(page.kept_answer.read_text(encoding="utf-8")) for page in self.all_seeds())
        return {**own, "seeds": {str(other["seed"]): other for other in others}}

    def fill(self):
        self.path.write_text(result_tables.filled(self.text, self.answer()), encoding="utf-8")


def drive(experiment, options, folder, jobs):
    """Runs an experiment. Exit code 1 says that an expectation does not hold, which is a result."""
    command = [PROGRAM, "experiment", experiment, *options, "--jobs", str(jobs), "--out", folder]
    done = subprocess.run(command, cwd=TOP, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode not in (0, 1) or not (pathlib.Path(folder) / "answer.json").exists():
        sys.exit(f"{experiment}: {done.stderr.strip()}")
    return done.returncode == 0


def values_of(folder, measures, wanted):
    """(point, paradigm) -> measure -> the values of the wanted replications."""
    found = {}
    with open(pathlib.Path(folder) / "runs.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if not wanted(int(row["replication"])) or row["status"] != "done":
                continue
            cell = found.setdefault((int(row["point"]), row["paradigm"]), {m: [] for m in measures})
            for measure in measures:
                cell[measure].append(float(row[measure]) if row[measure] else float("nan"))
    return found


def first_replications(folder, measures, replications=REPLICATIONS):
    return values_of(folder, measures, lambda replication: replication < replications)


def measures_of(page):
    return list(dict.fromkeys(m for directive, _ in page.tables for m in directive.measures))


def trimmed(answer, measures, paradigms=None):
    """An answer with the measures of these tables alone, to six digits."""
    def rounded(value):
        if isinstance(value, dict):
            return {key: rounded(of) for key, of in value.items()}
        if isinstance(value, list):
            return [rounded(of) for of in value]
        return float(f"{value:.6g}") if isinstance(value, float) else value
    points = [{"point": p["point"], "axes": p["axes"],
               "paradigms": {name: {m: rounded(cells[m]) for m in measures} for name, cells in p["paradigms"].items()
                             if paradigms is None or name in paradigms}}
              for p in answer["points"]]
    kept = {**{key: answer[key] for key in ("baseline", "confidence", "seed")}, "points": points,
            "measures": {m: answer["measures"][m] for m in measures}}
    if "interactions" in answer:
        kept["interactions"] = rounded([one for one in answer["interactions"] if one["measure"] in measures])
    return kept


def printed(pages):
    """Whether a page prints other tables than its kept answer has."""
    failed = False
    for page in pages:
        if not all(one.kept_answer.exists() for one in page.all_seeds()):
            print(f"{page.path.name}: has no kept answer: tools/results.py drive {page.path.relative_to(TOP)}")
            failed = True
            continue
        if result_tables.filled(page.text, page.answer()) != page.text:
            print(f"{page.path.name}: prints other tables than its drive gave: tools/results.py drive "
                  f"{page.path.relative_to(TOP)}")
            failed = True
    return failed


def points_without(page, answer, replication):
    """The points of an answer without one replication. They have means, without intervals."""
    runs = values_of(page.driven, measures_of(page), lambda one: one != replication)

    def estimate(point, paradigm, measure):
        own, base = (mean(runs[point, p][measure]) for p in (paradigm, answer["baseline"]))
        if not (math.isfinite(own) and math.isfinite(base) and base > 0):
            none = {"mean": None, "low": None, "high": None}
            return {"mean": own if math.isfinite(own) else None, "half_width": None,
                    "difference": {"mean": None, "half_width": None, "percent": none}}
        found = {"mean": own, "half_width": None}
        if paradigm != answer["baseline"]:
            found["difference"] = {"mean": own - base, "half_width": None,
                                   "percent": {"mean": 100 * (own / base - 1), "low": None, "high": None}}
        return found
    return [{**p, "paradigms": {name: {m: estimate(p["point"], name, m) for m in cells} for name, cells in p["paradigms"].items()}}
            for p in answer["points"]]


def keep(page):
    """Keeps the answer and the first replications. Another seed than the page's has the paradigms of its columns alone."""
    measures, paradigms = measures_of(page), None
    KEPT.mkdir(parents=True, exist_ok=True)
    answer = json.loads((page.driven / "answer.json").read_text(encoding="utf-8"))
    if page.seed:
        paradigms = {answer["baseline"], *(directive.of_seeds for directive, _ in page.tables)}
    kept = trimmed(answer, measures, paradigms)
    if page.left_out():
        kept["without"] = {r: trimmed({**kept, "points": points_without(page, kept, int(r))}, measures)["points"]
                           for r in page.left_out()}
    page.kept_answer.write_text(json.dumps(kept, separators=(",", ":")) + "\n", encoding="utf-8")
    with open(page.kept, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["point", "paradigm", "replication", *measures])
        for (point, paradigm), cell in sorted(first_replications(page.driven, measures).items()):
            if paradigms is not None and paradigm not in paradigms:
                continue
            for r in range(len(cell[measures[0]])):
                out.writerow([point, paradigm, r, *(f"{cell[m][r]:.6g}" for m in measures)])


def kept_rows(page, replications):
    found = {}
    with open(page.kept, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if int(row["replication"]) >= replications:
                continue
            cell = found.setdefault((int(row["point"]), row["paradigm"]), {})
            for measure in measures_of(page):
                cell.setdefault(measure, []).append(float(row[measure]))
    return found


def mean(values):
    """Averages the drives that have a value. An object that is never tracked has no error."""
    values = [value for value in values if not math.isnan(value)]
    return sum(values) / len(values) if values else float("nan")


def figure(kind, rows, cell, baseline, base):
    """The figure of this cell, of these replications alone. `base` is the baseline's mean for `percent`."""
    own = mean(rows[cell.point["point"], cell.paradigm][cell.measure])
    if kind in ("values", "means") or cell.paradigm == baseline:
        return own
    difference = own - mean(rows[cell.point["point"], baseline][cell.measure])
    return 100 * difference / base if kind == "percent" else difference


def allowed(said, then, today):
    """How far today's figure may be from the kept one: as far as the printed interval reaches to its side."""
    match = FIGURE.match(said)
    if not match:
        return STEADY * abs(then) + 1e-9
    middle, half, low, high = (float(part) if part else None for part in match.groups())
    reach = half if half is not None else high - middle if today > then else middle - low
    # An interval may be narrower than the last digit that is printed.
    return max(reach, 0.5 * 10.0 ** -len(match[1].partition(".")[2]))


def printed_cells(table):
    """The rows' cells of a table's text, without its head."""
    return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in table.splitlines()[2:]]


def contradictions(page, todays, answer, replications):
    """`todays` has the rows of today's drives by the seed, None for the page's own."""
    thens, found = {seed: kept_rows(page.of_seed(seed) if seed else page, replications) for seed in todays}, []
    for directive, text in page.tables:
        table = result_tables.Table(directive, answer)
        in_page = printed_cells(text)
        if len(in_page) != len(table.lines):
            found.append(f"table: {directive.text}: has {len(in_page)} rows, not {len(table.lines)}")
            continue
        for (named, cells), line in zip(table.lines, in_page):
            for cell, said in zip(cells, line[len(named):]):
                if cell.measure is None:
                    continue
                then, today = thens[cell.seed], todays[cell.seed]
                base = (mean(then[cell.point["point"], table.baseline][cell.measure]) if directive.kind == "percent"
                        else None)
                a, b = (figure(directive.kind, rows, cell, table.baseline, base) for rows in (then, today))
                if not (abs(b - a) <= allowed(said, a, b) or (math.isnan(a) and math.isnan(b))):
                    where = ", ".join(f"{k} {v}" for k, v in [*cell.point["axes"].items(),
                                                              *([("seed", cell.seed)] if cell.seed else [])])
                    found.append(f"{cell.measure} of {cell.paradigm}, {where}: replications 0 to {replications - 1} "
                                 f"give {b:.4g}, and gave {a:.4g} for the table, which prints {said}")
    return found


def report(page, found):
    """Prints what a page's drives contradict, and returns whether they do."""
    cells = sum(len(printed_cells(text)) for _, text in page.tables)
    print(f"{page.path.name}: {len(page.tables)} tables, {cells} rows: {len(found)} contradictions", flush=True)
    for line in found[:5]:
        print(f"  {line}")
    if found:
        print(f"  drive it anew: tools/results.py drive {page.path.relative_to(TOP)}")
    return bool(found)


def check(pages, replications, jobs):
    failed, driven = False, set()
    with tempfile.TemporaryDirectory() as top:
        for page in pages:
            answers, todays = {}, {}
            for one in page.all_seeds():
                folder, seed = pathlib.Path(top) / one.driven.name, one.seed
                if one.driven not in driven:  # pages may share an experiment
                    driven.add(one.driven)
                    seeded = ["--seed", seed] if seed else []
                    drive(one.experiment, ["--replications", str(replications), *seeded], folder, jobs)
                answers[seed] = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
                todays[seed] = first_replications(folder, measures_of(one), replications)
            # The figures are the rows', so that no point needs a replication less here.
            seeds = {one.seed: {**answers[one.seed], "without": {r: answers[one.seed]["points"] for r in one.left_out()}}
                     for one in page.all_seeds()[1:]}
            found = contradictions(page, todays, {**answers[None], "seeds": seeds}, replications)
            failed = report(page, found) or failed
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["drive", "fill", "check", "printed"])
    parser.add_argument("pages", nargs="*")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--replications", type=int, default=REPLICATIONS, choices=range(2, REPLICATIONS + 1))
    asked = parser.parse_args()
    paths = [pathlib.Path(p).resolve() for p in asked.pages] or sorted((TOP / "docs/results").glob("*.md"))
    pages = [page for page in map(Page, paths) if page.tables and page.experiment]
    driven = set()
    try:
        if asked.what == "check":
            sys.exit(1 if printed(pages) or check(pages, asked.replications, asked.jobs) else 0)
        if asked.what == "printed":
            sys.exit(1 if printed(pages) else 0)
        for page in pages:
            for one in page.all_seeds() if asked.what == "drive" else []:
                if one.driven not in driven:  # pages may share an experiment
                    driven.add(one.driven)
                    shutil.rmtree(one.driven, ignore_errors=True)
                    as_expected = drive(one.experiment, one.options, one.driven, asked.jobs)
                    verdict = "as expected" if as_expected else "AN EXPECTATION DOES NOT HOLD"
                    print(f"{page.path.name}{f', seed {one.seed}' if one.seed else ''}: {verdict}", flush=True)
                keep(one)
            page.fill()
    except result_tables.Wrong as wrong:
        sys.exit(f"error: {wrong}")


if __name__ == "__main__":
    main()
