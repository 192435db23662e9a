#!/usr/bin/env python3
"""Whether a paradigm of an experiment drives the very cluster that synthesis made.

  driven_cluster.py PROGRAM EXPERIMENT PARADIGM AXIS=VALUE SYNTHESISED

Takes the paradigm's whole cluster file. Replaces the keys that this value of the axis varies. Prints each key that
differs. The name may differ."""
import pathlib
import re
import subprocess
import sys

import yaml


def whole(program, path):
    done = subprocess.run([program, "schedule", "export", path, "--format", "yaml"], stdout=subprocess.PIPE, check=True)
    return yaml.safe_load(done.stdout)


def replace(cluster, key, value):
    *way, last = (int(word) if word.isdigit() else word for word in re.findall(r"[^.\[\]]+", key))
    for step in way:
        cluster = cluster[step]
    _ = cluster[last]
    cluster[last] = value


def scalars(of, key=""):
    if isinstance(of, dict):
        return {k: v for name, one in of.items() for k, v in scalars(one, f"{key}.{name}").items()}
    if isinstance(of, list):
        return {k: v for i, one in enumerate(of) for k, v in scalars(one, f"{key}[{i}]").items()}
    return {key[1:]: of}


def main():
    program, experiment, paradigm, point, synthesised = sys.argv[1:]
    experiment = pathlib.Path(experiment)
    said = yaml.safe_load(experiment.read_text(encoding="utf-8"))
    axis, value = point.split("=")
    settings = said["axes"][axis]["settings"][value]
    own = {key.removeprefix(f"{paradigm}/"): v for key, v in settings.items()
           if "/" not in key or key.startswith(f"{paradigm}/")}
    file = own.pop("cluster", said["paradigms"][paradigm]["cluster"])
    driven = whole(program, experiment.parent / file)
    for key, v in own.items():
        if key.startswith("cluster."):
            replace(driven, key.removeprefix("cluster."), v)
    driven, made = scalars(driven), scalars(whole(program, synthesised))
    differ = [key for key in sorted(driven.keys() | made.keys()) if key != "name" and driven.get(key) != made.get(key)]
    for key in differ:
        print(f"{experiment.name}, {point}: {key} = {driven.get(key)}, and synthesis has {made.get(key)}")
    sys.exit(1 if differ else 0)


if __name__ == "__main__":
    main()
