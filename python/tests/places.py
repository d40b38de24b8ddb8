# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Where tests find things; scratch folders and the command."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
MAPS = SOURCE / "maps"
SHARED = SOURCE.parent / "shared" / "data"
COMMAND = os.environ.get("TRUSSMAP_COMMAND", str(SOURCE / "build" / "trussmap"))


def scratch_folder(test):
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    return Path(folder.name)


def run_command(*arguments):
    """What the command prints. Skips the test where it has not been built."""
    if not Path(COMMAND).exists():
        raise unittest.SkipTest("the command has not been built")
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True,
                          check=False)
    if done.returncode > 1:
        raise AssertionError(done.stderr)
    return done.stdout


def printed_and_json(folder, *arguments):
    """What the command prints, and its JSON."""
    file = folder / "out.json"
    printed = run_command(*arguments, "--json", file)
    return printed, json.loads(file.read_text(encoding="utf-8"))
