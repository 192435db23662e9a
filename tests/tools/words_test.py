#!/usr/bin/env python3
"""The measure of words, tried on small texts: sentences are found where a reader finds them, finds where a reader stumbles."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import words  # noqa: E402


class Words(unittest.TestCase):
    def measured(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / name
            path.write_text(text)
            said, lengths, finds = words.measure(path)
            return [sentence for _, sentence in said], lengths, [(line, reason) for line, reason, _, _ in finds]

    def test_a_comment_over_lines_is_one_text(self):
        said, lengths, _ = self.measured("a.h", "// Returns the mean\n// of both. It throws nothing at all.\nint f();\n")
        self.assertEqual(said, ["Returns the mean of both.", "It throws nothing at all."])
        self.assertEqual(lengths, [5, 5])

    def test_comments_behind_code_are_separate(self):
        said, _, _ = self.measured("a.h", "int a;  // microticks of one cycle\nint b;  // cycles of one round\n")
        self.assertEqual(said, ["microticks of one cycle", "cycles of one round"])

    def test_drawings_tables_and_code_are_left_out(self):
        said, _, _ = self.measured("a.h", "// The time line of both nodes:\n//   A |--x---|----|\n//   B |---|--y---|\n// | a | b |\n")
        self.assertEqual(said, ["The time line of both nodes:"])
        said, _, _ = self.measured("a.md", "# Title\n\nOne short sentence here.\n\n```\nno sentence in this block.\n```\n| a | b |\n")
        self.assertEqual(said, ["One short sentence here."])

    def test_strings_are_no_comments(self):
        said, _, _ = self.measured("a.cc", 'const char* a = "http://this is no comment";\n')
        self.assertEqual(said, [])

    def test_items_of_a_list_are_sentences(self):
        said, _, _ = self.measured("a.md", "Three of them follow:\n\n* the first of them\n* the second one\n  goes on here\n")
        self.assertEqual(said, ["Three of them follow:", "the first of them", "the second one goes on here"])

    def test_abbreviations_and_paths_end_nothing(self):
        said, lengths, _ = self.measured("a.md", "It follows e.g. Bar-Shalom, see [the page](a.b.md). `x. Y` counts here once.\n")
        self.assertEqual(len(said), 2)
        self.assertEqual(lengths[1], 4)

    def test_finds_name_their_line_and_reason(self):
        _, _, finds = self.measured("a.h", "// The good one is here.\n\n// Whoever reads this is lost.\nint a;\n// Of the three it is one.\n")
        self.assertIn((3, "name the actor"), finds)
        self.assertIn((5, "a fragment"), finds)
        self.assertEqual({line for line, _ in finds}, {3, 5})

    def test_finds_do_not_depend_on_capitals(self):
        for text, reason in [("of the whole frame", "a fragment"), ("Of the whole frame", "a fragment"),
                             ("that others may hear", "a fragment"), ("which carries no frame", "a clause as a subject"),
                             ("so WHOEVER sends it", "name the actor"), ("Those who send it", "name the actor"),
                             ("None of it. NONE ARE kept here", "say what is empty or absent"),
                             ("But for the last one", "an old word")]:
            _, _, finds = self.measured("a.h", f"int a;  // {text}\n")
            self.assertEqual([found for _, found in finds], [reason], text)

    def test_not_is_a_fragment_only_at_the_start_of_a_sentence(self):
        _, _, finds = self.measured("a.h", "// Not of this program, but of another.\nint a;  // not stated in any file\n")
        self.assertEqual(finds, [(1, "a fragment")])

    def test_a_question_is_no_find(self):
        _, _, finds = self.measured("a.md", "What does it cost?\n")
        self.assertEqual(finds, [])

    def test_a_tests_name_is_no_clause(self):
        for macro, name in [("TEST", "WhatIsLostIsCounted"), ("TEST_F", "WhoMaySend"), ("TEST_P", "WhoeverSendsIsReceived"),
                            ("TYPED_TEST", "WhateverComesIsKept"), ("TEST", "WhomItHarms"), ("TEST", "WhoseSlotItIs")]:
            for between in [" ", "\n     "]:
                _, _, finds = self.measured("a_test.cc", f"\n{macro}(Bus,{between}{name}) {{\n}}\n")
                self.assertEqual(finds, [(2 + between.count("\n"), "a clause as a test's name")], name)
        for text in ["TEST(Bus, WholeFramesArrive) {\n", "TEST(Bus, ALostFrameIsCounted) {\n", "TEST(WholeBus, Starts) {\n",
                     "TEST(Bus, ItCountsWhatIsLost) {\n", "// TEST(Bus, WhatIsLostIsCounted)\n"]:
            _, _, finds = self.measured("a_test.cc", text)
            self.assertEqual(finds, [], text)

    def test_a_machine_has_no_verbs_of_persons_in_its_names(self):
        reason = "a person's verb in a name"
        for name in ["hear_frame", "knows", "ToldDrive", "kTellsFront", "last_heard_", "unheard", "learns_rate", "L2_ANodeDoesNotHearIt"]:
            _, _, finds = self.measured("a.cc", f"int a = 1'000;\nint {name} = {name} + 1'000;\n")
            self.assertEqual(finds, [(2, reason)], name)
        for text in ["bool known = unknown(kNow, knowledge_of, shear, foretells);\n", "int a;  // `told` is called\n", '#include "a/heard.h"\n',
                     'json["told"] = counts.reported;\n', "/* knows\n   tells */\n", "sample.tells_late = 1;\n", 'R"(int told;)";\n']:
            _, _, finds = self.measured("a.cc", text)
            self.assertEqual(finds, [], text)
        _, _, finds = self.measured("a.py", "told = 1\n")
        self.assertEqual(finds, [])
        _, _, finds = self.measured("a.h", "/* two\n   lines */\nint b;\nvoid tell();\n")
        self.assertEqual(finds, [(4, reason)])

    def test_the_tree_is_within_its_bounds_and_bounds_only_fall(self):
        with tempfile.TemporaryDirectory() as folder:
            bounds, today = words.BOUNDS, words.measured_tree
            try:
                words.BOUNDS = pathlib.Path(folder) / "words.toml"
                value = {"core": {"sentences": 2, "mean": 12.04, "finds": 3}}
                words.measured_tree = lambda: value
                self.assertEqual(words.check(update=False), 1)  # a room without a bound
                words.check(update=True)
                self.assertIn('"core" = { mean = 12.1, finds = 3 }', words.BOUNDS.read_text())
                self.assertEqual(words.check(update=False), 0)
                value["core"]["finds"] = 4
                self.assertEqual(words.check(update=False), 1)
                words.check(update=True)
                self.assertIn("finds = 3", words.BOUNDS.read_text())
                value["core"].update(mean=9.0, finds=1)
                words.check(update=True)
                self.assertIn('"core" = { mean = 9.0, finds = 1 }', words.BOUNDS.read_text())
            finally:
                words.BOUNDS, words.measured_tree = bounds, today


if __name__ == "__main__":
    unittest.main()
