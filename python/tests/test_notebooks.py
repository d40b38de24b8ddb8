# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Notebooks as pages: their cells, and what the site shows of an executed one. `make notebooks`
executes them."""
import ast
import base64
import json
import sys
import unittest

from places import SOURCE, scratch_folder

sys.path.insert(0, str(SOURCE / "docs" / "site"))
import notebook_cells  # noqa: E402

PAGE = "# Title\n\nText.\n\n```python\na = 1\nprint(a)\n```\n\nMore.\n\n```text\nno cell\n```\n"


class Pages(unittest.TestCase):
    def test_are_text_and_cells_in_turn(self):
        self.assertEqual(notebook_cells.parts_of(PAGE),
                         [("text", "# Title\n\nText."), ("code", "a = 1\nprint(a)"),
                          ("text", "More.\n\n```text\nno cell\n```")])

    def test_each_notebook_is_a_program_that_checks_itself(self):
        pages = sorted((SOURCE / "docs" / "notebooks").glob("*.md"))
        self.assertGreaterEqual(len(pages), 5)
        for page in pages:
            cells = [text for kind, text in notebook_cells.parts_of(page.read_text("utf-8"))
                     if kind == "code"]
            tree = ast.parse("\n".join(cells), str(page))
            asserts = sum(isinstance(node, ast.Assert) for node in ast.walk(tree))
            self.assertGreaterEqual(asserts, 3, page)

    def test_outputs_stand_below_their_cells(self):
        outputs = [{"output_type": "stream", "name": "stdout", "text": ["1\n"]},
                   {"output_type": "stream", "name": "stderr", "text": ["noise\n"]},
                   {"output_type": "display_data",
                    "data": {"image/png": base64.b64encode(b"picture").decode()}}]
        file = scratch_folder(self) / "page.ipynb"
        file.write_text(json.dumps({"cells": [
            {"cell_type": "markdown", "source": ["Text."]},
            {"cell_type": "code", "source": ["a = 1\n", "print(a)"], "outputs": outputs}]}))
        kept = []

        def keep(picture):
            kept.append(picture)
            return "page-1.png"

        shown = notebook_cells.shown(PAGE, notebook_cells.executed_cells(file), keep)
        self.assertLess(shown.index("print(a)"), shown.index("\n1\n"))
        self.assertLess(shown.index("\n1\n"), shown.index("page-1.png"))
        self.assertLess(shown.index("page-1.png"), shown.index("More."))
        self.assertNotIn("noise", shown)
        self.assertEqual(kept, [b"picture"])

    def test_what_was_executed_before_a_change_is_not_shown(self):
        self.assertIsNone(notebook_cells.shown(PAGE, [("a = 2", [])], None))
        self.assertEqual(notebook_cells.executed_cells(SOURCE / "nowhere.ipynb"), [])


if __name__ == "__main__":
    unittest.main()
