#!/usr/bin/env python3
"""The faults of docs/fusion/closed_loop.md cost what its table says: each line is driven with each reaction.

    closed_loop_test.py PROGRAM REPOSITORY            compare; exit 1 and print the difference
    closed_loop_test.py PROGRAM REPOSITORY --update   write the table anew

A fault is a line of the page's `faults:` block. The drive is the page's scenario, with TT and its own seed.
"""
import difflib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SCENARIO = "scenarios/acc_braking_lead.yaml"
REACTIONS = ("brake", "hold", "decay")
BLOCK = re.compile(r"```yaml\nfaults:\n(.*?)```", re.DOTALL)
TABLE = re.compile(r"\| fault \|[^\n]*\n\|---[^\n]*\n(?:\|[^\n]*\n)+")


def faults_of(page):
    """(name, line) of each fault."""
    lines = [line.strip() for line in BLOCK.search(page)[1].splitlines() if line.strip()]
    found = [("none", None)]
    for line in lines:
        kind, node = (re.search(rf"{key}: (\w+)", line)[1] for key in ("kind", "node"))
        found.append((f"`{kind}` of `{node}`", line.partition("#")[0].strip()))
    return found


def driven(program, repository, line, reaction):
    text = (repository / SCENARIO).read_text(encoding="utf-8")
    assert text.count("reaction: brake") == 1
    text = text.replace("reaction: brake", f"reaction: {reaction}").replace("../", f"{repository}/")
    if line:
        text += f"faults:\n  {line}\n"
    with tempfile.TemporaryDirectory() as folder:
        scenario = pathlib.Path(folder) / "drive.yaml"
        scenario.write_text(text, encoding="utf-8")
        # Exit code 1 says that the fault showed.
        run = subprocess.run([program, "run", scenario, "--strategy", "tt", "--no-pictures", "--json", "--out", folder],
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if run.returncode not in (0, 1) or not run.stdout:
        sys.exit(f"{line}: {run.stderr}")
    return json.loads(run.stdout)["strategies"][0]["driving"]


def cell(driving):
    if driving["collision"]:
        return f"collision with {driving['collision']['closing_mps']:.1f} m/s"
    stop = driving["stopping_distance_m"]
    return f"{driving['smallest_gap_m']:.2f}, " + ("does not stop" if stop is None else f"{stop:.2f}")


def table(program, repository, page):
    rows = ["| fault | `brake`: gap, stopping distance [m] | `hold` | `decay` |", "|---|---|---|---|"]
    for name, line in faults_of(page):
        cells = [cell(driven(program, repository, line, reaction)) for reaction in REACTIONS]
        rows.append("| " + " | ".join([name, *cells]) + " |")
    return "".join(row + "\n" for row in rows)


def main():
    program, repository = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    path = repository / "docs/fusion/closed_loop.md"
    page = path.read_text(encoding="utf-8")
    shown, now = TABLE.search(page)[0], table(program, repository, page)
    sys.stdout.writelines(difflib.unified_diff(shown.splitlines(True), now.splitlines(True), "docs/fusion/closed_loop.md", "driven"))
    if sys.argv[3:] == ["--update"]:
        path.write_text(page.replace(shown, now), encoding="utf-8")
        return 0
    return 0 if shown == now else 1


if __name__ == "__main__":
    sys.exit(main())
