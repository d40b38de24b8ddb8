#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Builds the site: docs/site.md says how. Usage: build.py COMMAND OUT
import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True  # nothing is left beside the sources

import check_links
import commands
import gallery
import headers
import json_keys
import pages
import spelling


def doxygen(out):
    (out / "doxygen").mkdir(parents=True, exist_ok=True)
    settings = (pages.HERE / "Doxyfile").read_text() + f"OUTPUT_DIRECTORY = {out / 'doxygen'}\n"
    ran = subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=pages.TOP,
                         capture_output=True)
    if ran.returncode != 0 or ran.stderr:
        sys.exit(f"doxygen:\n{ran.stderr}")


def katex(out):
    """Style and fonts of the formulas."""
    source = Path("/usr/share/javascript/katex")
    static = out / "static"
    static.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source / "katex.min.css", static / "katex.min.css")
    shutil.copytree(source / "fonts", static / "fonts", dirs_exist_ok=True)


def sphinx(out):
    environment = {**os.environ, "TRUSSMAP_SITE": str(out)}
    ran = subprocess.run(["sphinx-build", "-W", "--keep-going", "-q", "-b", "html", "-c", pages.HERE,
                          "-d", out / "doctrees", out / "source", out / "html"], env=environment)
    if ran.returncode != 0:
        shutil.rmtree(out / "doctrees", ignore_errors=True)  # or the next build would not warn again
        sys.exit("the site was not built: see the warnings above")


def main():
    parser = argparse.ArgumentParser(description="Builds the site of trussmap.")
    parser.add_argument("command", help="the executable")
    parser.add_argument("out", help="folder; the site is OUT/html")
    options = parser.parse_args()
    command = Path(options.command).resolve()
    out = Path(options.out).resolve()
    began = time.monotonic()

    def done(what):
        print(f"{time.monotonic() - began:6.1f} s  {what}", flush=True)

    contents = pages.Contents()
    spelling.check(contents)
    done("spelling")
    stage = pages.Stage(out / "source", contents, out.parent / "notebooks")
    for name, path in contents.files.items():
        stage.page(name, path)
    commands.write(stage, command)
    json_keys.write(stage, command, commands.names_of(commands.help_of(command)))
    headers.write(stage)
    done("pages")
    gallery.write(stage, command, out / "gallery")
    stage.forget()
    done("gallery of effects")
    doxygen(out)
    katex(out)
    done("headers")
    sphinx(out)
    done("Sphinx")
    links = check_links.check(out / "html")
    done(f"{links} links, none dead")
    print(f"the site is {os.path.relpath(out / 'html' / 'index.html')}")


if __name__ == "__main__":
    main()
