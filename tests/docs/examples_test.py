#!/usr/bin/env python3
"""Runs every example of every --help in a folder like a clone. Each does its work and says which file it wrote, and all leave
nothing that `git status` would show.

    examples_test.py PROGRAM REPOSITORY
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import yaml

import clone

LEFT_OUT = {
    r"^ttfusion node .*--virtual-time": "waits for the processes of the other nodes",
    r"--bus socketcan": "needs CANs, and the processes of the other nodes",
    r"^mpirun": "needs MPI, which refuses root",
    r"^ttfusion keys --format markdown -o out/keys$": "tests/keys compares the pages that it writes",
    r"^ttfusion schedule synthesize schedules/plans/paper.yaml --binding --trade-off out/trade_off.svg$":
        "tests/cli/schedule_synthesize_test.sh runs it, and compares the picture",
}
FIRST = ["run", "experiment"]   # other examples read their output
# Beside them: a log, folders of results, and a launch's folder.
BEFORE = ["ttfusion run scenarios/cold_start.yaml --strategy tt --no-pictures",
          *(f"ttfusion run scenarios/paper_scenario1.yaml --strategy tt --no-pictures --seed {n} --out out/seed{n}"
            for n in (1, 2, 3)),
          "mkdir out/launch && cp out/seed1/tt.mcap out/launch"]


def shorten(folder: pathlib.Path) -> None:
    """A sweep of seconds instead of an hour, with all that examples name: point 3, TT, replication 17."""
    file = folder / "experiments/process_noise.yaml"
    sweep = yaml.safe_load(file.read_text())
    sweep["replications"] = 18
    sweep["paradigms"] = {name: sweep["paradigms"][name] for name in ("adva", "tt")}
    settings = sweep["axes"]["density"]["settings"]
    sweep["axes"]["density"]["settings"] = dict(list(settings.items())[:4])
    del sweep["expect"]
    file.write_text(yaml.safe_dump(sweep, sort_keys=False))
    scenario = folder / "scenarios/dynamics.yaml"
    text = re.sub("^duration: .*", "duration: 500 ms", scenario.read_text(), flags=re.MULTILINE)
    scenario.write_text(re.sub("^evaluate_from: .*", "evaluate_from: 400 ms", text, flags=re.MULTILINE))


def help_of(program: pathlib.Path, *command: str) -> str:
    return subprocess.run([program, *command, "--help"], check=True, capture_output=True, text=True).stdout


def commands(program: pathlib.Path, *command: str) -> list[tuple[str, ...]]:
    """All commands that have no commands of their own."""
    _, _, listed = help_of(program, *command).partition("Subcommands:\n")
    names = re.findall(r"^  (\w+)", listed.split("\n\n")[0], re.MULTILINE)
    return [inner for name in names for inner in commands(program, *command, name)] if names else [command]


def examples(text: str) -> list[str]:
    """The lines behind "Example:" or "Examples:" to the end of a help; a backslash joins two."""
    found = re.search(r"^Examples?: (.*)", text, re.DOTALL | re.MULTILINE)
    lines = found[1].replace("\\\n", " ").splitlines() if found else []
    return [" ".join(line.split()) for line in lines if line.strip()]


def run(folder: pathlib.Path, command: str) -> str:
    """Returns its words on standard error; exits where it fails."""
    path = f"{folder / 'build/release'}:{os.environ['PATH']}"
    done = subprocess.run(["bash", "-c", command], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True,
                          text=True, timeout=300, check=False)
    if done.returncode != 0:
        sys.exit(f"FAILED: {command}\nends with {done.returncode}: {done.stdout[-2000:]}{done.stderr}")
    return done.stderr


def written(command: str) -> str | None:
    """The file or folder that the command writes, if it names one."""
    words = shlex.split(command)
    named = next((word for option, word in zip(words, words[1:]) if option in ("-o", "--out")), None)
    return None if "--dry-run" in words else named


def main() -> int:
    program, repository = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    listed = sorted(commands(program), key=lambda command: FIRST.index(command[0]) if command[0] in FIRST else len(FIRST))
    count = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        clone.make(folder, repository, program)
        shorten(folder)
        page = (repository / "docs/use/track.md").read_text()
        (folder / "observations.csv").write_text(re.search(r"```\w*\n(time,.*?)```", page, re.DOTALL)[1])
        # Scans of a car's rear, 20 m ahead and more.
        returns = "".join(f"{frame},{20 + frame},{0.2 * k:.1f}\n" for frame in range(8) for k in range(-4, 5))
        (folder / "scans.csv").write_text("frame,x,y\n" + returns)
        clone.git(folder, "add", "--all")
        for command in BEFORE:
            run(folder, command)
        for command in listed:
            of_command = examples(help_of(program, *command))
            if not of_command:
                sys.exit(f"FAILED: {' '.join(command)} --help has no example")
            for example in of_command:
                if reason := next((why for pattern, why in LEFT_OUT.items() if re.search(pattern, example)), None):
                    print(f"not run, {reason}: {example}")
                    continue
                said = run(folder, example)
                file = written(example)
                if file and not re.search(rf"^wrote {re.escape(file)}(:|$)", said, re.MULTILINE):
                    sys.exit(f"FAILED: {example}\ndoes not say that it wrote {file}: {said}")
                count += 1
        if left := clone.litter(folder):
            sys.exit(f"FAILED: the examples leave what git does not ignore:\n{left}")
    print(f"{count} examples of {len(listed)} commands do their work")
    return 0


if __name__ == "__main__":
    sys.exit(main())
