#!/usr/bin/env python3
"""tools/result_tables.py and tools/results.py: tables of a made-up answer, and a program that answers otherwise.

    result_tables_test.py SOURCE_DIR
"""
import contextlib
import io
import json
import math
import pathlib
import sys
import tempfile
import unittest

TOP = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
sys.path.insert(0, str(TOP / "tools"))
import result_tables  # noqa: E402
import results  # noqa: E402


def estimate(mean, half_width, difference=None, p=None, percent=None):
    found = {"count": 20, "mean": mean, "half_width": half_width}
    if difference is not None:
        found["difference"] = {"count": 20, "mean": difference, "half_width": 0.5 * half_width, "p": p}
        if percent is not None:
            found["difference"]["percent"] = dict(zip(("mean", "low", "high"), percent))
    return found


def answer():
    """Two densities by two roads; `free` is better in calm drives for certain, and worse in hard ones."""
    points = []
    for road in ("dry", "icy"):
        for density, better in (("1", -0.5), ("100", 0.5)):
            points.append({"point": len(points), "axes": {"road": road, "density": density}, "paradigms": {
                "tt": {"error": estimate(2.0, 0.2), "age": estimate(42.0, 0.0)},
                "free": {"error": estimate(2.0 + better, 0.2, better, 1e-4 if density == "1" else 0.03,
                                           (-25.0, -29.4, -20.2) if density == "1" else (25.0, 20.1, 30.6)),
                         "age": estimate(35.04, 0.0, -6.96, 1e-9)}}})
    return {"baseline": "tt", "confidence": 0.95, "seed": 1, "points": points,
            "measures": {"error": {"unit": "m^2"}, "age": {"unit": "ms"}}}


def table(text):
    return result_tables.Table(result_tables.Directive(text), answer()).text()


