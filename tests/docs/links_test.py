#!/usr/bin/env python3
"""Every link between the project's pages and files has a target: the file exists, and so does the heading. A page of docs/ that
a source, a script, a message or an input file names exists. A source that a page names exists, unless the page says how to add
it. A page of docs/ has at most 250 lines.

    links_test.py REPOSITORY      exit 1 and one line for every problem
"""
import functools
import pathlib
import re
import sys

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```$|^    [^\n]*$|`[^`\n]*`", re.DOTALL | re.MULTILINE)
MADE = {"build", "out", "node_modules"}
MOST_LINES = 250   # as in keys/render.h
CITED = re.compile(r'(?:(?<![\w/])|"/|\$source/)(docs/[\w/]+\.md)')
TEXTS = {".h", ".cc", ".c", ".py", ".sh", ".cmake", ".txt", ".yaml", ".toml", ".proto", ".idl", ".json", ".csv"}
SOURCE = re.compile(r"`((?:[a-z_0-9]+/)+[a-z_0-9]+\.(?:h|cc|c|py|sh|yaml|proto|toml|cmake))`")
RECIPES = {"docs/develop/extending.md", "docs/develop/extending_outputs.md"}   # name files that are to be made


def pages(root: pathlib.Path) -> list[pathlib.Path]:
    return [page for page in sorted(root.rglob("*.md"))
            if not any(part in MADE or part.startswith(".") for part in page.relative_to(root).parts)]


@functools.cache
def anchors(page: pathlib.Path) -> set[str]:
    """The names that headings have as anchors, as GitHub makes them."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    names = set()
    for heading in re.findall(r"^#+ (.+)$", text, re.MULTILINE):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
        repeated = 1
        unique = name
        while unique in names:
            unique = f"{name}-{repeated}"
            repeated += 1
        names.add(unique)
    return names


def broken(page: pathlib.Path) -> list[str]:
    found = []
    for target in LINK.findall(CODE.sub("", page.read_text())):
        if re.match(r"\w+:", target):
            continue   # another site's
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists():
            found.append(f"{target}: there is no such file")
        elif anchor and anchor not in anchors(file):
            found.append(f"{target}: the page has no such heading")
    return found


def too_long(root: pathlib.Path) -> list[str]:
    lines = {page: page.read_text().count("\n") for page in pages(root) if page.is_relative_to(root / "docs")}
    return [f"{page.relative_to(root)}: has {count} lines, and may have {MOST_LINES}: divide it"
            for page, count in lines.items() if count > MOST_LINES]


def stale_citations(root: pathlib.Path) -> list[str]:
    """Pages that files name and that are not there. tests/docs makes up some."""
    found = []
    for file in sorted(root.rglob("*")):
        parts = file.relative_to(root).parts
        if file.suffix not in TEXTS or any(part in MADE or part.startswith(".") for part in parts) or not file.is_file():
            continue
        if parts[:2] == ("tests", "docs"):
            continue
        for page in set(CITED.findall(file.read_text(errors="replace"))):
            if not (root / page).is_file():
                found.append(f"{file.relative_to(root)}: {page}: there is no such page")
    return found


def stale_sources(root: pathlib.Path) -> list[str]:
    """Sources that pages name and that are not there. A path counts if its first folder does: others are of a user's own."""
    return [f"{page.relative_to(root)}: {source}: there is no such file"
            for page in pages(root) if page.relative_to(root).as_posix() not in RECIPES
            for source in sorted(set(SOURCE.findall(page.read_text())))
            if (root / source.split("/")[0]).is_dir() and source.split("/")[0] not in MADE and not (root / source).is_file()
            and not (page.parent / source).is_file()]


def main() -> int:
    root = pathlib.Path(sys.argv[1]).resolve()
    result = [f"{page.relative_to(root)}: {problem}" for page in pages(root) for problem in broken(page)]
    result += too_long(root) + stale_citations(root) + stale_sources(root)
    print("\n".join(result) or f"links: all lead somewhere, on {len(pages(root))} pages")
    return 1 if result else 0


if __name__ == "__main__":
    sys.exit(main())
