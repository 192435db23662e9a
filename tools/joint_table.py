#!/usr/bin/env python3
"""Prints one comparison table of several drives from their summary.json: a column for each drive and strategy.

    joint_table.py SUMMARY.json...
"""
import json
import sys


def number(value, decimals):
    return "-" if value is None else f"{value:.{decimals}f}"


ROWS = [
    ("position RMSE against truth [m]", lambda s: number(s["rmse_truth"]["position_m"], 3)),
    ("velocity RMSE against truth [m/s]", lambda s: number(s["rmse_truth"]["velocity_mps"], 3)),
    ("position RMSE against DGPS [m]", lambda s: number(s["rmse_reference"]["position_m"], 3)),
    ("velocity RMSE against DGPS [m/s]", lambda s: number(s["rmse_reference"]["velocity_mps"], 3)),
    ("NEES (4 degrees of freedom)", lambda s: number(s["nees"]["mean"], 2)),
    ("  95 % band", lambda s: "..".join(number(end, 2) for end in s["nees"]["band_95"])),
    ("age when fused, mean [ms]", lambda s: number(s["age_when_fused"]["mean_ms"], 1)),
    ("age when fused, worst [ms]", lambda s: number(s["age_when_fused"]["worst_ms"], 1)),
    ("age when used, mean [ms]", lambda s: number(s["age_when_used"]["mean_ms"], 1)),
    ("age when used, worst [ms]", lambda s: number(s["age_when_used"]["worst_ms"], 1)),
    ("observation lists received", lambda s: str(s["observations"]["received"])),
    ("  arrived out of sequence", lambda s: str(s["observations"]["out_of_sequence"])),
    ("  fused late (retrodicted)", lambda s: str(s["observations"]["late"])),
    ("  times held back", lambda s: str(s["observations"]["held"])),
    ("  dropped", lambda s: str(s["observations"]["lost"])),
    ("uses of an image", lambda s: str(s["uses"] - s["uses_refused_as_stale"])),
    ("objects compared", lambda s: str(s["objects"]["compared"])),
    ("  missed", lambda s: str(s["objects"]["missed"])),
    ("  spurious", lambda s: str(s["objects"]["spurious"])),
    ("precision of the time base [us]", lambda s: number(s["precision_us"], 3)),
    ("FlexRay load per channel [%]", lambda s: number(100 * s["flexray_load"], 1)),
]


def joint_table(summaries):
    drives = [""] + [summary["scenario"] if i == 0 else "" for summary in summaries
                     for i in range(len(summary["strategies"]))]
    strategies = [strategy for summary in summaries for strategy in summary["strategies"]]
    table = [["measure"] + [strategy["strategy"] for strategy in strategies]]
    table += [[name] + [value(strategy) for strategy in strategies] for name, value in ROWS]
    widths = [max(len(row[column]) for row in table) for column in range(len(table[0]))]
    # A drive's name may run over its columns; it makes the last of them wider where they are too narrow.
    starts = [column for column, name in enumerate(drives) if name] + [len(drives)]
    for first, after in zip(starts, starts[1:]):
        room = sum(widths[first:after]) + 2 * (after - first - 1)
        widths[after - 1] += max(0, len(drives[first]) - room)
    heading = " " * widths[0]
    for first, after in zip(starts, starts[1:]):
        heading += "  " + drives[first].ljust(sum(widths[first:after]) + 2 * (after - first - 1))
    lines = [heading] + ["  ".join(cell.ljust(width) if column == 0 else cell.rjust(width)
                                   for column, (cell, width) in enumerate(zip(row, widths))) for row in table]
    lines.insert(2, "  ".join("-" * width for width in widths))
    return "".join(line.rstrip() + "\n" for line in lines)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    loaded = []
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            loaded.append(json.load(file))
    print(joint_table(loaded), end="")
