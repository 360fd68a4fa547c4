"""The checks of scripts/ find what they are there to find, in a small repository made for it."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
MODULES = """
holdfast_module(core PATH holdfast/core LINK Eigen3::Eigen)
holdfast_module(io PATH holdfast/io DEPENDS core
  LINK yaml-cpp)  # DEPENDS pipeline
holdfast_module(pipeline PATH holdfast/pipeline DEPENDS core io)
"""


class CheckTest(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp(prefix="holdfast_checks_")
        self.addCleanup(shutil.rmtree, self.root)
        shutil.copytree(SCRIPTS, os.path.join(self.root, "scripts"),
                        ignore=shutil.ignore_patterns("__pycache__"))
        self.write("CMakeLists.txt", MODULES)
        self.write("holdfast/core/time.hpp", "int time();\n")
        self.write("holdfast/pipeline/runner.hpp", '#include "holdfast/core/time.hpp"\n')

    def write(self, name, text):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def run_check(self, check):
        """(exit code, lines but the last): without git the scripts look at all files."""
        run = subprocess.run([sys.executable, os.path.join(self.root, "scripts", check)],
                             capture_output=True, text=True, cwd=self.root)
        return run.returncode, run.stdout.splitlines()[:-1]

    def assert_offence(self, check, *words):
        code, lines = self.run_check(check)
        self.assertEqual(code, 1)
        self.assertEqual(len(lines), 1, lines)
        for word in words:
            self.assertIn(word, lines[0])


class Includes(CheckTest):
    def test_includes_along_the_arrows_pass(self):
        self.write("holdfast/io/a.cpp", '#include <x>\n#include "holdfast/core/time.hpp"\n')
        self.write("tests/io/a_test.cpp", '#include "holdfast/pipeline/runner.hpp"\n')
        self.assertEqual(self.run_check("check_includes"), (0, []))

    def test_an_include_against_the_arrows_is_named_with_its_line(self):
        self.write("holdfast/io/a.cpp", '\n  # include "holdfast/pipeline/runner.hpp"\n')
        self.assert_offence("check_includes", "holdfast/io/a.cpp:2", "'io' may include core, io",
                            "not 'pipeline'")

    def test_a_path_that_is_not_from_the_root_is_refused(self):
        self.write("holdfast/core/a.cpp", '#include "time.hpp"\n')
        self.assert_offence("check_includes", "holdfast/core/a.cpp:1", "no such file")

    def test_a_module_includes_no_program(self):
        self.write("apps/commands.hpp", "\n")
        self.write("holdfast/core/a.cpp", '#include "apps/commands.hpp"\n')
        self.assert_offence("check_includes", "modules do not include apps/")

    def test_a_module_may_not_depend_on_one_below_it(self):
        self.write("CMakeLists.txt", MODULES + "holdfast_module(map PATH m DEPENDS viewer)\n")
        self.assert_offence("check_includes", "'map' depends on 'viewer'")

    def test_the_page_shows_the_same_table(self):
        rows = ["| `core` | `holdfast/core` | – | x |", "| `io` | `holdfast/io` | core | x |",
                "| `pipeline` | `holdfast/pipeline` | core, io | x |"]
        self.write("docs/architecture.md", "\n".join(rows) + "\n")
        self.assertEqual(self.run_check("check_includes"), (0, []))
        self.write("docs/architecture.md", "\n".join(rows).replace("core, io", "core") + "\n")
        self.assert_offence("check_includes", "row of module 'pipeline' differs")


class Sizes(CheckTest):
    def test_small_files_pass(self):
        self.assertEqual(self.run_check("check_sizes"), (0, []))

    def test_a_long_source_and_a_long_header_are_named(self):
        self.write("holdfast/core/a.cpp", "\n" * 401)
        self.assert_offence("check_sizes", "a.cpp: 401 lines, at most 400")
        self.write("holdfast/core/a.cpp", "\n" * 400)
        self.write("holdfast/core/a.hpp", "\n" * 151)
        self.assert_offence("check_sizes", "a.hpp: 151 lines, at most 150")

    def test_a_wide_line_is_counted_in_characters(self):
        self.write("holdfast/core/a.cpp", "// " + "ü" * 97 + "\n")
        self.assertEqual(self.run_check("check_sizes"), (0, []))
        self.write("holdfast/core/a.cpp", "// " + "ü" * 98 + "\n")
        self.assert_offence("check_sizes", "a.cpp:1: 101 columns")

    def test_a_long_function_is_found_behind_any_head(self):
        body = "  f();\n" * 59
        for head in ("void f(int a)", "template <class T>\nauto A<T>::f() const -> int",
                     "A::A(int b) : c_{b}, d_(b)", "TEST(A, B)", "A::~A() noexcept"):
            self.write("holdfast/core/a.cpp",
                       'namespace a {\nconst char* c = "{";\n' + head + " {\n" + body + "}\n}\n")
            lines = 61 + head.count("\n")
            self.assert_offence("check_sizes", "a.cpp:3", f"function of {lines} lines")

    def test_a_class_and_a_namespace_are_no_functions(self):
        members = "  int f() { return 1; }\n" * 70
        self.write("holdfast/core/a.hpp",
                   "namespace a {\nclass A : public B<decltype(f())> {\n" + members + "};\n}\n")
        self.assertEqual(self.run_check("check_sizes"), (0, []))

    def test_a_full_folder_is_named(self):
        for i in range(17):
            self.write(f"holdfast/io/f{i}.cpp", "")
        self.assert_offence("check_sizes", "holdfast/io/: 17 files, at most 16")


class PaperMap(CheckTest):
    HEAD = "| section | code | test | deviation |\n|---|---|---|---|\n"

    def setUp(self):
        super().setUp()
        self.write("tests/core/time_test.cpp", "TEST(Time, IsExact) {}\n")

    def map_row(self, code, test):
        self.write("docs/paper_map.md", self.HEAD + f"| 3.1 | {code} | {test} | none |\n")

    def test_rows_whose_code_and_test_exist_pass(self):
        self.map_row("`holdfast/core/time.hpp: time`", "`tests/core/time_test.cpp: Time.IsExact`")
        self.assertEqual(self.run_check("check_paper_map"), (0, []))

    def test_a_symbol_that_is_gone_is_named(self):
        self.map_row("`holdfast/core/time.hpp: tim`", "`tests/core/time_test.cpp: Time`")
        self.assert_offence("check_paper_map", "paper_map.md:3", "no 'tim' in")

    def test_a_test_that_is_gone_is_named(self):
        self.map_row("`holdfast/core/time.hpp: time`", "`tests/core/time_test.cpp: Time.IsExac`")
        self.assert_offence("check_paper_map", "no 'Time.IsExac' in")

    def test_a_row_without_a_test_is_named(self):
        self.map_row("`holdfast/core/time.hpp: time`", "none")
        self.assert_offence("check_paper_map", "expected a test, found 'none'")


if __name__ == "__main__":
    unittest.main()
