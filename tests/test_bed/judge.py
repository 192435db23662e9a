#!/usr/bin/env python3
"""Judges the results in a launch folder.

    judge.py FOLDER [EXPRESSION SENTENCE]...      exit 1 and the sentence of each false expression

Expressions are Python's. Their variables are `manifest`, `summary` (of the one strategy), `summary_of_all`, `verdict` and `nodes`
(each node's last report, by name, without external ones). `external` has the accounts of these, `real` the first. lost(KEY) sums a value over the nodes' reports, medium(KEY) a count of their media.
"""
import json
import pathlib
import sys


def main():
    folder = pathlib.Path(sys.argv[1])
    manifest = json.loads((folder / "manifest.json").read_text())
    summary = folder / "summary.json"
    whole = json.loads(summary.read_text()) if summary.exists() else None
    away = {node["name"] for node in manifest["nodes"] if node.get("external")}
    nodes = {node["node"]: node["said"] for node in manifest["health"] if node["node"] not in away}
    external = manifest.get("external_nodes", [])
    scope = {"manifest": manifest, "nodes": nodes, "external": external, "real": external[0] if external else None,
             "summary": whole["strategies"][0] if whole else None, "summary_of_all": whole,
             "verdict": whole["verdict"]["sentence"] if whole and "verdict" in whole else "",
             "lost": lambda key: sum(node[key] for node in nodes.values()),
             "medium": lambda key: sum(node["medium"][key] for node in nodes.values())}
    wrong = [sentence for expression, sentence in zip(sys.argv[2::2], sys.argv[3::2]) if not eval(expression, scope)]
    if wrong:
        print(json.dumps(nodes, indent=1), *external, *wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
