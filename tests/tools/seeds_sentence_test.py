#!/usr/bin/env python3
"""The demo's first sentence: a difference is certain, or the seeds cannot decide."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import seeds_sentence  # noqa: E402


def cell(mean, half_width):
    return {"count": 20, "mean": mean, "half_width": half_width}


def answer(*differences, failed=0):
    """A point for each difference of adva from tt: (mean, half width, certain)."""
    points = [{"point": n, "axes": {"drive": f"bend{n}"}, "paradigms": {
        "tt": {"error": cell(0.0927, 0.0511)},
        "adva": {"error": cell(0.09, 0.05) | {"difference": cell(mean, half)}}}} for n, (mean, half, _) in enumerate(differences)]
    certain = [{"point": n, "paradigm": "adva", "against": "tt", "difference": cell(mean, half)}
               for n, (mean, half, stays) in enumerate(differences) if stays]
    return {"baseline": "tt", "confidence": 0.95, "runs": 40, "failed": failed, "points": points,
            "measures": {"error": {"unit": "m^2", "meaning": "square of the error, paired"}},
            "pairs": {"comparisons": len(points), "certain": certain}}


class SeedsSentence(unittest.TestCase):
    def test_no_winner_that_the_seeds_cannot_decide(self):
        lines = seeds_sentence.sentences(answer((-0.0033, 0.0043, False), (0.5, 0.4, False))).splitlines()
        self.assertEqual(lines[0], "20 seeds of each drive cannot tell which strategy is better or worse (2 comparisons, 95 %).")
        self.assertEqual(lines[1], "square of the error [m^2]:")
        self.assertEqual(lines[2], "  bend0: tt 0.093 ± 0.051, adva - tt -0.0033 ± 0.0043")
        self.assertEqual(lines[3], "  bend1: tt 0.093 ± 0.051, adva - tt +0.50 ± 0.40")

    def test_a_certain_difference_is_reported_with_its_drive(self):
        text = seeds_sentence.sentences(answer((-0.0033, 0.0043, False), (0.5, 0.1, True)))
        self.assertTrue(text.startswith("20 seeds of each drive tell for certain: adva has more than tt in bend1, +0.50 ± 0.10 (2"),
                        text)
        text = seeds_sentence.sentences(answer((-0.5, 0.1, True)))
        self.assertIn("adva has less than tt in bend0", text)

    def test_a_certain_pair_without_the_baseline_is_named(self):
        made = answer((-0.0033, 0.0043, False))
        made["pairs"] = {"comparisons": 3, "certain": [
            {"point": 0, "paradigm": "adva", "against": "buff", "difference": cell(-0.00068, 0.00033)}]}
        text = seeds_sentence.sentences(made)
        self.assertTrue(text.startswith("20 seeds of each drive tell for certain: adva has less than buff in bend0, "
                                        "-0.00068 ± 0.00033 (3 comparisons, 95 %)."), text)

    def test_failed_runs_are_said(self):
        self.assertIn("3 of 40 runs failed.", seeds_sentence.sentences(answer((0.1, 0.2, False), failed=3)))

    def test_an_interval_without_width(self):
        self.assertIn("+0.0 ± 0.0", seeds_sentence.sentences(answer((0.0, 0.0, False))))


if __name__ == "__main__":
    unittest.main()
