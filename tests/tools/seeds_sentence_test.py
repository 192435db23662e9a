#!/usr/bin/env python3
"""The demo's first sentence: a difference is certain, or the seeds cannot decide."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import seeds_sentence  # noqa: E402


def cell(mean, half_width, certain=None):
    estimate = {"count": 20, "mean": mean, "half_width": half_width}
    return estimate if certain is None else estimate | {"stays_certain": certain}


def answer(*differences, failed=0):
    """A point for each difference of adva from tt: (mean, half width, certain)."""
    points = [{"axes": {"drive": f"bend{n}"}, "paradigms": {
        "tt": {"error": cell(0.0927, 0.0511)},
        "adva": {"error": cell(0.09, 0.05) | {"difference": cell(*difference)}}}} for n, difference in enumerate(differences)]
    return {"baseline": "tt", "confidence": 0.95, "comparisons": len(points), "runs": 40, "failed": failed,
            "measures": {"error": {"unit": "m^2", "meaning": "square of the error, paired"}}, "points": points}


class SeedsSentence(unittest.TestCase):
    def test_no_winner_that_the_seeds_cannot_decide(self):
        lines = seeds_sentence.sentences(answer((-0.0033, 0.0043, False), (0.5, 0.4, False))).splitlines()
        self.assertEqual(lines[0], "20 seeds of each drive cannot tell who is better or worse than tt "
                                   "(2 comparisons, 95 %).")
        self.assertEqual(lines[1], "square of the error [m^2]:")
        self.assertEqual(lines[2], "  bend0: tt 0.093 ± 0.051, adva - tt -0.0033 ± 0.0043")
        self.assertEqual(lines[3], "  bend1: tt 0.093 ± 0.051, adva - tt +0.50 ± 0.40")

    def test_a_certain_difference_is_reported_with_its_drive(self):
        text = seeds_sentence.sentences(answer((-0.0033, 0.0043, False), (0.5, 0.1, True)))
        self.assertTrue(text.startswith("20 seeds of each drive tell for certain: adva has more than tt in bend1 (2"), text)
        text = seeds_sentence.sentences(answer((-0.5, 0.1, True)))
        self.assertIn("adva has less than tt in bend0", text)

    def test_failed_runs_are_said(self):
        self.assertIn("3 of 40 runs failed.", seeds_sentence.sentences(answer((0.1, 0.2, False), failed=3)))

    def test_an_interval_without_width(self):
        self.assertIn("+0.0 ± 0.0", seeds_sentence.sentences(answer((0.0, 0.0, False))))


if __name__ == "__main__":
    unittest.main()
