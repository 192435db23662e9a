#!/usr/bin/env python3
"""Measures the words of comments and documents: how long sentences are, and where a reader stumbles.

    tools/words.py FILE...      for each file: sentences, mean words a sentence, the longest, and each find with its line
    tools/words.py --check      all of the tree against the bounds in tools/words.toml: exit 1 and name what is over
    tools/words.py --changed    the files that differ from the last commit: exit 1 and name each find that the commit has not
    tools/words.py --update     lowers the bounds to the values of today; never raises one

A text is what comments (C++, shell, Python, CMake, YAML) and Markdown pages say in sentences. Code blocks, tables,
drawings and formulas are left out. A sentence ends at a full stop, question or exclamation mark, at a colon that ends a
line, at an empty line, and at each item of a list. A find is a phrase of PHRASES below, a test's name as in TEST_NAME, or
a name of C++ with a verb of PERSON_VERBS.
"""
import re
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter, defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BOUNDS = ROOT / "tools" / "words.toml"

# A phrase, in any case of letters, and the reason why a reader stumbles over it. Only "Not" needs its capital: "not
# stated" behind code describes a name.
PHRASES = [
    (r"^(of|that|nor|lest|hence|(?-i:Not)) ", "a fragment"),
    (r"^(what|who|whoever|whatever|whichever|which) [^?]*$", "a clause as a subject"),
    (r"\bwho(so)?ever\b", "name the actor"),
    (r"\bnobody\b", "say what is empty or absent"),
    (r"\bnone (is|are|was|were|the)\b", "say what is empty or absent"),
    (r"\b(and|or|of|from|for|to|by|with|in|on|than) what\b", "a clause as a noun"),
    (r"\b(that|those|them|he|she|they) who\b", "name the actor"),
    (r"\b(be it|but for|none the less|nonetheless|lest|whence|thereof|therein|wherein|whereof)\b", "an old word"),
]
# A GoogleTest's name begins with its subject: ACarThatGoesRoundKeepsItsName.
TEST_NAME = re.compile(r"^(?:TYPED_)?TEST(?:_[FP])?\(\s*\w+,\s*((?:What|Who)(?:ever|m|se)?(?![a-z])\w*)\s*\)", re.M)
# A machine receives, reports and has (docs/glossary.md); `known` and `unknown` are the field's words. Whole parts of a name.
PERSON_VERBS = {"hear", "hears", "heard", "unheard", "hearing", "hearer", "tell", "tells", "told", "telling", "teller",
                "know", "knows", "knew", "knowing", "learn", "learns", "learned", "learnt", "learning", "learner"}
PERSON_STEM = re.compile(r"hear|tell|told|know(?!n)|knew|learn", re.I)
WIRE_NAMES = {"tells_late"}  # a field of bus/dds/live/live_sample.idl
CODE_SUFFIXES = {".h", ".cc", ".inc"}
HASH_SUFFIXES = {".sh", ".py", ".cmake", ".toml", ".yaml", ".yml"}


def commented(path, marker):
    """Lines (number, text) of comments; None ends a block. A comment behind code is a block of its own."""
    previous = 0
    comment = re.compile(r"^(.*?)(?:^|\s)(" + marker + r"+)(?!\d)\s?(.*)$")
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        if marker not in line or line.startswith("#!"):
            continue
        match = comment.match(line)
        if not match or match[1].count('"') % 2 or match[1].count("'") % 2:
            continue
        alone = not match[1].strip()
        if not alone or number != previous + 1:
            yield number, None
        yield number, match[3]
        previous = number if alone else 0


def docstrings(path):
    for match in re.finditer(r'"""(.*?)"""', path.read_text(errors="replace"), re.S):
        number = match.string.count("\n", 0, match.start()) + 1
        yield number, None
        for offset, line in enumerate(match[1].splitlines()):
            yield number + offset, line


def markdown(path):
    fenced = False
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            yield number, None
        elif fenced or re.match(r"^(\||#|!\[|<|    )", line):
            yield number, None
        else:
            yield number, line


