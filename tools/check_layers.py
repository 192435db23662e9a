#!/usr/bin/env python3
"""Compares every source with the house's table, tools/house.toml: which room may include which, and by which doors. A test.

    check_layers.py [REPOSITORY]      exit 1 and one line for every problem

Between rooms, the rule covers every header that a file sees, directly or through others. Between sub-rooms and at doors, it
covers the file's own includes. Every source lies in a room. The project's own headers are included with quotes, by their path
from the top. A source's namespace is its path (core/ is ttf itself); a test has the namespace of the folder that it mirrors.
No source calls a C function whose state threads share.
tests/tools/check_layers_test.py tries the ways around.
"""

import pathlib
import re
import sys
import tomllib

MOST_SOURCES = 25
THREAD_HEADERS = {"thread", "mutex", "shared_mutex", "future", "atomic", "condition_variable", "semaphore", "latch",
                  "barrier", "stop_token", "execution", "pthread.h", "threads.h", "stdatomic.h", "omp.h"}
# C functions whose state threads share. Values: replacements.
SHARED_STATE = {"lgamma": "lgamma_r", "lgammaf": "lgammaf_r", "strerror": "ttf::system_message", "strsignal": "sigdescr_np",
                "gmtime": "gmtime_r", "localtime": "localtime_r", "ctime": "strftime", "asctime": "strftime",
                "strtok": "strtok_r", "rand": "ttf::RandomStream", "srand": "ttf::RandomStream",
                "drand48": "ttf::RandomStream", "setlocale": "newlocale", "gethostbyname": "getaddrinfo"}
# Folders that tests share; they mirror no room.
SHARED_TESTS = {"laws", "support", "golden", "bench", "fuzz", "tools", "test_bed"}

SOURCES = {".h", ".cc"}
MAY_BE_IN_C = {"examples", "tests"}   # steps of libraries, as users write them
OTHER_SOURCES = {".c", ".cpp", ".cxx", ".c++", ".hh", ".hpp", ".hxx", ".inc", ".inl", ".ipp", ".tcc", ".cppm", ".ixx"}
MADE = {"build", "out", "tools/js/node_modules"}   # generated files; hidden folders at the top are left out, too

