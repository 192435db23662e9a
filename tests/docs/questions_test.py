#!/usr/bin/env python3
"""A stranger's questions are answered in two links: the README leads to "Ten questions" in docs/README.md, and each
question there leads to pages and files that have the answer. A word of the answer stands behind each link.

    questions_test.py REPOSITORY      exit 1 and one line for every question without its links or their words
"""
import pathlib
import re
import sys

import links_test

QUESTIONS = "docs/README.md"
SECTION = QUESTIONS + "#ten-questions"
ITEM = re.compile(r"^(?:\d+\.|\*) \*\*(?P<question>[^*]+\?)\*\*(?P<answer>.*?)(?=^\d+\. |^\* |^\n|\Z)", re.DOTALL | re.MULTILINE)
LEAST = 10
# A question's links in order: the words behind each of them.
WORDS = {
    "How do I add a sensor kind?": ["Kinds"],
    "How do I add a service, or another step of a task?": ["WarningKind"],
    "How do I add an export?": ["kFormats"],
    "How do I add a measure?": ["evaluation/measures/table.cc"],
    "Which fields does `summary.json` have?": ["summary.schema.json"],
    "Where is CAN arbitration decided?": ["arbitration", "CanMedium::arbitrate", "lost the arbitration"],
    "How do I run one test?": ["--gtest_filter"],
    "How do I add a medium?": ["live_medium.h", "laws"],
    "Where is a golden hash kept, and how is it renewed?": ["golden_runs.py", "paper_scenario1"],
    "Who may include whom?": ["check_layers.py", "[may_include]"],
    "Where is the FlexRay protocol's state machine?": ["state machine", "PocState"],
    "Where does a late measurement go?": ["strategies/late", "late"],
    "Where is a cluster file checked?": ["`check`", "load_checked_cluster"],
    "Where do faults live?": ["sim/faults", "struct FaultPlan"],
    "How do I add another part?": ["kMakers", "FaultKind", "MotionModel", "kGoalWords", "cli/main.cc", "kKinds"],
    "How do I add a file, a folder or a test?": ["tools/modules.toml", "mirrors the modules"],
}


def text_behind(target: str, page: pathlib.Path) -> str:
    """The target's file, or its part from the anchor's heading to the next heading that is not below it."""
    path, _, anchor = target.partition("#")
    text = (page.parent / path).read_text()
    if not anchor:
        return text
    kept, depth, fenced = [], 0, False
    for line in text.splitlines():
        fenced ^= line.startswith("```")
        heading = None if fenced else re.match(r"(#+) (.+)", line)
        if heading and depth and len(heading[1]) <= depth:
            break
        if heading and not depth and re.sub(r"[^\w\- ]", "", heading[2].lower()).replace(" ", "-") == anchor:
            depth = len(heading[1])
        elif depth:
            kept.append(line)
    return "\n".join(kept)


def problems_of(question: str, answer: str, page: pathlib.Path) -> list[str]:
    targets = links_test.LINK.findall(answer)
    if not targets:
        return [f"{question} has no link"]
    words = WORDS.get(question, [])
    if len(words) != len(targets):
        return [f"{question} has {len(targets)} links, and {len(words)} words in questions_test.py"]
    return [f"{question} {target} has no '{word}'" for target, word in zip(targets, words) if word not in text_behind(target, page)]


def problems(root: pathlib.Path) -> list[str]:
    page = root / QUESTIONS
    found = [f"{QUESTIONS}: {problem}" for problem in links_test.broken(page)]
    if SECTION not in links_test.LINK.findall((root / "README.md").read_text()):
        found.append(f"README.md has no link to {SECTION}")
    items = list(ITEM.finditer(page.read_text()))
    if len(items) < LEAST:
        found.append(f"{QUESTIONS} has {len(items)} questions, and needs {LEAST}")
    if found:
        return found
    return [problem for item in items for problem in problems_of(item["question"], item["answer"], page)]


def main() -> int:
    result = problems(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(result) or "questions: each is two links from the README, and its words are there")
    return 1 if result else 0


if __name__ == "__main__":
    sys.exit(main())
