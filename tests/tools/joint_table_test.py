#!/usr/bin/env python3
"""The joint table of drives: every drive and strategy has its column, aligned, with a dash for a missing value."""

import copy
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import joint_table  # noqa: E402

AGES = {"count": 3, "mean_ms": 12.345, "worst_ms": 20.0}
STRATEGY = {
    "strategy": "buff",
    "rmse_truth": {"position_m": 0.1234, "velocity_mps": 0.5},
    "rmse_reference": {"position_m": 0.4, "velocity_mps": None, "compared": 0},
    "nees": {"mean": 3.5, "band_95": [3.1, 4.9]},
    "age_when_fused": AGES,
    "age_when_used": AGES,
    "observations": {"received": 107, "out_of_sequence": 2, "late": 1, "held": 9, "dropped": 1, "torn": 2, "overwritten": 3, "discarded": 4, "lost": 10},
    "uses": 42, "uses_refused_as_stale": 2,
    "objects": {"compared": 37, "missed": 0, "spurious": 1},
    "precision_us": 0.8066,
    "flexray_load": 0.2951,
}


def drive(name, *strategies):
    summary = {"scenario": name, "strategies": []}
    for strategy in strategies:
        summary["strategies"].append(copy.deepcopy(STRATEGY) | {"strategy": strategy})
    return summary


class JointTable(unittest.TestCase):
    def test_a_column_for_each_drive_and_strategy(self):
        second = drive("two", "tt")
        second["strategies"][0]["objects"]["compared"] = 41
        lines = joint_table.joint_table([drive("one", "buff", "adva"), second]).splitlines()
        self.assertEqual(lines[0].split(), ["one", "two"])
        self.assertEqual(lines[1].split(), ["measure", "buff", "adva", "tt"])
        rows = {line[:35].rstrip(): line[35:].split() for line in lines[3:]}
        self.assertEqual(len(rows), len(joint_table.ROWS))
        self.assertEqual(rows["position RMSE against truth [m]"], ["0.123"] * 3)
        self.assertEqual(rows["velocity RMSE against DGPS [m/s]"], ["-"] * 3)
        self.assertEqual(rows["  95 % band"], ["3.10..4.90"] * 3)
        self.assertEqual(rows["age when used, mean [ms]"], ["12.3"] * 3)
        self.assertEqual(rows["  dropped"], ["10"] * 3)
        self.assertEqual(rows["uses of an image"], ["40"] * 3)
        self.assertEqual(rows["objects compared"], ["37", "37", "41"])
        self.assertEqual(rows["FlexRay load per channel [%]"], ["29.5"] * 3)

    def test_columns_are_aligned_under_their_drive(self):
        lines = joint_table.joint_table([drive("a_drive_with_a_very_long_name", "tt"), drive("b", "tt")]).splitlines()
        begin = lines[0].index("b")
        self.assertEqual(lines[2][begin - 2:begin], "  ")
        self.assertEqual(lines[2][begin], "-")
        ends = {len(line) for line in lines[1:]}
        self.assertEqual(len(ends), 1, "the last column is aligned right")
        self.assertEqual([line for line in lines if line != line.rstrip()], [])


if __name__ == "__main__":
    unittest.main()
