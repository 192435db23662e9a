#!/usr/bin/env python3
"""The layer check, tried on small houses: what obeys the table passes, every way around it is named."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import check_layers  # noqa: E402


class CheckLayers(unittest.TestCase):
    def problems(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return check_layers.problems(root)

    def expect(self, files, *expected):
        """One problem for each expected text, in any order, and no other."""
        found = self.problems(files)
        for text in expected:
            match = [problem for problem in found if text in problem]
            self.assertEqual(len(match), 1, f"'{text}' in {found}")
            found.remove(match[0])
        self.assertEqual(found, [])

    def test_a_house_in_order(self):
        self.expect({
            "core/time.h": "#pragma once\n#include <cstdint>\n",
            "schedules/model/cluster.h": '#include "core/time.h"\n',
            "bus/wire/frame.h": '#include "schedules/model/cluster.h"\n#include <fmt/format.h>\n',
            "bus/wire/frame.cc": '#include "bus/wire/frame.h"\n',
            "recording/log/log.proto": "",
            "recording/codec.h": '#include "recording/log/log.pb.h"\n',
            "bus/dds/sample.idl": "",
            "bus/dds/exchange/channel.cc": '#include "bus/dds/sample.h"\n',
            "cli/main.cc": '#include "bus/wire/frame.h"\n#include "recording/codec.h"\n',
            "build/release/core/anything.cpp": '#include "nowhere.h"\n',
            "tools/js/node_modules/x/y.c": '#include "nowhere.h"\n',
        })

    def test_a_room_that_is_not_allowed(self):
        self.expect({"drives/drive.h": "", "fusion/filter.cc": '#include "drives/drive.h"\n'},
                    'fusion/filter.cc: fusion may not include sim ("drives/drive.h")')

    def test_the_longest_prefix_is_the_room(self):
        self.expect({"bus/port.h": "", "bus/wire/frame.cc": '#include "bus/port.h"\n'}, "bus/wire may not include bus")
        self.expect({"core_extra/x.h": ""}, "core_extra/x.h: is in no room")

    def test_only_the_program_and_the_tests_name_a_leaf(self):
        leaf = {"nodes/runner/run.h": "", "bus/dds/port.h": ""}
        for include in ("nodes/runner/run.h", "bus/dds/port.h"):
            for allowed in ("cli/main.cc", "tests/x.cc"):
                self.expect({**leaf, allowed: f'#include "{include}"\n'})
            for refused in ("nodes/host/step.cc", "bus/port.cc", "drives/drive.cc", "experiments/sweep.cc"):
                self.expect({**leaf, refused: f'#include "{include}"\n'}, f"{refused}: ")

    def test_what_another_header_brings_along(self):
        # Each include by itself is allowed; what report then sees is not.
        self.expect({"bus/wire/frame.h": "", "recording/log.h": '#include "bus/wire/frame.h"\n',
                     "report/plot.cc": '#include "recording/log.h"\n'},
                    'report may not include bus/wire ("bus/wire/frame.h" over recording/log.h)')

    def test_headers_that_include_each_other_end(self):
        self.expect({"core/a.h": '#include "core/b.h"\n', "core/b.h": '#include "core/a.h"\n'})

    def test_relative_includes(self):
        self.expect({"drives/drive.h": "", "fusion/filter.h": "", "fusion/a.cc": '#include "../sim/drive.h"\n',
                     "fusion/b.cc": '#include "filter.h"\n', "fusion/c.cc": '#include "fusion/../sim/drive.h"\n',
                     "fusion/d.cc": '#include "./filter.h"\n', "fusion/e.cc": '#include "fusion//filter.h"\n'},
                    *(f"fusion/{name}.cc: " for name in "abcde"))

    def test_own_headers_in_angle_brackets(self):
        self.expect({"drives/drive.h": "", "fusion/a.cc": "#include <drives/drive.h>\n",
                     "fusion/b.cc": "#include <../sim/drive.h>\n", "fusion/c.cc": "#include <sim/absent.h>\n"},
                    *(f"fusion/{name}.cc: " for name in "abc"))

    def test_spellings_of_the_directive(self):
        for spelling in ('#include"drives/drive.h"', '  #  include   "drives/drive.h"', '#include /* why */ "drives/drive.h"',
                         '#inc\\\nlude "drives/drive.h"', '#include \\\n"drives/drive.h"', '#include_next "drives/drive.h"',
                         '#import "drives/drive.h"', '/* a */ #include "drives/drive.h" // b', '%:include "drives/drive.h"',
                         'const char* a = "/*";\n#include "drives/drive.h"\nconst char* b = "*/";',
                         'const char* a = R"(/*)";\n#include "drives/drive.h"\n// */',
                         "#define DRIVE \"drives/drive.h\"\n#include DRIVE"):
            with self.subTest(spelling):
                self.expect({"drives/drive.h": "", "fusion/a.cc": spelling + "\n"}, "fusion/a.cc: ")

    def test_what_only_looks_like_a_directive(self):
        for text in ('// #include "drives/drive.h"', '/*\n#include "drives/drive.h"\n*/', 'const char* a = "#include";'):
            with self.subTest(text):
                self.expect({"drives/drive.h": "", "fusion/a.cc": text + "\n"})

    def test_files_outside_the_rooms(self):
        self.expect({"extra/a.cc": "", "b.h": "", "docs/c.cc": ""}, "extra/a.cc: ", "b.h: ", "docs/c.cc: ")

    def test_nothing_hides_in_a_room(self):
        self.expect({"drives/drive.h": "", "fusion/build/a.cc": '#include "drives/drive.h"\n',
                     "fusion/.b/c.cc": '#include "drives/drive.h"\n'}, "fusion/build/a.cc: ", "fusion/.b/c.cc: ")

    def test_sources_by_other_names(self):
        self.expect({"drives/drive.h": "", "fusion/a.cpp": '#include "drives/drive.h"\n'},
                    "fusion/a.cpp: sources are .h and .cc", "fusion/a.cpp: fusion may not include sim")
        self.expect({"core/b.inl": "", "core/c.hpp": ""}, "core/b.inl: ", "core/c.hpp: ")

    def test_what_is_no_header_or_not_there(self):
        self.expect({"core/a.cc": '#include "core/b.cc"\n', "core/b.cc": "", "core/c.cc": '#include "core/gone.h"\n',
                     "core/d.cc": '#include "core/gone.pb.h"\n'}, "core/a.cc: ", "core/c.cc: ", "core/d.cc: ")

    def test_threads(self):
        for header in ("thread", "mutex", "atomic", "latch", "pthread.h"):
            for allowed in ("nodes/runner/a.cc", "recording/log/writer.cc", "experiments/sweep.cc", "tests/a.cc"):
                self.expect({allowed: f"#include <{header}>\n"})
            for refused in ("nodes/a.cc", "nodes/runner_up.cc", "recording/log_writer_too.cc", "report/a.cc", "sim/a.cc"):
                if refused == "nodes/runner_up.cc" and header != "thread":
                    continue
                self.expect({refused: f"#  include <{header}>\n"}, "threads live only")

    def test_a_circle_in_the_table(self):
        self.assertEqual(check_layers.circles(check_layers.ALLOWED), [])
        self.assertEqual(len(check_layers.circles({"a": ["b"], "b": ["c"], "c": ["a"], "d": ["a"]})), 3)
        self.assertEqual(len(check_layers.circles({"a": ["a"]})), 1)


if __name__ == "__main__":
    unittest.main()
