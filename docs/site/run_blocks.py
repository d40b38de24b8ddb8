#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Runs what the pages show. Blocks of one page run in their order, in a scratch folder that has
# maps/ and build/trussmap, as the top of the project has them. Usage: run_blocks.py COMMAND [PAGE...]
#
#   ```sh                     run by bash; must end with status 0. What builds (make, cmake) is not run
#   ``` with "$ " lines       each run, and must print what stands below it, up to "..."
#   ```python                 run, all of a page as one program, where the package trussmap can be imported
#   ```diff                   must apply to the project as it is, after those before it on the page
#   <!-- file: NAME -->       the block below is written to NAME
#   <!-- not run: WHY -->     the block below is not run
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True  # nothing is left beside the sources

from pages import TOP, Contents

FENCE = re.compile(r"^( *)```([a-z]*)\n(.*?)^\1```$", re.M | re.S)
MARK = re.compile(r"<!-- (file|not run): (.*?) -->\s*$")
PROJECT = ("src", "include", "apps", "tests", "docs", "maps", "cmake", "CMakeLists.txt",
           "README.md", "CHANGELOG.md")


class Page:
    def __init__(self, path, command):
        self.path = path
        self.command = command
        self.faults = []
        self.ran = 0
        self.skipped = []
        self.project = None  # a copy that diffs have been applied to

    def fault(self, line, what):
        self.faults.append(f"{self.path.relative_to(TOP)}:{line}: {what}")

    def bash(self, script, folder):
        environment = {**os.environ, "NO_COLOR": "1", "TERM": "dumb"}
        return subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, text=True,
                              capture_output=True, env=environment, timeout=580)

    def shell(self, text, line, folder):
        ran = self.bash(text, folder)
        if ran.returncode != 0:
            self.fault(line, f"status {ran.returncode}\n{text}{ran.stdout[-800:]}{ran.stderr[-800:]}")

    def prompts(self, text, line, folder):
        for one in re.split(r"^\$ ", text, flags=re.M)[1:]:
            asked, _, shown = one.partition("\n")
            while asked.endswith("\\"):
                more, _, shown = shown.partition("\n")
                asked = asked[:-1] + more.strip()
            ran = self.bash(asked, folder)
            if ran.returncode != 0:
                self.fault(line, f"status {ran.returncode}: {asked}\n{ran.stderr[-800:]}")
            whole = not re.search(r"^\.\.\.$", shown, re.M)
            wanted = shown if whole else re.split(r"^\.\.\.$", shown, flags=re.M)[0]
            printed = ran.stdout if whole else ran.stdout[:len(wanted)]
            if printed.rstrip() != wanted.rstrip():
                self.fault(line, f"{asked}\nprints\n{ran.stdout[:len(wanted) + 300]}\nand not\n{wanted}")

    def diff(self, text, line, folder):
        if self.project is None:
            self.project = folder / "project"
            self.project.mkdir()
            for name in PROJECT:
                source = TOP / name
                (shutil.copytree if source.is_dir() else shutil.copy)(source, self.project / name)
        ran = subprocess.run(["patch", "-p1", "--fuzz=0", "--no-backup-if-mismatch"],
                             cwd=self.project, input=text, text=True, capture_output=True)
        if ran.returncode != 0:
            self.fault(line, f"the diff does not apply\n{ran.stdout}{ran.stderr}")

    def python(self, blocks, folder):
        """All of a page, after everything else of it: later blocks use what earlier ones have named."""
        text = "\n".join(body for _, body in blocks)
        try:
            ran = subprocess.run([sys.executable, "-c", text], cwd=folder, text=True,
                                 capture_output=True, timeout=580)
        except subprocess.TimeoutExpired:
            self.fault(blocks[0][0], "takes too long")
            return
        if ran.returncode != 0:
            self.fault(blocks[0][0], f"status {ran.returncode}\n{ran.stderr[-800:]}")

    def run(self, python_there):
        text = self.path.read_text()
        programs = []  # (line, block) of Python
        with tempfile.TemporaryDirectory(prefix="trussmap-page-") as name:
            folder = Path(name)
            (folder / "build").mkdir()
            (folder / "build" / "trussmap").symlink_to(self.command)
            shutil.copytree(TOP / "maps", folder / "maps")
            for block in FENCE.finditer(text):
                line = text.count("\n", 0, block.start()) + 1
                mark = MARK.search(text[:block.start()])
                kind, body = block[2], block[3]
                if mark and mark[1] == "file":
                    target = folder / mark[2]
                    target.parent.mkdir(parents=True, exist_ok=True)
                    target.write_text(body)
                    continue
                job = {"sh": self.shell, "diff": self.diff, "python": programs.append}.get(kind)
                if kind in ("", "console") and re.search(r"^\$ ", body, re.M):
                    job = self.prompts
                if job is None:
                    continue
                if kind == "sh" and re.search(r"^(make|cmake|apt-get)\b", body, re.M):
                    self.skipped.append(f"{self.path.relative_to(TOP)}:{line}: it builds")
                    continue
                if mark or (kind == "python" and not python_there):
                    why = mark[2] if mark else "the Python package is not there"
                    self.skipped.append(f"{self.path.relative_to(TOP)}:{line}: {why}")
                    continue
                self.ran += 1
                if kind == "python":
                    programs.append((line, body))
                    continue
                try:
                    job(body, line, folder)
                except subprocess.TimeoutExpired:
                    self.fault(line, "takes too long")
            if programs:
                self.python(programs, folder)
        return self


def main():
    parser = argparse.ArgumentParser(description="Runs what the pages show.")
    parser.add_argument("command")
    parser.add_argument("pages", nargs="*")
    options = parser.parse_args()
    command = Path(options.command).resolve()
    paths = [Path(one).resolve() for one in options.pages]
    if not paths:
        paths = [TOP / path for name, path in Contents().files.items()
                 if path.startswith("docs/") and not path.startswith("docs/notebooks/")
                 or path in ("README.md", "CONTRIBUTING.md")]  # notebooks: make notebooks
    python_there = subprocess.run([sys.executable, "-c", "import trussmap"],
                                  capture_output=True).returncode == 0
    began = time.monotonic()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        pages = list(pool.map(lambda path: Page(path, command).run(python_there), paths))
    for page in pages:
        for one in page.skipped:
            print("not run: " + one)
    for page in pages:
        for one in page.faults:
            print(one)
    ran = sum(page.ran for page in pages)
    faults = sum(len(page.faults) for page in pages)
    print(f"{ran} blocks ran, {faults} faults, {sum(len(p.skipped) for p in pages)} not run, "
          f"{time.monotonic() - began:.0f} s")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
