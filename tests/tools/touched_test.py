#!/usr/bin/env python3
"""tools/touched.py in a small project of its own: which change touches which tests."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parent.parent.parent / "tools/touched.py"
FILES = {
    ".gitignore": "build\n",
    "CMakeLists.txt": "cmake_minimum_required(VERSION 3.20)\nproject(small CXX)\nenable_testing()\n"
                      "include_directories(.)\nadd_subdirectory(part)\nadd_subdirectory(tests/part)\n",
    "part/CMakeLists.txt": "add_library(part STATIC part.cc)\n",
    "part/part.cc": '#include "part/part.h"\nint part() { return 0; }\n',
    "part/part.h": '#include "part/deep.h"\nint part();\n',
    "part/deep.h": "\n",
    "tests/part/CMakeLists.txt": "foreach(one with without)\n  add_executable(${one} ${one}.cc)\n"
                                 "  add_test(NAME ${one} COMMAND ${one})\nendforeach()\n"
                                 "target_link_libraries(with PRIVATE part)\nadd_test(NAME script COMMAND "
                                 "${CMAKE_CURRENT_SOURCE_DIR}/script.sh $<TARGET_FILE:without>)\n"
                                 "add_test(NAME alone COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/script.sh)\n"
                                 "add_library(loaded MODULE loaded.cc)\n"
                                 "set_target_properties(loaded PROPERTIES PREFIX \"\" LIBRARY_OUTPUT_DIRECTORY "
                                 "${CMAKE_BINARY_DIR}/loads)\n"
                                 "add_test(NAME loads COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/loads.sh "
                                 "${CMAKE_BINARY_DIR}/loads)\n",
    "tests/part/loaded.cc": "int loaded() { return 0; }\n",
    "tests/part/loads.sh": "#!/bin/sh\n",
    "tests/part/with.cc": '#include "part/part.h"\nint main() { return part(); }\n',
    "tests/part/without.cc": "int main() {}\n",
    "tests/part/script.sh": "#!/bin/sh\n",
    "tests/part/shared.sh": "\n",
    "scenarios/drive.yaml": "name: drive\n",
    "docs/README.md": "# Page\n",
}


class Touched(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.folder.name)
        for name, text in FILES.items():
            (self.top / name).parent.mkdir(parents=True, exist_ok=True)
            (self.top / name).write_text(text, encoding="utf-8")
        (self.top / "tools").mkdir()
        shutil.copy(TOOL, self.top / "tools")
        self.run_there("git", "init", "-q")
        self.run_there("git", "add", "-A")
        self.run_there("git", "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", "all")
        self.run_there("cmake", "-G", "Ninja", "-B", "build", "-DCMAKE_UNITY_BUILD=ON")

    def tearDown(self):
        self.folder.cleanup()

    def run_there(self, *command):
        return subprocess.run(command, cwd=self.top, check=True, capture_output=True, text=True).stdout

    def touched_by(self, *names, commit="HEAD", choice=()):
        for name in names:
            with open(self.top / name, "a", encoding="utf-8") as file:
                file.write("\n")
        said = self.run_there("tools/touched.py", "build", commit, *choice)
        self.run_there("git", "checkout", "-q", ".")
        return {line.split()[0] for line in said.splitlines()}

    def test_a_change_touches_the_programs_that_see_it_and_their_scripts(self):
        all_of_the_build = {"with", "without", "script", "loads"}
        for names, expected in (([], set()), (["part/part.cc"], {"with"}), (["part/deep.h"], {"with"}),
                                (["part/CMakeLists.txt"], {"with"}), (["tests/part/without.cc"], {"without", "script"}),
                                (["tests/part/script.sh"], {"script", "loads"}), (["tests/part/loaded.cc"], {"loads"}),
                                (["scenarios/drive.yaml"], all_of_the_build), (["CMakeLists.txt"], all_of_the_build),
                                (["docs/README.md"], set()), (["part/deep.h", "tests/part/shared.sh"], {"with", "script", "loads"})):
            with self.subTest(names):
                self.assertEqual(self.touched_by(*names), expected)
        self.assertEqual(self.touched_by(commit=""), all_of_the_build)

    def test_a_comment_of_cmake_touches_nothing(self):
        for change, expected in (("# why\nproject(small CXX)  # which\n", set()),
                                 ('project(small CXX)\nset(text "# no comment")\n', {"with", "without", "script", "loads"})):
            with self.subTest(change):
                lists = self.top / "CMakeLists.txt"
                lists.write_text(FILES["CMakeLists.txt"].replace("project(small CXX)\n", change), encoding="utf-8")
                self.assertEqual(self.touched_by(), expected)

    def test_a_folder_of_libraries_stands_for_its_targets(self):
        said = self.run_there("tools/touched.py", "build", "", "-R", "loads")
        self.assertEqual(said.split(), ["loads", "loads/loaded.so"])

    def test_tests_and_targets_can_be_chosen(self):
        self.assertEqual(self.touched_by("part/part.h", choice=("-R", "script")), set())
        self.assertEqual(self.touched_by("part/part.h", choice=("with", "without")), {"with"})
        with self.assertRaises(subprocess.CalledProcessError):
            self.touched_by(choice=("nothing",))


if __name__ == "__main__":
    unittest.main()
