#!/usr/bin/env python3
"""Runs a page as printed: its commands print what the page shows, and its pictures are those that the commands draw.

    page_test.py PROGRAM REPOSITORY PAGE

The commands run in an empty folder with copies of the scenarios, schedules and experiments, and the program in build/release.

    ```console    "$ COMMAND", then what it prints; a line "..." stands for any lines. A command that fails says "exit code N"
                  by an echo of its own.
    ```yaml       behind a line "Create `FILE`": the whole file
    ```diff       behind a line "In `FILE`": the lines with - are there once and give way to those with +

A picture of the page is compared with the file of its name, if a command of the page wrote one. The commands leave nothing that
`git status` would show.
"""
import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

import clone

FENCE = re.compile(r"(?P<before>[^\n]*)\n\n?```(?P<kind>\w+)\n(?P<text>.*?)^```$", re.DOTALL | re.MULTILINE)


class Failure(Exception):
    """The page differs from its commands' results."""


def place(lines: list[str], part: list[str], start: int) -> int | None:
    """Where `part` stands in `lines`, from `start` on."""
    return next((at for at in range(start, len(lines) - len(part) + 1) if lines[at:at + len(part)] == part), None)


def matches(shown: list[str], printed: list[str]) -> bool:
    parts = [[]]
    for line in shown:
        if line == "...":
            parts.append([])
        else:
            parts[-1].append(line)
    if len(parts) == 1:
        return shown == printed
    first, *between, last = parts
    if len(first) + len(last) > len(printed) or printed[:len(first)] != first or printed[len(printed) - len(last):] != last:
        return False
    at, end = len(first), len(printed) - len(last)
    for part in between:
        at = place(printed[:end], part, at)
        if at is None:
            return False
        at += len(part)
    return True


def run_commands(text: str, folder: pathlib.Path) -> int:
    """Runs a console block; how many commands it has."""
    commands = []
    for line in text.splitlines():
        if line.startswith("$ "):
            commands.append((line[2:], []))
        elif commands:
            commands[-1][1].append(line)
        else:
            raise Failure(f"a console block begins without a command: {line}")
    for command, shown in commands:
        run = subprocess.run(["bash", "-c", command], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        printed = run.stdout.splitlines()
        if run.returncode != 0:
            raise Failure(f"{command}\nends with {run.returncode}:\n{run.stdout}")
        if not matches(shown, printed):
            raise Failure("\n".join([command, *difflib.unified_diff(shown, printed, "the page", "printed", lineterm="")]))
    return len(commands)


def edit(text: str, file: pathlib.Path) -> None:
    """Replaces each group of - lines by the + lines behind it."""
    groups = []
    for line in text.splitlines():
        if line[:1] not in ("+", "-") or (line[0] == "+" and not groups):
            raise Failure(f"a diff block has a line without + or -, or + before -: {line}")
        if line[0] == "-" and (not groups or groups[-1][1]):
            groups.append(([], []))
        groups[-1][0 if line[0] == "-" else 1].append(line[1:] + "\n")
    content = file.read_text()
    for old, new in groups:
        if content.count("".join(old)) != 1:
            raise Failure(f"{file.name} has {content.count(''.join(old))} times: {''.join(old)}")
        content = content.replace("".join(old), "".join(new))
    file.write_text(content)


def compare_pictures(page: pathlib.Path, folder: pathlib.Path) -> None:
    for target in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page.read_text()):
        for drawn in folder.rglob(pathlib.Path(target).name):
            if drawn.read_bytes() != (page.parent / target).read_bytes():
                raise Failure(f"{target} is not the picture that the page's command draws")


def run_page(program: pathlib.Path, repository: pathlib.Path, page: pathlib.Path, folder: pathlib.Path) -> int:
    clone.make(folder, repository, program)
    commands = 0
    for block in FENCE.finditer(page.read_text()):
        named = re.search(r"\b(Create|In) `([^`]+)`", block["before"])
        if block["kind"] == "console":
            commands += run_commands(block["text"], folder)
        elif block["kind"] == "yaml" and named:
            (folder / named[2]).write_text(block["text"])
        elif block["kind"] == "diff":
            if not named:
                raise Failure(f"a diff block does not say of which file: {block['text']}")
            edit(block["text"], folder / named[2])
    if not commands:
        raise Failure("the page has no commands")
    compare_pictures(page, folder)
    if left := clone.litter(folder):
        raise Failure(f"the commands leave what git does not ignore:\n{left}")
    return commands


def main() -> int:
    program, repository = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as folder:
        try:
            commands = run_page(program, repository, repository / sys.argv[3], pathlib.Path(folder))
        except Failure as failure:
            print(f"FAILED: {sys.argv[3]}: {failure}")
            return 1
    print(f"{sys.argv[3]}: {commands} commands do what the page shows")
    return 0


if __name__ == "__main__":
    sys.exit(main())