class Tables(unittest.TestCase):
    def test_differences_are_bold_where_they_stay_certain(self):
        self.assertEqual(table("differences error; where: road=dry"), (
            "*`error` [m²], 20 replications, seed 1: 2 of 4 comparisons, in bold, stay certain together.*\n\n"
            "| density | tt | free - tt |\n|---|---|---|\n"
            "| 1 | 2.00 ± 0.20 | **-0.50 ± 0.10** |\n| 100 | 2.00 ± 0.20 | +0.50 ± 0.10 |\n"))

    def test_percent_says_where_the_sign_changes(self):
        text = table("percent error of free; columns: density; crossing: yes; names: dry=a dry road")
        self.assertIn("| road | 1 | 100 | crossing |", text)
        self.assertIn("| a dry road | **-25 (-29 to -20)** | +25 (+20 to +31) | 10 |", text)

    def test_a_baseline_that_may_be_zero_leaves_no_interval(self):
        made = answer()
        made["points"][1]["paradigms"]["free"]["error"]["difference"]["percent"] = {"mean": 25.0, "low": None, "high": None}
        text = result_tables.Table(result_tables.Directive("percent error of free; where: road=dry"), made).text()
        self.assertIn("| 100 | +25.0 (no interval) |", text)
        del made["points"][1]["paradigms"]["free"]["error"]["difference"]["percent"]
        with self.assertRaisesRegex(result_tables.Wrong, "no change of error in per cent"):
            result_tables.Table(result_tables.Directive("percent error of free; where: road=dry"), made)

    def test_an_interval_that_excludes_zero_shows_it(self):
        self.assertEqual(result_tables.change({"percent": {"mean": -1.94, "low": -3.78, "high": -0.04}}), "-1.94 (-3.78 to -0.04)")
        self.assertEqual(result_tables.change({"percent": {"mean": -1.94, "low": -3.78, "high": 0.04}}), "-2 (-4 to 0)")

    def test_given_figures_stand_before_the_answers(self):
        self.assertEqual(table("values error of tt; where: road=dry; given: book=1.5 1.9, old=2 3"),
                         "| density | book | old | tt |\n|---|---|---|---|\n"
                         "| 1 | 1.5 | 2 | 2.00 ± 0.20 |\n| 100 | 1.9 | 3 | 2.00 ± 0.20 |\n")
        with self.assertRaises(result_tables.Wrong):
            table("values error of tt; where: road=dry; given: book=1.5")

    def test_means_have_a_column_a_measure(self):
        self.assertEqual(table("means age error of free tt; where: road=icy, density=1; names: age=age [ms]"),
                         "| paradigm | age [ms] | error |\n|---|---|---|\n| free | 35.0 | 1.50 |\n| tt | 42.0 | 2.00 |\n")

    def test_a_figure_that_no_drive_has_is_a_dash(self):
        made = answer()
        made["points"][0]["paradigms"]["tt"]["error"] = estimate(None, None)
        text = result_tables.Table(result_tables.Directive("values error of tt; where: road=dry"), made).text()
        self.assertIn("| 1 | - |\n| 100 | 2.00 ± 0.20 |", text)
        nobody = {"count": 0, "mean": None, "half_width": None}
        for cells in made["points"][0]["paradigms"].values():
            cells["error"] = nobody | {"difference": nobody | {"p": None}}
        text = result_tables.Table(result_tables.Directive("percent error of free; where: road=dry"), made).text()
        self.assertIn("| 1 | - |\n| 100 | ", text)

    def test_means_are_of_the_drives_that_have_a_value(self):
        self.assertEqual(results.mean([1.0, float("nan"), 3.0]), 2.0)
        self.assertNotEqual(results.mean([float("nan")]), results.mean([float("nan")]))

    def test_changes_and_interactions_of_an_axis(self):
        def percent(mean, half):
            return {"mean": mean, "low": mean - half, "high": mean + half}
        along = answer() | {"baseline": "1"}
        for point in along["points"]:
            for cells in point["paradigms"].values():
                cells["error"].pop("difference", None)
                if point["axes"]["density"] == "100":
                    cells["error"]["difference"] = {"count": 20, "mean": 1, "half_width": 0.1, "p": 1e-3,
                                                    "percent": percent(50, 5)}
        both = {"count": 20, "mean": -0.1, "half_width": 0.01, "percent": percent(-9.5, 0.9), "stays_certain": True}
        along["interactions"] = [{"measure": "error", "lowers": "tt", "more_than": "free", "points": [
            {"axes": {"road": "dry"}, "first": {"count": 20, "mean": 0.2, "half_width": 0.1}, "interaction": both,
             "second": {"count": 20, "mean": 1, "half_width": 0.1, "percent": percent(50, 5)}}]}]
        def made(text):
            return result_tables.Table(result_tables.Directive(text), along).text()
        self.assertEqual(made("changes error; where: road=dry"), (
            "*`error` [%], 20 replications, seed 1: 4 of 4 comparisons, in bold, stay certain together.*\n\n"
            "| density | tt | free |\n|---|---|---|\n| 100 | **+50 (+45 to +55)** | **+50 (+45 to +55)** |\n"))
        self.assertEqual(made("interactions error; names: tt=TT"), (
            "*`error` [%], 20 replications, seed 1: 1 of 1 interactions, in bold, stay certain together.*\n\n"
            "| road | TT | free | TT against free |\n|---|---|---|---|\n"
            "| dry | +0.20 ± 0.10 | +50 (+45 to +55) | **-9.5 (-10.4 to -8.6)** |\n"))
        one = along["interactions"][0]
        along["interactions"] = [one | {"from": "1", "to": "100"}, one | {"from": "100", "to": "1"},
                                 one | {"measure": "age"}]
        text = made("interactions error; names: 1=calm, 100=hard")
        self.assertIn(": 2 of 2 interactions, ", text)
        self.assertIn("| change | road | tt | free | tt against free |\n", text)
        self.assertIn("| calm to hard | dry | +0.20 ± 0.10 | ", text)
        self.assertIn("| hard to calm | dry | +0.20 ± 0.10 | ", text)

    def test_wrong_directives_are_refused(self):
        for text, said in (("means age of nobody; where: road=dry, density=1", "nobody is no paradigm"),
                           ("sums age", "must be one of"), ("values age; where: road=wet", "no point"),
                           ("values age; where: road=dry; rows: road", "several points")):
            with self.assertRaisesRegex(result_tables.Wrong, said):
                table(text)

    def test_a_page_keeps_what_is_not_a_table(self):
        directive = "<!-- table: means age of tt; rows: density; where: road=dry -->"
        page = f"Before.\n\n{directive}\n\n| old |\n|---|\n| 1 |\n\nAfter, | no table.\n"
        once = result_tables.filled(page, answer())
        self.assertEqual(once, f"Before.\n\n{directive}\n\n| density | tt |\n|---|---|\n| 1 | 42.0 |\n| 100 | 42.0 |\n"
                               "\nAfter, | no table.\n")
        self.assertEqual(result_tables.filled(once, answer()), once)
        percent = result_tables.filled("<!-- table: percent error of free; columns: density -->\n", answer())
        self.assertEqual(result_tables.filled(percent, answer()), percent)


