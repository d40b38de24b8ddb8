# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""The type stubs: mypy takes them, the module is as they say, and they catch a wrong type."""
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import trussmap
from places import scratch_folder

PACKAGE = Path(trussmap.__file__).parent

RIGHT = """
import numpy as np
import trussmap

recording = trussmap.Recording({"t": np.arange(3.0), "left": np.ones(3), "right": np.ones(3)})
model: trussmap.Model = trussmap.Model(0.34, noise={"left": 0.003}).with_effect("wheelbase")
diagnosis = trussmap.diagnose([recording], model, progress=lambda what, done: None)
best: trussmap.Finding = diagnosis.candidates[0]
score: float = best.score
"""
WRONG = """
import trussmap
number: int = trussmap.diagnose("folder", trussmap.Model()).missing
"""


@unittest.skipUnless(shutil.which("mypy"), "needs mypy")
class Stubs(unittest.TestCase):
    def run_mypy(self, program):
        file = scratch_folder(self) / "program.py"
        file.write_text(program, encoding="utf-8")
        return subprocess.run(
            ["mypy", "--strict", "--no-incremental", "--cache-dir", os.devnull, str(file)],
            capture_output=True, text=True, check=False,
            env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})

    def test_take_what_is_right(self):
        done = self.run_mypy(RIGHT)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_refuse_what_is_wrong(self):
        done = self.run_mypy(WRONG)
        self.assertEqual(done.returncode, 1)
        self.assertIn("Incompatible types in assignment", done.stdout)

    def test_are_of_this_module(self):
        done = subprocess.run(
            [sys.executable, "-m", "mypy.stubtest", "--concise", "--ignore-missing-stub",
             "trussmap"],
            capture_output=True, text=True, check=False, cwd=scratch_folder(self),
            env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})
        # What pybind11 makes of every class.
        usual = ("metaclass differs", ".__init__ is inconsistent", ".__hash__ is inconsistent")
        wrong = [line for line in done.stdout.split("\n")
                 if line.startswith("trussmap.") and not any(one in line for one in usual)]
        self.assertEqual(wrong, [])
        self.assertIn("metaclass differs", done.stdout)  # it was looked at


if __name__ == "__main__":
    unittest.main()