def lines_of(path):
    if path.suffix == ".md":
        yield from markdown(path)
    elif path.suffix in CODE_SUFFIXES:
        yield from commented(path, "//")
    else:
        yield from commented(path, "#")
        if path.suffix == ".py":
            yield from docstrings(path)


def is_prose(line):
    """Neither a drawing, nor a formula, nor a line of code or of a table."""
    text = line.strip()
    letters = sum(map(str.isalpha, text)) + sum(map(str.isspace, text))
    return len(text) > 0 and letters >= 0.7 * len(text) and not re.search(r"[;{}]$|^NOLINT|clang-format|\s{3,}\S", text)


def sentences(path):
    """(line, sentence), in order."""
    block, first = [], 0

    def flush():
        text = " ".join(block)
        block.clear()
        text = re.sub(r"`[^`]*`", "X", text)
        text = re.sub(r"\]\([^)]*\)", "]", text)
        text = re.sub(r"\b(e\.g|i\.e|cf|eq|Eq|eqs|sec|Sec|ch|no|vs|Rev|resp|approx|fig|Fig)\.", r"\1", text)
        for sentence in re.split(r"(?<=[.!?])[)\"*_]*\s+(?=[A-Z0-9\"(*_`\[])", text):
            if len(re.findall(r"[A-Za-z]{2,}", sentence)) >= 3:
                yield first, sentence.strip(" *_-")

    for number, line in lines_of(path):
        item = line is not None and re.match(r"^\s*([*+-]|\d+[.)]) ", line)
        indented = line is not None and re.match(r"^\s{2,}\S", line) and not item and path.suffix != ".md"
        prose = line is not None and is_prose(line)
        if not prose or item or indented:
            yield from flush()
        if not prose or indented:
            continue
        text = re.sub(r"^\s*([*+-]|\d+[.)]) ", "", line).strip()
        if not block:
            first = number
        block.append(text)
        if text.endswith(":"):
            yield from flush()
    yield from flush()


def test_names(path):
    """Finds among the names of tests."""
    if path.suffix in CODE_SUFFIXES:
        text = path.read_text(errors="replace")
        for match in TEST_NAME.finditer(text):
            yield text.count("\n", 0, match.start(1)) + 1, "a clause as a test's name", match[1], match[0]


def has_person_verb(name):
    parts = re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)
    return name not in WIRE_NAMES and any(part.lower() in PERSON_VERBS for part in parts)


def person_verbs(path):
    """Finds among the names of C++, each name once: its first place in code. Comments and texts are left out."""
    if path.suffix not in CODE_SUFFIXES:
        return
    text = path.read_text(errors="replace")
    if not PERSON_STEM.search(text):
        return
    no_code = r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])+'"""
    code = re.sub(no_code, lambda match: "\n" * match[0].count("\n") or " ", text, flags=re.S)
    named = set()
    for match in re.finditer(r"[A-Za-z_]\w*", code):
        if PERSON_STEM.search(match[0]) and match[0] not in named and has_person_verb(match[0]):
            named.add(match[0])
            number = code.count("\n", 0, match.start())
            yield number + 1, "a person's verb in a name", match[0], text.splitlines()[number].strip()


def measure(path):
    said = list(sentences(path))
    lengths = [len(re.findall(r"[^\s]+", sentence)) for _, sentence in said]
    finds = [(line, reason, match[0], sentence)
             for line, sentence in said
             for phrase, reason in PHRASES
             if (match := re.search(phrase, sentence, re.IGNORECASE))]
    finds += [*test_names(path), *person_verbs(path)]
    return said, lengths, finds


def room_of(name):
    if name.suffix == ".md":
        return "documents"
    return name.parts[0] if len(name.parts) > 1 else "."


def git(root, *command):
    return subprocess.run(["git", "-C", root, *command], check=True, capture_output=True, text=True).stdout


def has_sentences(name):
    return name.suffix in CODE_SUFFIXES | HASH_SUFFIXES | {".md"} or name.name == "CMakeLists.txt"