class Seeds(unittest.TestCase):
    """A column of the same experiment with another seed."""

    def seeded(self, text):
        other = answer()
        other["seed"] = 2
        for point in other["points"]:
            point["paradigms"]["free"]["error"]["difference"]["percent"]["mean"] = -10.0
        without = json.loads(json.dumps(other["points"]))
        for point in without:
            point["paradigms"]["free"]["error"]["difference"]["percent"] = {"mean": -7.0, "low": None, "high": None}
        other["without"] = {"8": without}
        return result_tables.Table(result_tables.Directive(text), {**answer(), "seeds": {"2": other}})

    def test_a_column_of_each_is_behind_the_others(self):
        text = self.seeded("percent error of free; where: road=dry; seeds: 2, 2 without 8; names: seed 2=again").text()
        self.assertIn("| density | free | again | seed 2 without 8 |", text)
        self.assertIn("| 1 | **-25 (-29 to -20)** | -10 (-29 to -20) | -7.00 |", text)
        text = self.seeded("means error of tt free; where: road=dry; seeds: 2 of tt").text()
        self.assertIn("| density | tt | free | seed 2 |", text)

    def test_the_cells_name_their_seed(self):
        table = self.seeded("means error of free; where: road=dry; seeds: 2, 2 without 8")
        self.assertEqual([cell.seed for cell in table.cells()], [None, "2", "2"] * 2)

    def test_what_cannot_be_is_refused(self):
        for text, said in [("percent error of free; where: road=dry; seeds: 3", "no answer of seed 3 is kept"),
                           ("percent error of free; where: road=dry; seeds: 2 without 9", "no answer of seed 2 without 9 is kept"),
                           ("percent error of free; where: road=dry; seeds: two", "seeds must be as `2`"),
                           ("means error age of free; where: road=dry; seeds: 2", "seeds must be as `2`"),
                           ("percent error of free; columns: density; seeds: 2", "seeds must be as `2`")]:
            with self.assertRaisesRegex(result_tables.Wrong, said):
                self.seeded(text)

    def test_the_page_has_files_of_each_seed(self):
        page = results.Page.__new__(results.Page)
        page.options, page.seed = ["--replications", "9"], None
        page.kept, page.kept_answer, page.driven = (pathlib.Path(name) for name in ("made.csv", "made.json", "driven/made"))
        page.tables = result_tables.tables_of("<!-- table: means error of tt; seeds: 12, 2, 2 without 8 -->\n"
                                              "<!-- table: means error of tt -->\n")
        own, two, twelve = page.all_seeds()
        self.assertEqual((own.seed, len(own.tables), own.left_out()), (None, 2, []))
        self.assertEqual((two.seed, len(two.tables), two.left_out()), ("2", 1, ["8"]))
        self.assertEqual(twelve.options, ["--replications", "9", "--seed", "12"])
        self.assertEqual([str(at) for at in (two.kept, two.kept_answer, two.driven)],
                         ["made_seed_2.csv", "made_seed_2.json", "driven/made_seed_2"])


