#!/usr/bin/env python3
"""Checks that every include obeys the house's table: who may know whom. Held here, once; runs as a test."""

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
ALLOWED["cli"] = [room for room in ALLOWED]
ALLOWED["tests"] = [room for room in ALLOWED]
THREADS_ALLOWED = ["nodes/runner", "bus/socketcan", "bus/dds", "experiments", "tests"]

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
THREAD = re.compile(r"^\s*#\s*include\s+<(thread|mutex|future|atomic|condition_variable)>", re.MULTILINE)


def room_of(path: str) -> str | None:
    matches = [room for room in ALLOWED if path == room or path.startswith(room + "/")]
    return max(matches, key=len) if matches else None


def problems(root: pathlib.Path) -> list[str]:
    found = []
    for room in ALLOWED:
        for file in sorted((root / room).rglob("*")):
            if file.suffix not in (".h", ".cc") or not file.is_file():
                continue
            name = file.relative_to(root).as_posix()
            if room_of(name) != room:
                continue
            text = file.read_text(encoding="utf-8")
            for include in INCLUDE.findall(text):
                target = room_of(include)
                if target is None:
                    generated = include.endswith(".pb.h")
                    if not generated and not (root / include).exists():
                        found.append(f'{name}: "{include}" is in no room: includes start with the folder\'s name')
                elif target != room and target not in ALLOWED[room]:
                    found.append(f'{name}: {room} may not include {target} ("{include}")')
            if THREAD.search(text) and not any(name.startswith(prefix) for prefix in THREADS_ALLOWED):
                found.append(f"{name}: threads live only in the runner, the media, the log writer and the sweep engine")
    for room, targets in ALLOWED.items():
        for target in targets:
            if room in ALLOWED.get(target, []) and room not in ("cli", "tests"):
                found.append(f"table: {room} and {target} may include each other")
    return found


if __name__ == "__main__":
    top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    result = problems(top)
    print("\n".join(result) or "layers: every include obeys the table")
    sys.exit(1 if result else 0)
