# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""docs/python.md: its examples run, one after the other, and print what it shows."""
import contextlib
import io
import os
import re
import unittest
import warnings

from places import MAPS, SOURCE, scratch_folder

PAGE = SOURCE / "docs" / "python.md"
BLOCK = re.compile(r"^```(python|text)\n(.*?)^```", re.MULTILINE | re.DOTALL)


class Page(unittest.TestCase):
    def test_runs_and_prints_what_it_shows(self):
        folder = scratch_folder(self)
        (folder / "maps").symlink_to(MAPS)
        before = os.getcwd()
        os.chdir(folder)
        self.addCleanup(os.chdir, before)
        warnings.simplefilter("ignore")
        names, printed, run, shown = {}, "", 0, 0
        for kind, text in BLOCK.findall(PAGE.read_text(encoding="utf-8")):
            if kind == "python":
                output = io.StringIO()
                with contextlib.redirect_stdout(output):
                    exec(compile(text, str(PAGE), "exec"), names)
                printed = output.getvalue().split("\n")
                run += 1
            else:
                for line in text.rstrip("\n").split("\n"):
                    self.assertIn(line, printed)
                    shown += 1
        self.assertGreaterEqual(run, 6)
        self.assertGreaterEqual(shown, 5)


if __name__ == "__main__":
    unittest.main()
