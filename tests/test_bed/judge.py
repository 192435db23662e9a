#!/usr/bin/env python3
"""Judges the results in a launch folder.

    judge.py FOLDER [EXPRESSION SENTENCE]...      exit 1 and the sentence of each false expression

Expressions are Python's. Their variables are `manifest`, `summary` (of the one strategy) and `nodes` (each node's last report,
by name). lost(KEY) sums a value over the nodes' reports, medium(KEY) a count of their media.
"""
import json
import pathlib
import sys


def main():
    folder = pathlib.Path(sys.argv[1])
    manifest = json.loads((folder / "manifest.json").read_text())
    summary = folder / "summary.json"
    nodes = {node["node"]: node["said"] for node in manifest["health"]}
    scope = {"manifest": manifest, "nodes": nodes,
             "summary": json.loads(summary.read_text())["strategies"][0] if summary.exists() else None,
             "lost": lambda key: sum(node[key] for node in nodes.values()),
             "medium": lambda key: sum(node["medium"][key] for node in nodes.values())}
    wrong = [sentence for expression, sentence in zip(sys.argv[2::2], sys.argv[3::2]) if not eval(expression, scope)]
    if wrong:
        print(json.dumps(nodes, indent=1), *wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
