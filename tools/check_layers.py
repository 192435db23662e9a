#!/usr/bin/env python3
"""Checks that every include obeys the house's table: who may know whom. Held here, once; runs as a test.

    check_layers.py [REPOSITORY]      exit 1 and one line for every problem

What counts is what a file sees, through other headers too. Every source file lies in a room; the project's own headers are
included with quotes, by their path from the top, and nothing else is. tests/tools/check_layers_test.py tries the ways around.
"""

import pathlib
import re
import sys

# Room -> rooms it may include. The longest matching prefix of a file's path is its room.
CORE = ["core"]
RECORDS = "recording/records"
ALLOWED = {
    "core": [],
    "timebase": CORE,
    "schedules": CORE,
    "fusion": CORE,
    "recording/records": CORE,
    "bus/wire": CORE + ["schedules"],
    "bus": CORE + ["timebase", "schedules", "bus/wire", RECORDS],
    "recording": CORE + ["schedules", "bus/wire", RECORDS],
    "sim/world": CORE + ["bus/wire"],
    "nodes": CORE + ["timebase", "schedules", "fusion", RECORDS, "bus/wire", "bus", "recording", "sim/world"],
    "sim": CORE + ["timebase", "schedules", "fusion", RECORDS, "bus/wire", "bus", "recording", "sim/world", "nodes"],
    "experiments/results": CORE,
    "experiments": CORE + ["timebase", "schedules", "fusion", RECORDS, "bus/wire", "bus", "recording", "sim/world",
                           "nodes", "sim", "experiments/results"],
    "report": CORE + ["schedules", "recording", RECORDS, "experiments/results"],
}
# Leaves: rooms nobody but the program and the tests may name.
ALLOWED["bus/socketcan"] = ALLOWED["bus"] + ["bus"]
ALLOWED["bus/dds"] = ALLOWED["bus"] + ["bus"]
ALLOWED["bus/dds/ros"] = ALLOWED["bus/dds"] + ["bus/dds"]
ALLOWED["nodes/runner"] = ALLOWED["nodes"] + ["nodes"]
ALLOWED["experiments/mpi"] = ALLOWED["experiments"] + ["experiments"]
ALLOWED["cli"] = [room for room in ALLOWED]
ALLOWED["tests"] = [room for room in ALLOWED]

# Threads live only in the runner, the media, the log writer and the sweep engine: folders, or files by their name.
THREADS_ALLOWED = ["nodes/runner", "bus/socketcan", "bus/dds", "recording/log_behind.h", "recording/log_behind.cc", "recording/log_writer.cc",
                   "experiments", "tests"]
THREAD_HEADERS = {"thread", "mutex", "shared_mutex", "future", "atomic", "condition_variable", "semaphore", "latch",
                  "barrier", "stop_token", "execution", "pthread.h", "threads.h", "stdatomic.h", "omp.h"}

SOURCES = {".h", ".cc"}
OTHER_SOURCES = {".c", ".cpp", ".cxx", ".c++", ".hh", ".hpp", ".hxx", ".inc", ".inl", ".ipp", ".tcc", ".cppm", ".ixx"}
MADE = {"build", "out", "tools/js/node_modules"}   # not written by hand; nor is what hidden folders at the top hold