# Comments, strings (which may look like comments), and directives.
TOKEN = re.compile(r'''R"(?P<mark>[^(\s"]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/''', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*(?:#|%:|\?\?=)[ \t]*(?:include_next|include|import)\b[ \t]*(.*)$", re.MULTILINE)


class House:
    """The table, and the rules that follow from it."""

    def __init__(self, table: dict):
        self.allowed = {room: list(rooms) for room, rooms in table["may_include"].items()}
        for leaf, room in table.get("leaves", {}).items():
            self.allowed[leaf] = self.allowed[room] + [room]
        everything = list(self.allowed)
        self.allowed["cli"] = everything
        self.allowed["tests"] = everything + ["cli"]
        self.sub_rooms = table.get("sub_rooms", {})
        self.doors = table.get("doors", {})
        self.threads = table.get("threads", {}).get("allowed", [])
        self.many_sources = table.get("more_than_25_sources", {})

    def room_of(self, path: str) -> str | None:
        matches = [room for room in self.allowed if path.startswith(room + "/")]
        return max(matches, key=len) if matches else None

    def sub_room_of(self, path: str) -> str | None:
        """The room's own name for a file in its own folder."""
        room = self.room_of(path)
        if room is None:
            return None
        rest = path[len(room) + 1:].split("/")
        return room if len(rest) == 1 else f"{room}/{rest[0]}"

    def may_use_threads(self, name: str) -> bool:
        return any(name == place or name.startswith(place + "/") for place in self.threads)

    def place(self, sub_room: str, room: str) -> int | None:
        """How high a sub-room lies in its room."""
        name = "." if sub_room == room else sub_room[len(room) + 1:]
        order = self.sub_rooms.get(room, ["."])
        return order.index(name) if name in order else None


def read_house() -> House:
    with open(pathlib.Path(__file__).parent / "house.toml", "rb") as file:
        return House(tomllib.load(file))


def directives(text: str) -> list[str]:
    """Returns each #include's argument; comments are removed and continued lines joined."""
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


def include_problem(house: House, root: pathlib.Path, include: str) -> str | None:
    """Returns the problem of a quoted include, or None. The including file does not matter."""
    parts = include.split("/")
    if house.room_of(include) is None or "." in parts or ".." in parts or "" in parts:
        return "is in no room: includes start with the folder's name"
    if not include.endswith(".h"):
        return "is no header"
    generated = (include.endswith(".pb.h") and (root / include).with_suffix("").with_suffix(".proto").is_file()
                 or (root / include).with_suffix(".idl").is_file())
    if not generated and not (root / include).is_file():
        return "is not there"
    return None


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


def inside_problems(house: House, name: str, include: str) -> list[str]:
    """Between sub-rooms: never upwards within a room, and through doors alone."""
    room, target_room = house.room_of(name), house.room_of(include)
    own, target = house.sub_room_of(name), house.sub_room_of(include)
    if room == "tests" or own == target:
        return []
    found = []
    if room == target_room:
        here, there = house.place(own, room), house.place(target, room)
        if here is not None and there is not None and there > here:
            found.append(f'{name}: {own} may not include {target} ("{include}"), which lies above it')
    if target in house.doors and include[len(target) + 1:] not in house.doors[target]:
        found.append(f'{name}: "{include}" is no door of {target}')
    return found


def folder_problems(house: House, files: list[str]) -> list[str]:
    found = []
    folders = {}
    for name in files:
        folders.setdefault(name.rsplit("/", 1)[0], []).append(name)
    for folder, sources in sorted(folders.items()):
        room = house.room_of(folder + "/x")
        if room is None:
            continue
        if len(sources) > MOST_SOURCES and not folder.startswith("tests/") and folder not in house.many_sources:
            found.append(f"{folder}: {len(sources)} sources in a folder; at most {MOST_SOURCES}, or a reason in tools/house.toml")
        sub_room = house.sub_room_of(folder + "/x")
        if room in house.sub_rooms and house.place(sub_room, room) is None:
            found.append(f"{folder}: {sub_room} is no sub-room in tools/house.toml")
        parts = folder.split("/")[1:]
        if room == "tests" and parts and parts[0] not in SHARED_TESTS:
            rooms = house.allowed.keys() | house.doors.keys()
            if not any("/".join(parts[:length]) in rooms for length in (len(parts), len(parts) - 1)):
                found.append(f"{folder}: mirrors no room")
    for folder in house.many_sources:
        if len(folders.get(folder, [])) <= MOST_SOURCES:
            found.append(f"tools/house.toml: {folder} needs no reason")
    return found


CALL = re.compile(rf"(?<![\w.>])(?:std::|::)?\b({'|'.join(SHARED_STATE)})\s*\(")


def shared_state_problems(name: str, text: str) -> list[str]:
    """Sweeps, runners, media and the log writer are threads."""
    if name.startswith("tests/"):
        return []
    code = TOKEN.sub(" ", text)
    return [f"{name}: {call}() keeps a state that threads share: {SHARED_STATE[call]}() does not"
            for call in sorted(set(CALL.findall(code)))]


NAMESPACE = re.compile(r"^namespace (ttf(?:::\w+)*) \{(.*?)^\}", re.MULTILINE | re.DOTALL)
DEFINITION = re.compile(r"[{=]")


def namespace_problems(name: str, text: str) -> list[str]:
    """A source declares names of its own path's namespace alone; of others it may only say what there is."""
    parts = name.split("/")[:-1]
    if parts[0] == "tests" and parts[1:2] and parts[1] in SHARED_TESTS:
        return []   # shared helpers stand beside the code they serve
    own = {"::".join(["ttf"] + (parts[1:] if parts[0] in ("core", "tests") else parts))}
    if parts[0] == "tests":
        own.add("ttf::laws")   # laws are instantiated where they are
        if parts[1:2] == ["core"]:
            own.add("ttf")
    return [f"{name}: namespace {space} is not its path's" for space, body in NAMESPACE.findall(text)
            if space not in own and DEFINITION.search(body)]


def problems(root: pathlib.Path, house: House) -> list[str]:
    found = circles(house.allowed)
    quoted = {}
    files = source_files(root)
    for file in files:
        name = file.relative_to(root).as_posix()
        if house.room_of(name) is None:
            found.append(f"{name}: is in no room")
            continue
        if file.suffix not in SOURCES and not (file.suffix == ".c" and house.room_of(name) in MAY_BE_IN_C):
            found.append(f"{name}: sources are .h and .cc")
        quoted[name] = []
        text = file.read_text(encoding="utf-8")
        found += namespace_problems(name, text)
        found += shared_state_problems(name, text)
        for argument in directives(text):
            if quotes := re.fullmatch(r'"([^"]+)"', argument):
                if problem := include_problem(house, root, quotes[1]):
                    found.append(f'{name}: "{quotes[1]}" {problem}')
                else:
                    quoted[name].append(quotes[1])
                    found += inside_problems(house, name, quotes[1])
            elif angles := re.fullmatch(r"<([^>]+)>", argument):
                parts = angles[1].split("/")
                if ".." in parts or "." in parts or "" in parts or (root / angles[1]).exists() or house.room_of(angles[1]):
                    found.append(f"{name}: <{angles[1]}>: the project's own headers are included with quotes")
                if angles[1] in THREAD_HEADERS and not house.may_use_threads(name):
                    found.append(f"{name}: <{angles[1]}>: threads live only in the runner, the media, the log writer and "
                                 "the sweep engine")
            else:
                found.append(f"{name}: #include {argument}: includes name a file")
    for name in quoted:
        room = house.room_of(name)
        for include, way in seen_from(name, quoted).items():
            target = house.room_of(include)
            if target != room and target not in house.allowed[room]:
                over = f" over {', '.join(way)}" if way else ""
                found.append(f'{name}: {room} may not include {target} ("{include}"{over})')
    return found + folder_problems(house, list(quoted))


if __name__ == "__main__":
    top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    result = problems(top, read_house())
    print("\n".join(result) or "layers: every include obeys the table")
    sys.exit(1 if result else 0)
