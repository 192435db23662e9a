#!/usr/bin/env python3
"""The checks of the pages find each kind of mistake: page_test.py with a program that echoes, links_test.py and sentences_test.py
on small pages."""
import pathlib
import tempfile
import unittest

import links_test
import page_test
import sentences_test

PROGRAM = "#!/bin/sh\n[ \"$1\" = draw ] && cp \"$2\" \"$3\" && exit\n[ \"$1\" = fail ] && exit 3\nprintf '%s\\n' \"$@\"\n"
SAY = "build/release/ttfusion"


class Pages(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        for name in ("scenarios", "schedules", "experiments"):
            (self.root / name).mkdir()
        (self.root / "schedules/cluster.yaml").write_text("a: 1\nb: 2\na: 1\n")
        (self.root / ".gitignore").write_text("/out/\n/new.yaml\n/one.svg\n")
        (self.root / "program").write_text(PROGRAM)
        (self.root / "program").chmod(0o755)

    def expect(self, passes: bool, page: str, says: str = ""):
        (self.root / "page.md").write_text(page)
        with tempfile.TemporaryDirectory() as folder:
            try:
                page_test.run_page(self.root / "program", self.root, self.root / "page.md", pathlib.Path(folder))
                failure = ""
            except page_test.Failure as found:
                failure = str(found)
        self.assertEqual(failure == "", passes, failure)
        self.assertIn(says, failure)

    def console(self, shown: str, command: str = f"{SAY} a b c d") -> str:
        return f"Text:\n\n```console\n$ {command}\n{shown}```\n"

    def test_output(self):
        self.expect(True, self.console("a\nb\nc\nd\n"))
        self.expect(False, self.console("a\nb\nc\n"), "+d")
        self.expect(False, self.console("a\nb\nc\ne\n"), "-e")

    def test_lines_left_out(self):
        for shown in ("...\n", "a\n...\n", "...\nd\n", "a\n...\nc\n...\n", "...\nb\n...\nd\n"):
            self.expect(True, self.console(shown))
        for shown in ("b\n...\n", "...\nc\n", "...\nc\n...\nb\n...\n", "a\n...\na\n...\n", "a\nb\nc\n...\nc\nd\n"):
            self.expect(False, self.console(shown))

    def test_exit_code(self):
        self.expect(False, self.console("", f"{SAY} fail"), "ends with 3")
        self.expect(True, self.console("code 3\n", f'{SAY} fail; echo "code $?"'))

    def test_edits(self):
        edited = "In `schedules/cluster.yaml`:\n\n```diff\n-{}\n+b: 3\n```\n"
        shown = self.console("b: 3\n", "grep b: schedules/cluster.yaml")
        self.expect(True, edited.format("b: 2") + "\n" + shown)
        self.expect(False, edited.format("c: 2") + "\n" + shown, "0 times")
        self.expect(False, edited.format("a: 1") + "\n" + shown, "2 times")
        self.expect(False, "Here:\n\n```diff\n-b: 2\n+b: 3\n```\n", "of which file")
        self.expect(True, "Create `new.yaml`:\n\n```yaml\nx: 1\n```\n\n" + self.console("x: 1\n", "cat new.yaml"))

    def test_pictures(self):
        (self.root / "one.svg").write_text("one")
        (self.root / "schedules/other.yaml").write_text("other")
        for drawn, passes in ((self.root / "one.svg", True), ("schedules/other.yaml", False)):
            self.expect(passes, self.console("", f"{SAY} draw {drawn} one.svg") + "\n![one](one.svg)\n")

    def test_pictures_in_a_folder(self):
        (self.root / "one.svg").write_text("one")
        for drawn, passes in ((self.root / "one.svg", True), ("schedules/cluster.yaml", False)):
            self.expect(passes, self.console("", f"mkdir out && {SAY} draw {drawn} out/one.svg") + "\n![one](one.svg)\n")

    def test_what_is_left(self):
        self.expect(True, self.console("", f"mkdir out && {SAY} draw schedules/cluster.yaml out/left.txt"))
        self.expect(False, self.console("", f"{SAY} draw schedules/cluster.yaml left.txt"), "does not ignore:\nleft.txt")

    def test_a_page_without_commands_fails(self):
        self.expect(False, "Nothing.\n")

    def test_links(self):
        for link, passes in (("page.md", True), ("page.md#a-heading-of-it", True), ("#a-heading-of-it", True),
                             ("schedules", True), ("https://example.org/x", True), ("gone.md", False), ("#gone", False),
                             ("page.md#gone", False)):
            page = self.root / "page.md"
            page.write_text(f"# A `heading` of it\n\n[text]({link})\n")
            self.assertEqual(not links_test.broken(page), passes, link)

    def test_names_of_pages_and_sources(self):
        (self.root / "docs").mkdir()
        (self.root / "core").mkdir()
        for name in ("docs/here.md", "core/here.h"):
            (self.root / name).touch()
        for cited, passes in (("docs/here.md", True), ("docs/gone.md", False)):
            (self.root / "core/source.cc").write_text(f"// See {cited}.\n")
            self.assertEqual(not links_test.stale_citations(self.root), passes, cited)
        for named, passes in (("core/here.h", True), ("core/gone.h", False), ("mine/own.yaml", True)):
            (self.root / "docs/here.md").write_text(f"`{named}` has it.\n")
            self.assertEqual(not links_test.stale_sources(self.root), passes, named)

    def test_long_pages(self):
        (self.root / "docs").mkdir()
        page = self.root / "docs/page.md"
        for lines, passes in ((links_test.MOST_LINES, True), (links_test.MOST_LINES + 1, False)):
            page.write_text("A line.\n" * lines)
            self.assertEqual(not links_test.too_long(self.root), passes, lines)


ANSWER = """# Who collides?

{}
<!-- says: {} -->

    a command

| fault | paradigm | collisions | error [m] | change [%] | seed 2 |
|---|---|---|---|---|---|
| crash | tt | 3 | 0.50 ± 0.10 | **-27 (-29 to -24)** | -31..-25 |
| crash | adva | 1 | 0.204 ± 0.020 | 0 (-2 to +1) | -1..+2 |
| none | tt | 0 | 0.10 ± 0.30 | - | - |

    harmed: 9
"""


class Sentences(unittest.TestCase):
    """A sentence holds if its figures are those of its table, and only if all of them are accounted for."""

    def problems(self, sentence: str, directive: str) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs/results").mkdir(parents=True)
            (root / "docs/results/page.md").write_text(ANSWER.format(sentence, directive))
            page = sentences_test.Page(root / "docs/results/page.md")
            return sentences_test.problems_of(page, {}) + sentences_test.unheld(page.answer())

    def holds(self, sentence: str, directive: str):
        self.assertEqual(self.problems(sentence, directive), [])

    def fails(self, sentence: str, directive: str, says: str):
        self.assertIn(says, "\n".join(self.problems(sentence, directive)))

    def test_a_range_is_the_tables(self):
        expression = "span(t(1,'crash','collisions'))"
        self.holds("In 1 to 3 of 10 drives.", f"1 to 3 = {expression}; given: of 10")
        self.fails("In 2 to 4 of 10 drives.", f"2 to 4 = {expression}; given: of 10", "'2 to 4' is 1, 3")

    def test_each_figure_is_accounted_for(self):
        self.fails("In 1 to 3 of 10 drives.", "1 to 3 = span(t(1,'crash','collisions'))", "10 is not accounted for")
        self.fails("In 3 drives.", "3 = t(1,'crash|tt','collisions'); given: of 10", "'of 10' is not in the paragraph")
        self.fails("In 3 drives.", "3 = t(1,'crash|tt','collisions')\n-->\n\nIn 4 drives.\n\n<!--", "the answer has figures")

    def test_intervals_in_both_forms(self):
        self.holds("It has 0.50 ± 0.10 m.", "0.50 ± 0.10 = t(1,'crash|tt','error*')")
        self.holds("It has 27 % (24 to 29) less.", "27 % (24 to 29) = -t(1,'crash|tt','change*')")
        self.fails("It has 27 % (25 to 29) less.", "27 % (25 to 29) = -t(1,'crash|tt','change*')", "is 27, 24, 29")
        self.fails("It has 27 ± 3 % less.", "27 ± 3 % = -t(1,'crash|tt','change*')", "is 27, nan")

    def test_intervals_are_taken_together_by_their_ends(self):
        expression = "span([-x for x in ends(t(1,'crash|tt','change*|seed 2'))])"
        self.holds("It has 24 to 31 % less.", f"24 to 31 % = {expression}")
        self.fails("It has 25 to 31 % less.", f"25 to 31 % = {expression}", "is 24, 31")
        self.holds("It has -2 to +2 % more.", "-2 to +2 % = span(ends(t(1,'crash|adva','change*|seed 2')))")
        self.holds("It has 0.4 to 0.6 m.", "0.4 to 0.6 m = span(ends(t(1,'crash|tt','error*')))")

    def test_numbers_of_a_lists_items_are_no_figures(self):
        self.holds("1. In 3 drives.\n2. In 1 drive.", "3 = t(1,'crash|tt','collisions'); 1 = t(1,'crash|adva','collisions')")
        self.fails("1. In 3 drives.\n2. In 1 drive.", "3 = t(1,'crash|tt','collisions')", "1 is not accounted for")

    def test_a_section_with_its_table_is_held_like_an_answer(self):
        with tempfile.TemporaryDirectory() as folder:
            readme = pathlib.Path(folder) / "README.md"
            readme.write_text("# One\n\nIn 9 ways.\n\n**The answer.** All:\n\n| a |\n|---|\n| 3 % |\n\n## Other\n\n| b |\n|---|\n| 4 |\n")
            page = sentences_test.Page(readme)
            self.assertEqual(sentences_test.unheld(page.sections("**The answer.**")),
                             ["the answer has figures and no <!-- says: ... -->: | a | |---| | 3 % | ..."])
            self.assertEqual(len(sentences_test.unheld(page.sections("# One"))), 2)
            with self.assertRaisesRegex(sentences_test.Wrong, "no line begins with"):
                page.sections("**The short answer.**")

    def test_ratios_to_their_last_digit(self):
        self.holds("It is 2.5 times as large.", "2.5 = ratio(t(1,'crash|tt','error*'),t(1,'crash|adva','error*'))")
        self.fails("It is 2.6 times as large.", "2.6 = ratio(t(1,'crash|tt','error*'),t(1,'crash|adva','error*'))", "is 2.451")
        self.holds("It is a fifth.", "a fifth = t(1,'none|tt','error*') / t(1,'crash|tt','error*')")
        self.fails("It is a quarter.", "a quarter = t(1,'none|tt','error*') / t(1,'crash|tt','error*')", "is 0.2")

    def test_counts_and_printed_figures(self):
        self.holds("Of three, two are certain; 9 are harmed.", "three = len(t(1,'*','error*')); two = len(signed(t(1,'*','error*'))); "
                   "9 = printed('harmed: ([0-9]+)')")
        self.fails("8 are harmed.", "8 = printed('harmed: ([0-9]+)')", "'8' is 9")

    def test_expressions_that_lead_nowhere_are_named(self):
        self.fails("In 3 drives.", "3 = t(2,'crash','collisions')", "there is no table 2")
        self.fails("In 3 drives.", "3 = t(1,'crash|buff','collisions')", "no figure in row 'crash|buff'")
        self.fails("In 3 drives.", "3 = open('x')", "not defined")

    def test_answers_of_the_index_are_those_of_their_pages(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs/results").mkdir(parents=True)
            (root / "docs/results/page.md").write_text(ANSWER.format("In 1 to 3 of 10 drives.", "given: 1 to 3, of 10"))
            rows = "| question | answer |\n|---|---|\n| [Who?](results/page.md) | In {} of 10 drives |\n"
            for answer, problems in (("1 to 3", []), ("2 to 3", ["page.md: 2 is not in the page's answer"])):
                (root / "docs/results.md").write_text(rows.format(answer))
                self.assertEqual(sentences_test.problems_of_answers(sentences_test.Page(root / "docs/results.md")), problems)


if __name__ == "__main__":
    unittest.main()
