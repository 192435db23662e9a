#!/usr/bin/env python3
"""The layer check, tried on small trees: those that obey the table pass, every violation is named."""

import fnmatch
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import check_layers  # noqa: E402

# A tree with the modules of ours; parts and private headers as a test needs them.
MODULES = {
    "may_include": {
        "core": [], "timebase": ["core"], "schedules": ["core"], "fusion": ["core"], "recording/records": ["core"],
        "bus/wire": ["core", "schedules"], "bus": ["core", "bus/wire"], "recording": ["core", "bus/wire"],
        "nodes": ["core", "fusion", "bus"], "sim": ["core", "bus", "nodes"], "experiments": ["core", "sim"],
        "report": ["core", "recording"],
    },
    "leaves": {"bus/dds": "bus", "nodes/runner": "nodes"},
    "threads": {"allowed": ["nodes/runner", "recording/writer.cc", "experiments", "tests"]},
}


class CheckLayers(unittest.TestCase):
    def problems(self, files, table=MODULES):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return check_layers.problems(root, check_layers.Modules(table))

    def expect(self, files, *expected, table=MODULES):
        """One problem for each expected text, in any order, and no other."""
        found = self.problems(files, table)
        for text in expected:
            match = [problem for problem in found if text in problem]
            self.assertEqual(len(match), 1, f"'{text}' in {found}")
            found.remove(match[0])
        self.assertEqual(found, [])

    def test_a_tree_in_order(self):
        self.expect({
            "core/time.h": "#pragma once\n#include <cstdint>\n",
            "schedules/cluster.h": '#include "core/time.h"\n',
            "bus/wire/frame.h": '#include "schedules/cluster.h"\n#include <fmt/format.h>\n',
            "bus/wire/frame.cc": '#include "bus/wire/frame.h"\n',
            "recording/log.proto": "",
            "recording/codec.h": '#include "recording/log.pb.h"\n',
            "bus/dds/sample.idl": "",
            "bus/dds/channel.cc": '#include "bus/dds/sample.h"\n',
            "cli/main.cc": '#include "bus/wire/frame.h"\n#include "recording/codec.h"\n',
            "build/release/core/anything.cpp": '#include "nowhere.h"\n',
            "tools/js/node_modules/x/y.c": '#include "nowhere.h"\n',
        })

    def test_a_module_that_is_not_allowed(self):
        self.expect({"sim/drive.h": "", "fusion/filter.cc": '#include "sim/drive.h"\n'},
                    'fusion/filter.cc: fusion may not include sim ("sim/drive.h")')

    def test_the_longest_prefix_is_the_module(self):
        self.expect({"bus/port.h": "", "bus/wire/frame.cc": '#include "bus/port.h"\n'}, "bus/wire may not include bus")
        self.expect({"core_extra/x.h": ""}, "core_extra/x.h: is in no module")

    def test_only_the_program_and_the_tests_name_a_leaf(self):
        leaf = {"nodes/runner/run.h": "", "bus/dds/port.h": ""}
        for include in ("nodes/runner/run.h", "bus/dds/port.h"):
            for allowed in ("cli/main.cc", "tests/x.cc"):
                self.expect({**leaf, allowed: f'#include "{include}"\n'})
            for refused in ("nodes/step.cc", "bus/port.cc", "sim/drive.cc", "experiments/sweep.cc"):
                self.expect({**leaf, refused: f'#include "{include}"\n'}, f"{refused}: ")

    def test_what_another_header_brings_along(self):
        # Each include is allowed alone; report's indirect view is not.
        self.expect({"bus/wire/frame.h": "", "recording/log.h": '#include "bus/wire/frame.h"\n',
                     "report/plot.cc": '#include "recording/log.h"\n'},
                    'report may not include bus/wire ("bus/wire/frame.h" over recording/log.h)')

    def test_headers_that_include_each_other_end(self):
        self.expect({"core/a.h": '#include "core/b.h"\n', "core/b.h": '#include "core/a.h"\n'})

    def test_relative_includes(self):
        self.expect({"sim/drive.h": "", "fusion/filter.h": "", "fusion/a.cc": '#include "../sim/drive.h"\n',
                     "fusion/b.cc": '#include "filter.h"\n', "fusion/c.cc": '#include "fusion/../sim/drive.h"\n',
                     "fusion/d.cc": '#include "./filter.h"\n', "fusion/e.cc": '#include "fusion//filter.h"\n'},
                    *(f"fusion/{name}.cc: " for name in "abcde"))

    def test_own_headers_in_angle_brackets(self):
        self.expect({"sim/drive.h": "", "fusion/a.cc": "#include <sim/drive.h>\n",
                     "fusion/b.cc": "#include <../sim/drive.h>\n", "fusion/c.cc": "#include <sim/absent.h>\n"},
                    *(f"fusion/{name}.cc: " for name in "abc"))

    def test_spellings_of_the_directive(self):
        for spelling in ('#include"sim/drive.h"', '  #  include   "sim/drive.h"', '#include /* why */ "sim/drive.h"',
                         '#inc\\\nlude "sim/drive.h"', '#include \\\n"sim/drive.h"', '#include_next "sim/drive.h"',
                         '#import "sim/drive.h"', '/* a */ #include "sim/drive.h" // b', '%:include "sim/drive.h"',
                         'const char* a = "/*";\n#include "sim/drive.h"\nconst char* b = "*/";',
                         'const char* a = R"(/*)";\n#include "sim/drive.h"\n// */',
                         "#define DRIVE \"sim/drive.h\"\n#include DRIVE"):
            with self.subTest(spelling):
                self.expect({"sim/drive.h": "", "fusion/a.cc": spelling + "\n"}, "fusion/a.cc: ")

    def test_what_only_looks_like_a_directive(self):
        for text in ('// #include "sim/drive.h"', '/*\n#include "sim/drive.h"\n*/', 'const char* a = "#include";'):
            with self.subTest(text):
                self.expect({"sim/drive.h": "", "fusion/a.cc": text + "\n"})

    def test_files_outside_the_modules(self):
        self.expect({"extra/a.cc": "", "b.h": "", "docs/c.cc": ""}, "extra/a.cc: ", "b.h: ", "docs/c.cc: ")

    def test_nothing_hides_in_a_module(self):
        self.expect({"sim/drive.h": "", "fusion/build/a.cc": '#include "sim/drive.h"\n',
                     "fusion/.b/c.cc": '#include "sim/drive.h"\n'}, "fusion/build/a.cc: ", "fusion/.b/c.cc: ")

    def test_sources_by_other_names(self):
        self.expect({"sim/drive.h": "", "fusion/a.cpp": '#include "sim/drive.h"\n'},
                    "fusion/a.cpp: sources are .h and .cc", "fusion/a.cpp: fusion may not include sim")
        self.expect({"core/b.inl": "", "core/c.hpp": ""}, "core/b.inl: ", "core/c.hpp: ")

    def test_examples_and_tests_may_be_in_c(self):
        self.expect({"tests/a.c": "", "sim/b.c": ""}, "sim/b.c: sources are .h and .cc")

    def test_what_is_no_header_or_not_there(self):
        self.expect({"core/a.cc": '#include "core/b.cc"\n', "core/b.cc": "", "core/c.cc": '#include "core/gone.h"\n',
                     "core/d.cc": '#include "core/gone.pb.h"\n'}, "core/a.cc: ", "core/c.cc: ", "core/d.cc: ")

    def test_threads(self):
        for header in ("thread", "mutex", "atomic", "latch", "pthread.h"):
            for allowed in ("nodes/runner/a.cc", "recording/writer.cc", "experiments/sweep.cc", "tests/a.cc"):
                self.expect({allowed: f"#include <{header}>\n"})
            for refused in ("nodes/a.cc", "nodes/runner_up.cc", "recording/writer_too.cc", "report/a.cc", "sim/a.cc"):
                if refused == "nodes/runner_up.cc" and header != "thread":
                    continue
                self.expect({refused: f"#  include <{header}>\n"}, "threads live only")

    def test_a_circle_in_the_table(self):
        self.assertEqual(check_layers.circles(check_layers.read_modules().allowed), [])
        self.assertEqual(len(check_layers.circles({"a": ["b"], "b": ["c"], "c": ["a"], "d": ["a"]})), 3)
        self.assertEqual(len(check_layers.circles({"a": ["a"]})), 1)

    def test_parts_are_included_downwards(self):
        table = {**MODULES, "parts": {"schedules": ["model", "check"]}}
        self.expect({"schedules/model/a.h": "", "schedules/check/b.cc": '#include "schedules/model/a.h"\n'}, table=table)
        self.expect({"schedules/check/a.h": "", "schedules/model/b.cc": '#include "schedules/check/a.h"\n'},
                    "schedules/model may not include schedules/check", table=table)
        self.expect({"schedules/check/deep/a.h": "", "schedules/check/b.h": '#include "schedules/check/deep/a.h"\n',
                     "schedules/check/deep/c.cc": '#include "schedules/check/b.h"\n'}, table=table)
        self.expect({"schedules/new/a.cc": ""}, "schedules/new is no part", table=table)

    def test_private_headers(self):
        table = {**MODULES, "parts": {"fusion": ["filters", "tracks"]},
                 "private_headers": {"fusion": ["filters/inner.h", "filters/deep/*", "*.pb.h"]}}
        tree = {"fusion/filters/kalman.h": '#include "fusion/filters/inner.h"\n', "fusion/filters/inner.h": "",
                "fusion/filters/deep/a/b.h": "", "fusion/filters/said.proto": ""}
        self.expect({**tree, "fusion/tracks/a.cc": '#include "fusion/filters/kalman.h"\n',
                     "tests/fusion/filters/b.cc": '#include "fusion/filters/inner.h"\n',
                     "fusion/filters/deep/c.cc": '#include "fusion/filters/inner.h"\n',
                     "fusion/filters/d.cc": '#include "fusion/filters/deep/a/b.h"\n#include "fusion/filters/said.pb.h"\n'},
                    table=table)
        for private in ("inner.h", "deep/a/b.h", "said.pb.h"):
            for name in ("fusion/tracks/a.cc", "nodes/a.cc", "cli/a.cc"):
                self.expect({**tree, name: f'#include "fusion/filters/{private}"\n'},
                            f'"fusion/filters/{private}" is a private header of fusion/filters', table=table)

    def test_a_module_is_a_header_with_its_source(self):
        table = {**MODULES, "may_include": {**MODULES["may_include"], "core/output": [], "timebase": ["core/output"]}}
        self.expect({"core/output.h": "", "core/output.cc": '#include "core/output.h"\n', "core/outputs.h": "",
                     "timebase/a.cc": '#include "core/output.h"\n'}, table=table)
        self.expect({"core/output.cc": '#include "core/outputs.h"\n', "core/outputs.h": ""},
                    "core/output may not include core", table=table)
        self.expect({"core/outputs.h": "", "timebase/a.cc": '#include "core/outputs.h"\n'},
                    "timebase may not include core", table=table)

    def test_a_module_among_the_parts_around_it(self):
        table = {**MODULES, "may_include": {**MODULES["may_include"], "cli/supervision": ["core"]},
                 "parts": {"cli": [".", "drive", "supervision", "launch"]}}
        tree = {"core/a.h": "", "fusion/a.h": "", "cli/a.h": "", "cli/launch/a.h": "", "cli/supervision/a.h": '#include "core/a.h"\n'}
        self.expect({**tree, "cli/launch/b.cc": '#include "cli/supervision/a.h"\n'}, table=table)
        for name in ("cli/main.cc", "cli/drive/b.cc"):
            self.expect({**tree, name: '#include "cli/supervision/a.h"\n'}, "may not include cli/supervision", table=table)
        for include in ("fusion/a.h", "cli/a.h", "cli/launch/a.h"):
            self.expect({**tree, "cli/supervision/b.cc": f'#include "{include}"\n'},
                        f'cli/supervision may not include {include.split("/")[0]} ("{include}")', table=table)

    def test_a_folder_with_many_sources(self):
        files = {f"sim/a{number}.cc": "" for number in range(26)}
        self.expect(files, "sim: 26 sources in a folder")
        self.expect(files, table={**MODULES, "more_than_25_sources": {"sim": "a reason"}})
        self.expect({"sim/a.cc": ""}, "sim needs no reason", table={**MODULES, "more_than_25_sources": {"sim": "a reason"}})

    def test_namespaces_are_paths(self):
        def source(space, body="int a();"):
            return f"namespace {space} {{\n{body}\n}}  // namespace {space}\n"

        defined = "int a() { return 1; }"
        self.expect({"core/a.h": source("ttf"), "bus/wire/a.h": source("ttf::bus::wire", defined),
                     "tests/bus/wire/a.cc": source("ttf::bus::wire", defined), "tests/laws/a.h": source("ttf::laws", defined),
                     "sim/a.h": source("ttf::bus::wire", "struct Frame;") + source("ttf::sim", defined)})
        self.expect({"bus/wire/a.h": source("ttf::wire", defined)}, "namespace ttf::wire is not its path's")
        self.expect({"tests/bus/wire/a.cc": source("ttf::bus", defined)}, "namespace ttf::bus is not its path's")

    def test_functions_whose_state_threads_share(self):
        for call, instead in (("std::lgamma(x)", "lgamma_r()"), ("strerror (1)", "ttf::system_message()"),
                              ("::gmtime(&t)", "gmtime_r()"), ("std::rand()", "ttf::RandomStream()"),
                              ("strtok(a, b)", "strtok_r()")):
            self.expect({"core/a.cc": f"int a() {{ return {call}; }}\n"}, f"keeps a state that threads share: {instead}")
            self.expect({"tests/core/a.cc": f"int a() {{ return {call}; }}\n"})
        self.expect({"core/a.cc": "// lgamma(x)\nint a = b.rand() + c->ctime() + operand(1) + lgamma_r(x, &s); // strtok()\n"
                                  'const char* d = "setlocale()";\n'})

    def test_tests_mirror_modules(self):
        self.expect({"tests/bus/wire/a.cc": "", "tests/sim/some_kind/a.cc": "", "tests/support/a.h": ""})
        self.expect({"tests/wires/a.cc": ""}, "tests/wires: mirrors no module")

    def test_this_tree_stands(self):
        top = pathlib.Path(__file__).resolve().parents[2]
        table = check_layers.read_modules()
        headers = [file.relative_to(top).as_posix() for file in check_layers.source_files(top) if file.suffix == ".h"]
        for module, private in table.private_headers.items():
            made = [file.relative_to(top).with_suffix(suffix).as_posix() for kind, suffix in (("proto", ".pb.h"), ("idl", ".h"))
                    for file in (top / module).rglob(f"*.{kind}")]
            own = [header for header in headers + made if table.module_of(header) == module]
            for name in private:
                self.assertTrue(fnmatch.filter(own, f"{module}/{name}"), f"{module}/{name}")


if __name__ == "__main__":
    unittest.main()
