#!/usr/bin/env python3
"""A stranger's questions are answered in two links: the README leads to "Ten questions" in docs/README.md, and each
question there leads to a page or file that exists.

    questions_test.py REPOSITORY      exit 1 and one line for every question without its links
"""
import pathlib
import re
import sys

import links_test

QUESTIONS = "docs/README.md"
SECTION = QUESTIONS + "#ten-questions"
ITEM = re.compile(r"^(?:\d+\.|\*) \*\*(?P<question>[^*]+\?)\*\*(?P<answer>.*?)(?=^\d+\. |^\* |^\n|\Z)", re.DOTALL | re.MULTILINE)
LEAST = 10


def problems(root: pathlib.Path) -> list[str]:
    page = root / QUESTIONS
    found = [f"{QUESTIONS}: {problem}" for problem in links_test.broken(page)]
    if SECTION not in links_test.LINK.findall((root / "README.md").read_text()):
        found.append(f"README.md has no link to {SECTION}")
    items = list(ITEM.finditer(page.read_text()))
    if len(items) < LEAST:
        found.append(f"{QUESTIONS} has {len(items)} questions, and needs {LEAST}")
    return found + [f"{item['question']} has no link" for item in items if not links_test.LINK.search(item["answer"])]


def main() -> int:
    result = problems(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(result) or "questions: each is two links from the README")
    return 1 if result else 0


if __name__ == "__main__":
    sys.exit(main())
