#!/usr/bin/env python3
"""Compares every source with the modules' table, tools/modules.toml: which module may include which, and which headers are private. A test.

    check_layers.py [REPOSITORY]                exit 1 and one line for every problem
    check_layers.py --changed [REPOSITORY]      of the files that differ from the last commit alone: a second, before a commit

Between modules, the rule covers every header that a file sees, directly or through others. Between parts and at private headers, it
covers the file's own includes. Every source lies in a module. The project's own headers are included with quotes, by their path
from the top. A source's namespace is its path (core/ is ttf itself); a test has the namespace of the folder that it mirrors.
No source calls a C function whose state threads share.
tests/tools/check_layers_test.py tries the ways around.
"""

import fnmatch
import functools
import pathlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable

MOST_SOURCES = 25
THREAD_HEADERS = {"thread", "mutex", "shared_mutex", "future", "atomic", "condition_variable", "semaphore", "latch",
                  "barrier", "stop_token", "execution", "pthread.h", "threads.h", "stdatomic.h", "omp.h"}
# C functions whose state threads share. Values: replacements.
SHARED_STATE = {"lgamma": "lgamma_r", "lgammaf": "lgammaf_r", "strerror": "ttf::system_message", "strsignal": "sigdescr_np",
                "gmtime": "gmtime_r", "localtime": "localtime_r", "ctime": "strftime", "asctime": "strftime",
                "strtok": "strtok_r", "rand": "ttf::RandomStream", "srand": "ttf::RandomStream",
                "drand48": "ttf::RandomStream", "setlocale": "newlocale", "gethostbyname": "getaddrinfo"}
# Folders that tests share; they mirror no module.
SHARED_TESTS = {"laws", "support", "golden", "bench", "fuzz", "tools", "test_bed"}

SOURCES = {".h", ".cc"}
MAY_BE_IN_C = {"examples", "tests"}   # steps of libraries, as users write them
OTHER_SOURCES = {".c", ".cpp", ".cxx", ".c++", ".hh", ".hpp", ".hxx", ".inc", ".inl", ".ipp", ".tcc", ".cppm", ".ixx"}
MADE = {"build", "out", "tools/js/node_modules"}   # generated files; hidden folders at the top are left out, too