class Check(unittest.TestCase):
    """The printed interval of `free` at density 1 is 0.10 wide to either side."""

    def contradictions(self, shift):
        text = "<!-- table: differences error; where: road=dry -->"
        page = results.Page.__new__(results.Page)
        page.text = result_tables.filled(text + "\n", answer())
        page.tables = result_tables.tables_of(page.text)
        rows = {(point, paradigm): {"error": [2.0, 1.9, 2.1]} for point in range(4) for paradigm in ("tt", "free")}
        today = {key: {"error": [v + (shift if key == (0, "free") else 0.0) for v in cell["error"]]}
                 for key, cell in rows.items()}
        was, results.kept_rows = results.kept_rows, lambda *_: rows
        try:
            return results.contradictions(page, {None: today}, answer(), results.REPLICATIONS)
        finally:
            results.kept_rows = was

    def test_an_uneven_interval_allows_as_much_as_it_reaches_to_each_side(self):
        self.assertEqual(results.allowed("**-27 (-29 to -24)**", -27.0, -26.0), 3.0)
        self.assertEqual(results.allowed("**-27 (-29 to -24)**", -27.0, -28.0), 2.0)
        self.assertEqual(results.allowed("0 (-1 to +1)", 0.0, 0.1), 1.0)
        self.assertEqual(results.allowed("-0.50 ± 0.10", -0.5, 0.0), 0.1)
        self.assertEqual(results.allowed("35.0", 40.0, 0.0), 2.0 + 1e-9)

    def test_what_a_table_would_not_show_passes(self):
        self.assertEqual(self.contradictions(0.0), [])
        self.assertEqual(self.contradictions(0.09), [])

    def test_what_it_would_show_does_not(self):
        found = self.contradictions(0.11)
        self.assertEqual(len(found), 1)
        self.assertIn("error of free, road dry, density 1", found[0])


class Printed(unittest.TestCase):
    def verdict(self, change):
        with tempfile.TemporaryDirectory() as folder:
            page = results.Page.__new__(results.Page)
            page.path, page.kept_answer = results.TOP / "docs/results/made_up.md", pathlib.Path(folder) / "made_up.json"
            page.kept_answer.write_text(json.dumps(results.trimmed(answer(), ["error"])), encoding="utf-8")
            page.text = change(result_tables.filled("<!-- table: differences error; where: road=dry -->\n", answer()))
            page.tables = result_tables.tables_of(page.text)
            with contextlib.redirect_stdout(io.StringIO()):
                return results.printed([page])

    def test_tables_of_the_drive_pass(self):
        self.assertFalse(self.verdict(lambda text: text))

    def test_a_figure_written_by_hand_does_not(self):
        self.assertTrue(self.verdict(lambda text: text.replace("-0.50", "-0.60")))


def fieller(one, base, difference):
    """The change of the mean from the base's in per cent, with the ends that the half widths alone give.

    With as many values of all three, they are t standard errors, and give the covariance: 2 cov(d, y) = var x - var y - var d.
    The ends s solve (d - s y)^2 = t^2 var(d - s y), in one of many forms of Fieller's theorem.
    """
    x2, y2, d2 = (of["half_width"] ** 2 for of in (one, base, difference))
    y, d = base["mean"], difference["mean"]
    a, b, c = y * y - y2, d * y - 0.5 * (x2 - y2 - d2), d * d - d2
    if a <= 0:
        return 100 * d / y, None, None
    root = math.sqrt(max(0.0, b * b - a * c))
    return 100 * d / y, 100 * max(-1.0, (b - root) / a), 100 * (b + root) / a


class Kept(unittest.TestCase):
    """A kept change in per cent agrees with the intervals that are kept beside it, by a second form of the same theorem."""

    def test_changes_are_fiellers(self):
        compared = 0
        for path in sorted(results.KEPT.glob("*.json")):
            kept = json.loads(path.read_text(encoding="utf-8"))
            for point in kept["points"]:
                base = point["paradigms"].get(kept["baseline"])
                for name, cells in point["paradigms"].items():
                    for measure, one in cells.items():
                        change = one.get("difference", {}).get("percent")
                        if not change or not base or not one["count"] == base[measure]["count"] == one["difference"]["count"]:
                            continue
                        expected = fieller(one, base[measure], one["difference"])
                        for value, key in zip(expected, ("mean", "low", "high")):
                            where = f"{path.stem}, point {point['point']}, {name}, {measure}: {key}"
                            if value is None or change[key] is None:
                                self.assertEqual(value, change[key], where)
                            else:
                                self.assertAlmostEqual(value, change[key], delta=2e-3 + 1e-4 * abs(value), msg=where)
                        compared += 1
        self.assertGreater(compared, 3000)

    def test_a_certain_baseline_leaves_the_differences_interval(self):
        # y = 2 without spread: x has the difference's.
        mean, low, high = fieller({"half_width": 0.3}, {"mean": 2.0, "half_width": 0.0}, {"mean": 0.5, "half_width": 0.3})
        self.assertAlmostEqual(mean, 25.0)
        self.assertAlmostEqual(low, 10.0)
        self.assertAlmostEqual(high, 40.0)


if __name__ == "__main__":
    unittest.main()