# Comments, and what could be mistaken for one; then directives.
TOKEN = re.compile(r'''R"(?P<mark>[^(\s"]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/''', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*(?:#|%:|\?\?=)[ \t]*(?:include_next|include|import)\b[ \t]*(.*)$", re.MULTILINE)


def room_of(path: str) -> str | None:
    matches = [room for room in ALLOWED if path.startswith(room + "/")]
    return max(matches, key=len) if matches else None


def directives(text: str) -> list[str]:
    """What follows each #include, without comments and continued lines."""
    text = re.sub(r"\\\r?\n", "", text)
    text = TOKEN.sub(lambda token: " " if token[0].startswith("/") else token[0], text)
    return [argument.strip() for argument in DIRECTIVE.findall(text)]


def source_files(root: pathlib.Path, folder: str = "") -> list[pathlib.Path]:
    found = []
    for entry in sorted((root / folder).iterdir()):
        name = entry.relative_to(root).as_posix()
        if name in MADE or name.startswith("."):
            continue
        if entry.is_dir():
            found += source_files(root, name)
        elif entry.suffix.lower() in SOURCES | OTHER_SOURCES:
            found.append(entry)
    return found


def include_problem(root: pathlib.Path, include: str) -> str | None:
    """What is wrong with a quoted include, whoever it belongs to."""
    parts = include.split("/")
    if room_of(include) is None or "." in parts or ".." in parts or "" in parts:
        return "is in no room: includes start with the folder's name"
    if not include.endswith(".h"):
        return "is no header"
    generated = (include.endswith(".pb.h") and (root / include).with_suffix("").with_suffix(".proto").is_file()
                 or (root / include).with_suffix(".idl").is_file())
    if not generated and not (root / include).is_file():
        return "is not there"
    return None


def may_use_threads(name: str) -> bool:
    return any(name == place or name.startswith(place + "/") for place in THREADS_ALLOWED)


def seen_from(name: str, quoted: dict[str, list[str]]) -> dict[str, list[str]]:
    """Every header a file sees, with the way to it: the headers in between."""
    ways = {}
    waiting = [(include, []) for include in quoted.get(name, [])]
    while waiting:
        include, way = waiting.pop(0)
        if include in ways:
            continue
        ways[include] = way
        waiting += [(further, way + [include]) for further in quoted.get(include, [])]
    return ways


def circles(allowed: dict[str, list[str]]) -> list[str]:
    """Rooms that may, by whatever way, include themselves."""
    found = []
    for room in allowed:
        reached, waiting = set(), list(allowed[room])
        while waiting:
            target = waiting.pop()
            if target not in reached:
                reached.add(target)
                waiting += allowed.get(target, [])
        if room in reached:
            found.append(f"table: {room} may include itself, over other rooms")
    return found


def problems(root: pathlib.Path) -> list[str]:
    found = circles(ALLOWED)
    quoted = {}
    for file in source_files(root):
        name = file.relative_to(root).as_posix()
        if room_of(name) is None:
            found.append(f"{name}: is in no room")
            continue
        if file.suffix not in SOURCES:
            found.append(f"{name}: sources are .h and .cc")
        quoted[name] = []
        for argument in directives(file.read_text(encoding="utf-8")):
            if quotes := re.fullmatch(r'"([^"]+)"', argument):
                if problem := include_problem(root, quotes[1]):
                    found.append(f'{name}: "{quotes[1]}" {problem}')
                else:
                    quoted[name].append(quotes[1])
            elif angles := re.fullmatch(r"<([^>]+)>", argument):
                parts = angles[1].split("/")
                if ".." in parts or "." in parts or "" in parts or (root / angles[1]).exists() or room_of(angles[1]):
                    found.append(f"{name}: <{angles[1]}>: the project's own headers are included with quotes")
                if angles[1] in THREAD_HEADERS and not may_use_threads(name):
                    found.append(f"{name}: <{angles[1]}>: threads live only in the runner, the media, the log writer and "
                                 "the sweep engine")
            else:
                found.append(f"{name}: #include {argument}: includes name a file")
    for name in quoted:
        room = room_of(name)
        for include, way in seen_from(name, quoted).items():
            target = room_of(include)
            if target != room and target not in ALLOWED[room]:
                over = f" over {', '.join(way)}" if way else ""
                found.append(f'{name}: {room} may not include {target} ("{include}"{over})')
    return found


if __name__ == "__main__":
    top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    result = problems(top)
    print("\n".join(result) or "layers: every include obeys the table")
    sys.exit(1 if result else 0)