# Comments, strings (which may look like comments), and directives.
TOKEN = re.compile(r'''R"(?P<mark>[^(\s"]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/''', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*(?:#|%:|\?\?=)[ \t]*(?:include_next|include|import)\b[ \t]*(.*)$", re.MULTILINE)


class Modules:
    """The table, and the rules that follow from it."""

    def __init__(self, table: dict):
        self.allowed = {module: list(modules) for module, modules in table["may_include"].items()}
        for leaf, module in table.get("leaves", {}).items():
            self.allowed[leaf] = self.allowed[module] + [module]
        everything = list(self.allowed)
        self.allowed["cli"] = everything
        self.allowed["tests"] = everything + ["cli"]
        self.parts = table.get("parts", {})
        self.private_headers = table.get("private_headers", {})
        self.threads = table.get("threads", {}).get("allowed", [])
        self.many_sources = table.get("more_than_25_sources", {})

    @functools.cache   # each header is seen by many files
    def module_of(self, path: str) -> str | None:
        """The module is a folder, or a header and its source."""
        matches = [module for module in self.allowed if path.startswith(module + "/") or path in (module + ".h", module + ".cc")]
        return max(matches, key=len) if matches else None

    def part_of(self, path: str) -> str | None:
        """The module's own name for a file in its own folder."""
        module = self.module_of(path)
        if module is None:
            return None
        rest = path[len(module) + 1:].split("/")
        return module if len(rest) == 1 else f"{module}/{rest[0]}"

    @functools.cache
    def is_private(self, header: str) -> bool:
        module = self.module_of(header)
        return any(fnmatch.fnmatchcase(header, f"{module}/{name}") for name in self.private_headers.get(module, []))

    def may_use_threads(self, name: str) -> bool:
        return any(name == place or name.startswith(place + "/") for place in self.threads)

    def place(self, part: str, module: str) -> int | None:
        """How high a part lies in its module, or a module in the one around it."""
        name = "." if part == module else part.removeprefix(module + "/")
        order = self.parts.get(module, ["."])
        return order.index(name) if name in order else None


def read_modules() -> Modules:
    with open(pathlib.Path(__file__).parent / "modules.toml", "rb") as file:
        return Modules(tomllib.load(file))


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


def include_problem(table: Modules, root: pathlib.Path, include: str) -> str | None:
    """Returns the problem of a quoted include, or None. The including file does not matter."""
    parts = include.split("/")
    if table.module_of(include) is None or "." in parts or ".." in parts or "" in parts:
        return "is in no module: includes start with the folder's name"
    if not include.endswith(".h"):
        return "is no header"
    generated = (include.endswith(".pb.h") and (root / include).with_suffix("").with_suffix(".proto").is_file()
                 or (root / include).with_suffix(".idl").is_file())
    if not generated and not (root / include).is_file():
        return "is not there"
    return None


def seen_from(name: str, quoted: Callable[[str], list[str]]) -> dict[str, list[str]]:
    """Every header a file sees, with the way to it: the headers in between."""
    ways = {}
    waiting = [(include, []) for include in quoted(name)]
    while waiting:
        include, way = waiting.pop(0)
        if include in ways:
            continue
        ways[include] = way
        waiting += [(further, way + [include]) for further in quoted(include)]
    return ways


def circles(allowed: dict[str, list[str]]) -> list[str]:
    """Modules that may, by whatever way, include themselves."""
    found = []
    for module in allowed:
        reached, waiting = set(), list(allowed[module])
        while waiting:
            target = waiting.pop()
            if target not in reached:
                reached.add(target)
                waiting += allowed.get(target, [])
        if module in reached:
            found.append(f"table: {module} may include itself, over other modules")
    return found


def inside_problems(table: Modules, name: str, include: str) -> list[str]:
    """Between parts: never upwards within a module, and without private headers."""
    module = table.module_of(name)
    own, target = table.part_of(name), table.part_of(include)
    if module == "tests" or own == target:
        return []
    found = []
    if f"{target}/".startswith(f"{module}/"):
        here, there = table.place(own, module), table.place(target, module)
        if here is not None and there is not None and there > here:
            found.append(f'{name}: {own} may not include {target} ("{include}"), which lies above it')
    if table.is_private(include):
        found.append(f'{name}: "{include}" is a private header of {target}')
    return found


def folder_problems(table: Modules, files: list[str]) -> list[str]:
    found = []
    folders = {}
    for name in files:
        folders.setdefault(name.rsplit("/", 1)[0], []).append(name)
    for folder, sources in sorted(folders.items()):
        module = table.module_of(folder + "/x")
        if module is None:
            continue
        if len(sources) > MOST_SOURCES and not folder.startswith("tests/") and folder not in table.many_sources:
            found.append(f"{folder}: {len(sources)} sources in a folder; at most {MOST_SOURCES}, or a reason in tools/modules.toml")
        part = table.part_of(folder + "/x")
        if module in table.parts and table.place(part, module) is None:
            found.append(f"{folder}: {part} is no part in tools/modules.toml")
        parts = folder.split("/")[1:]
        if module == "tests" and parts and parts[0] not in SHARED_TESTS:
            places = table.allowed.keys() | {f"{outer}/{part}" for outer, inner in table.parts.items() for part in inner}
            if not any("/".join(parts[:length]) in places for length in (len(parts), len(parts) - 1)):
                found.append(f"{folder}: mirrors no module")
    for folder in table.many_sources:
        if len(folders.get(folder, [])) <= MOST_SOURCES:
            found.append(f"tools/modules.toml: {folder} needs no reason")
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


def file_problems(table: Modules, root: pathlib.Path, name: str, text: str, quoted: list[str]) -> list[str]:
    """The problems of one source, and in `quoted` the project's own headers that it includes."""
    module = table.module_of(name)
    if module is None:
        return [f"{name}: is in no module"]
    found = []
    suffix = pathlib.PurePath(name).suffix
    if suffix not in SOURCES and not (suffix == ".c" and module in MAY_BE_IN_C):
        found.append(f"{name}: sources are .h and .cc")
    found += namespace_problems(name, text)
    found += shared_state_problems(name, text)
    for argument in directives(text):
        if quotes := re.fullmatch(r'"([^"]+)"', argument):
            if problem := include_problem(table, root, quotes[1]):
                found.append(f'{name}: "{quotes[1]}" {problem}')
            else:
                quoted.append(quotes[1])
                found += inside_problems(table, name, quotes[1])
        elif angles := re.fullmatch(r"<([^>]+)>", argument):
            parts = angles[1].split("/")
            if ".." in parts or "." in parts or "" in parts or (root / angles[1]).exists() or table.module_of(angles[1]):
                found.append(f"{name}: <{angles[1]}>: the project's own headers are included with quotes")
            if angles[1] in THREAD_HEADERS and not table.may_use_threads(name):
                found.append(f"{name}: <{angles[1]}>: threads live only in the runner, the media, the log writer and "
                             "the sweep engine")
        else:
            found.append(f"{name}: #include {argument}: includes name a file")
    return found


class Sources:
    """Reads a source when it is first asked for: its problems, and the project's own headers that it includes."""

    def __init__(self, root: pathlib.Path, table: Modules):
        self.root, self.table, self.read = root, table, {}

    def of(self, name: str) -> tuple[list[str], list[str]]:
        if name not in self.read:
            quoted = []
            file = self.root / name
            found = (file_problems(self.table, self.root, name, file.read_text(encoding="utf-8"), quoted)
                     if file.is_file() else [])   # a generated header
            self.read[name] = (found, quoted)
        return self.read[name]

    def quoted(self, name: str) -> list[str]:
        return self.of(name)[1]


def problems(root: pathlib.Path, table: Modules, only: set[str] | None = None) -> list[str]:
    """Returns the problems of all sources, or of these in `only`."""
    found = circles(table.allowed)
    sources = Sources(root, table)
    names = [file.relative_to(root).as_posix() for file in source_files(root)]
    checked = [name for name in names if only is None or name in only]
    for name in checked:
        found += sources.of(name)[0]
    placed = [name for name in names if table.module_of(name) is not None]
    for name in checked:
        module = table.module_of(name)
        if module is None:
            continue
        for include, way in seen_from(name, sources.quoted).items():
            target = table.module_of(include)
            if target != module and target not in table.allowed[module]:
                over = f" over {', '.join(way)}" if way else ""
                found.append(f'{name}: {module} may not include {target} ("{include}"{over})')
    return found + folder_problems(table, placed)


def changed(root: pathlib.Path) -> set[str]:
    """The files that differ from the last commit."""
    git = ["git", "-C", str(root)]
    said = [subprocess.run(git + command, check=True, capture_output=True, text=True).stdout.splitlines()
            for command in (["diff", "--name-only", "HEAD"], ["ls-files", "--others", "--exclude-standard"])]
    return set(said[0] + said[1])


if __name__ == "__main__":
    arguments = sys.argv[1:]
    part = arguments[:1] == ["--changed"]
    top = pathlib.Path((arguments[part:] or ["."])[0]).resolve()
    result = problems(top, read_modules(), changed(top) if part else None)
    print("\n".join(result) or "layers: every include obeys the table")
    sys.exit(1 if result else 0)
