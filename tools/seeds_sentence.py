#!/usr/bin/env python3
"""Says in a sentence which strategy sees best over the seeds of an experiment, or that they cannot decide.

    seeds_sentence.py ANSWER.json

The first measure decides. All pairs of strategies are compared at each point. A difference is called certain only if it
stays so among all of them, by Holm's method. The differences from the baseline follow, point by point, with their intervals.
"""
import json
import math
import sys


def digits(value, half_width):
    """Decimals that show two digits of the interval."""
    scale = half_width if half_width > 0 else abs(value)
    return max(0, 1 - math.floor(math.log10(scale))) if scale > 0 else 1


def interval(estimate, sign=""):
    decimals = digits(estimate["mean"], estimate["half_width"])
    return f"{estimate['mean']:{sign}.{decimals}f} ± {estimate['half_width']:.{decimals}f}"


def sentences(answer):
    measure, about = next(iter(answer["measures"].items()))
    meaning = about["meaning"].split(",")[0]
    unit = f" [{about['unit']}]" if about["unit"] else ""
    baseline, certain, lines, names = answer["baseline"], [], [], {}
    seeds = 0
    for point in answer["points"]:
        name = names[point["point"]] = ", ".join(point["axes"].values())
        cells = {paradigm: measures[measure] for paradigm, measures in point["paradigms"].items()}
        seeds = max(seeds, cells[baseline]["count"])
        parts = [f"{baseline} {interval(cells[baseline])}"]
        for paradigm, cell in cells.items():
            if paradigm == baseline:
                continue
            parts.append(f"{paradigm} - {baseline} {interval(cell['difference'], '+')}")
        lines.append(f"  {name}: {', '.join(parts)}")
    for pair in answer["pairs"]["certain"]:
        less = pair["difference"]["mean"] < 0
        certain.append(f"{pair['paradigm']} has {'less' if less else 'more'} than {pair['against']} in {names[pair['point']]}, "
                       f"{interval(pair['difference'], '+')}")
    level = f"{100 * answer['confidence']:g} %"
    told = f"tell for certain: {'; '.join(certain)}" if certain else "cannot tell which strategy is better or worse"
    head = f"{seeds} seeds of each drive {told} ({answer['pairs']['comparisons']} comparisons, {level})."
    if answer["failed"]:
        head += f" {answer['failed']} of {answer['runs']} runs failed."
    return "\n".join([head, f"{meaning}{unit}:", *lines]) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        print(sentences(json.load(file)), end="")