def new_finds(root):
    """(file, find) of the files that differ from the last commit: finds that the commit has not."""
    names = git(root, "diff", "--name-only", "HEAD").splitlines()
    names += git(root, "ls-files", "--others", "--exclude-standard").splitlines()
    committed = set(git(root, "ls-tree", "-r", "--name-only", "HEAD").splitlines())
    for name in sorted(set(names)):
        if not has_sentences(Path(name)) or not (root / name).is_file():
            continue
        known = Counter()
        if name in committed:
            with tempfile.NamedTemporaryFile("w", suffix=Path(name).suffix) as before:
                before.write(git(root, "show", f"HEAD:{name}"))
                before.flush()
                known = Counter((reason, match) for _, reason, match, _ in measure(Path(before.name))[2])
        for find in measure(root / name)[2]:
            known[find[1:3]] -= 1
            if known[find[1:3]] < 0:
                yield name, find


def show(name, find):
    line, reason, match, sentence = find
    print(f"  {name}:{line}: {reason}: '{match.strip()[:40]}' in: {sentence[:90]}")


def measured_tree():
    listed = git(ROOT, "ls-files", "--cached", "--others", "--exclude-standard").splitlines()
    words, count, finds = defaultdict(int), defaultdict(int), defaultdict(int)
    for name in sorted(map(Path, listed)):
        if not has_sentences(name) or not (ROOT / name).is_file():
            continue
        _, lengths, found = measure(ROOT / name)
        module = room_of(name)
        words[module] += sum(lengths)
        count[module] += len(lengths)
        finds[module] += len(found)
    return {module: {"sentences": count[module], "mean": words[module] / count[module], "finds": finds[module]}
            for module in sorted(count) if count[module]}


def write_bounds(bounds):
    lines = ["# The most that tools/words.py allows: mean words a sentence, and finds. Lowered by tools/words.py --update.", ""]
    lines += [f'"{module}" = {{ mean = {b["mean"]:.1f}, finds = {b["finds"]} }}' for module, b in sorted(bounds.items())]
    BOUNDS.write_text("\n".join(lines) + "\n")


def check(update):
    today = measured_tree()
    bounds = tomllib.loads(BOUNDS.read_text()) if BOUNDS.exists() else {}
    over = []
    for module, now in today.items():
        mean, finds = int(now["mean"] * 10 + 0.999) / 10, now["finds"]
        bound = bounds.get(module)
        if update:
            kept = bound or {"mean": mean, "finds": finds}
            bounds[module] = {"mean": min(kept["mean"], mean), "finds": min(kept["finds"], finds)}
        elif bound is None:
            over.append(f"{module}: has no bound in tools/words.toml")
        else:
            if mean > bound["mean"]:
                over.append(f'{module}: {mean} words a sentence, the bound is {bound["mean"]}')
            if finds > bound["finds"]:
                over.append(f'{module}: {finds} finds, the bound is {bound["finds"]}')
        print(f'{module:12} {now["sentences"]:6} sentences, {now["mean"]:5.1f} words each, {finds:4} finds')
    if update:
        write_bounds({module: bound for module, bound in bounds.items() if module in today})
    for line in over:
        print(f"error: {line}; see tools/words.py FILE", file=sys.stderr)
    return 1 if over else 0


def main(arguments):
    if arguments in (["--check"], ["--update"]):
        return check(arguments == ["--update"])
    if arguments == ["--changed"]:
        found = list(new_finds(ROOT))
        for name, find in found:
            show(name, find)
        return 1 if found else 0
    if not arguments or arguments[0].startswith("-"):
        print(__doc__)
        return 2
    for name in arguments:
        said, lengths, finds = measure(Path(name))
        if not said:
            print(f"{name}: no sentences, {len(finds)} finds")
        else:
            longest = max(range(len(said)), key=lambda i: lengths[i])
            print(f"{name}: {len(said)} sentences, {sum(lengths) / len(said):.1f} words each, "
                  f"{lengths[longest]} the longest (line {said[longest][0]}), {len(finds)} finds")
        for find in finds:
            show(name, find)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
