#!/usr/bin/env python3
"""scripts/update_tables replaces what stands between markers, and nothing else."""

import importlib.machinery
import importlib.util
import os
import re
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def load_script():
    loader = importlib.machinery.SourceFileLoader(
        "update_tables", os.path.join(ROOT, "scripts", "update_tables"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


SCRIPT = load_script()
PAGE = """# Page
<!-- table:step -->
old step
<!-- /table:step -->
between
<!-- table:accuracy -->
<!-- /table:accuracy -->
end
"""


class UpdateTables(unittest.TestCase):
    def test_replaces_the_named_block_and_nothing_else(self):
        text = SCRIPT.with_tables(PAGE, {"step": "| new |\n"})
        self.assertEqual(text, PAGE.replace("old step\n", "| new |\n"))

    def test_fills_an_empty_block(self):
        text = SCRIPT.with_tables(PAGE, {"accuracy": "| row |\n"})
        self.assertIn("<!-- table:accuracy -->\n| row |\n<!-- /table:accuracy -->", text)
        self.assertIn("old step", text)

    def test_gives_the_same_page_when_run_twice(self):
        tables = {"step": "a \\1 b\n", "accuracy": "c\n"}
        once = SCRIPT.with_tables(PAGE, tables)
        self.assertEqual(SCRIPT.with_tables(once, tables), once)
        self.assertIn("a \\1 b", once)

    def test_puts_the_commit_behind_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "step.md"), "w", encoding="utf-8") as file:
                file.write("| t |\n\n`holdfast bench step`, some CPU\n")
            table = SCRIPT.table_of("step", folder, "abc1234")
        self.assertTrue(table.endswith("`holdfast bench step`, some CPU, commit abc1234\n"), table)

    def test_every_marker_of_the_pages_is_a_bench_and_is_closed(self):
        with open(os.path.join(ROOT, "benchmarks", "bench.cpp"), encoding="utf-8") as file:
            benches = set(re.findall(r'{"(\w+)"', file.read()))
        self.assertTrue(benches)
        pages = SCRIPT.read_pages()
        self.assertTrue(any("evaluation.md" in path for path in pages))
        for path, text in pages.items():
            opened = re.findall(r"<!-- table:(\w+) -->", text)
            closed = [match.group(2) for match in SCRIPT.BLOCK.finditer(text)]
            self.assertEqual(opened, closed, path)
            self.assertLessEqual(set(opened), benches, path)


if __name__ == "__main__":
    unittest.main()
