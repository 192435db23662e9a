#!/usr/bin/env python3
"""Every link between the project's pages and files has a target: the file exists, and so does the heading. A page of docs/ has
at most 250 lines.

    links_test.py REPOSITORY      exit 1 and one line for every broken link and every long page
"""
import functools
import pathlib
import re
import sys

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```$|^    [^\n]*$|`[^`\n]*`", re.DOTALL | re.MULTILINE)
MADE = {"build", "out", "node_modules"}
MOST_LINES = 250   # as in keys/render.h


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


def main() -> int:
    root = pathlib.Path(sys.argv[1]).resolve()
    result = [f"{page.relative_to(root)}: {problem}" for page in pages(root) for problem in broken(page)] + too_long(root)
    print("\n".join(result) or f"links: all lead somewhere, on {len(pages(root))} pages")
    return 1 if result else 0


if __name__ == "__main__":
    sys.exit(main())
