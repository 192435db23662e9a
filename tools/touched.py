#!/usr/bin/env python3
"""Prints which tests a change touches, each with the targets that it needs, or which of some targets.

    touched.py BUILD COMMIT [OPTION...]   of the tests that these options of ctest choose: one line each, its name and its targets
    touched.py BUILD COMMIT TARGET...     of these targets

A change is what differs from COMMIT. Without COMMIT ('') everything is touched. A program is touched if one of these differs:
a source of it or of its modules, a header that one of them sees, directly or through others, or the CMakeLists.txt of a folder
above one of them. Comments of CMake's files do not count. A script's test is touched with the programs that it gets, and by all files of the script's folder but C++.
Every other file but Markdown and tools touches everything: data, pages, CMake's own. Tests that get nothing of the build folder are
left out: they are the same in every build. The build folder must be configured.
"""
import functools
import json
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
CODE = (".cc", ".cxx", ".c", ".h", ".proto", ".idl")
FOR_ALL = ("cmake/", "CMakeLists.txt", "CMakePresets.json", "tools/build.sh", "tools/install_deps.sh")   # beginnings of paths
FOR_NONE = (".ci/", "docs/", "tools/")   # the quick tests have what looks at these
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
# CMake has comments in lines of their own, and behind commands. A text in quotation marks is none, and stays.
COMMENT = re.compile(r'("(?:\\.|[^"\\])*")|^[ \t]*#[^\n]*\n|[ \t]*#[^\n]*', re.MULTILINE)


def output(*command):
    return subprocess.run(command, cwd=TOP, check=True, capture_output=True, text=True).stdout


def says_another(file, commit):
    """Whether a file that differs from the commit's differs in more than CMake's comments."""
    if not file.endswith((".cmake", "CMakeLists.txt")) or not (TOP / file).is_file():
        return True
    before = subprocess.run(["git", "show", f"{commit}:{file}"], cwd=TOP, capture_output=True, text=True, check=False).stdout
    now = (TOP / file).read_text(encoding="utf-8")
    return COMMENT.sub(r"\1", before) != COMMENT.sub(r"\1", now)


class Touched:
    def __init__(self, build, commit):
        self.build = build
        changed = output("git", "diff", "--name-only", commit).split() if commit else []
        self.changed = {file for file in changed if says_another(file, commit)}
        self.lists = {TOP / file for file in self.changed if file.endswith("/CMakeLists.txt")}
        self.all = not commit or any(map(self.is_for_all, self.changed))
        self.known = {line.split(":")[0] for line in output("ninja", "-C", build, "-t", "targets", "all").splitlines()}

    @staticmethod
    def is_for_all(file):
        if file.startswith(FOR_ALL):
            return True
        of_a_script = file.startswith("tests/") and file.endswith((".sh", ".py"))
        return not (file.startswith(FOR_NONE) or file.endswith((*CODE, ".md", "CMakeLists.txt")) or of_a_script)

    @functools.cache
    def seen_from(self, file):
        """The files that a file includes, as far as they are the project's or the generator's."""
        if not file.is_file():
            return frozenset()
        names = INCLUDE.findall(file.read_text(encoding="utf-8", errors="replace"))
        return frozenset(TOP / name if (TOP / name).is_file() else file.parent / name for name in names)

    @functools.cache
    def program_is(self, target):
        """Whether a program or library is touched. Sources of a unity file are what it includes."""
        if self.all:
            return True
        inputs = [(self.build / one).resolve() for one in output("ninja", "-C", self.build, "-t", "inputs", target).splitlines()]
        open_files = [file for file in inputs if file.suffix in CODE]
        seen = set(open_files)
        while open_files:
            for file in self.seen_from(open_files.pop()):
                if (file := file.resolve()) not in seen:
                    seen.add(file)
                    open_files.append(file)
        return any(file.relative_to(TOP).as_posix() in self.changed for file in seen if file.is_relative_to(TOP)) or any(
            file.is_relative_to(listed.parent) for listed in self.lists for file in seen)

    def script_is(self, script):
        """Whether a file beside a script differs that is no C++: it may use it."""
        folder = script.relative_to(TOP).parent.as_posix()
        return any(file.rpartition("/")[0] == folder and not file.endswith(CODE) for file in self.changed)

    def targets_of(self, word):
        """The target of this name, or all libraries in the folder: a program loads them."""
        return [word] if word in self.known else sorted(
            target for target in self.known if target.endswith(".so") and target.rpartition("/")[0] == word)

    def tests(self, options):
        listed = json.loads(output("ctest", "--test-dir", self.build, "--show-only=json-v1", *options))["tests"]
        for test in listed:
            # A program that is not built yet has no command.
            words = [pathlib.Path(word) for word in test.get("command", [])] or [pathlib.Path(test["name"])]
            targets = [str(word.relative_to(self.build)) for word in words if word.is_relative_to(self.build)]
            targets = [target for word in targets + [word.name for word in words[:1]] for target in self.targets_of(word)]
            scripts = [word for word in words if word.suffix in (".sh", ".py") and word.is_relative_to(TOP)]
            if targets and (self.all or any(map(self.script_is, scripts)) or any(map(self.program_is, targets))):
                yield test["name"], targets


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    build, commit, *rest = sys.argv[1:]
    touched = Touched(pathlib.Path(build).resolve(), commit)
    if not rest or rest[0].startswith("-"):
        for name, targets in touched.tests(rest):
            print(name, *targets)
        return
    for target in rest:
        if target not in touched.known:
            sys.exit(f"error: {build} has no target {target}")
        if touched.program_is(target):
            print(target)


if __name__ == "__main__":
    main()
