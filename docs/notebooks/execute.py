#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Executes the notebooks and writes each, with what it printed and drew, as OUT/NAME.ipynb and
# OUT/NAME.html. Ends with status 1 where a cell fails. Usage: execute.py [--package DIR] OUT [PAGE...]
import argparse
import os
import re
import sys
import time
import traceback
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True  # nothing is left beside the sources

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "site"))

from notebook_cells import parts_of

MOST_SECONDS = 900  # a cell


def notebook_of(page):
    from nbformat import v4
    cells = [v4.new_markdown_cell(text) if kind == "text" else v4.new_code_cell(text)
             for kind, text in parts_of(page)]
    for number, cell in enumerate(cells):
        cell["id"] = f"cell-{number}"  # the same at every run
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return v4.new_notebook(cells=cells, metadata={"kernelspec": kernel})


def execute(path, out):
    """Seconds, and what went wrong; empty: nothing."""
    import nbformat
    from nbclient import NotebookClient
    from nbconvert import HTMLExporter
    notebook = notebook_of(path.read_text(encoding="utf-8"))
    began, fault = time.monotonic(), ""
    try:
        NotebookClient(notebook, timeout=MOST_SECONDS, kernel_name="python3",
                       resources={"metadata": {"path": str(HERE)}}).execute()
    except Exception:  # what a cell raises, and what becomes of a kernel that dies
        fault = re.sub("\x1b\\[[0-9;]*m", "", traceback.format_exc(limit=0))
    for cell in notebook.cells:  # times of this run, which no diff should show
        cell.metadata.pop("execution", None)
    nbformat.write(notebook, out / f"{path.stem}.ipynb")
    html, _ = HTMLExporter().from_notebook_node(notebook)
    (out / f"{path.stem}.html").write_text(html, encoding="utf-8")
    return time.monotonic() - began, fault


def main():
    parser = argparse.ArgumentParser(description="Executes the notebooks.")
    parser.add_argument("--package", default=str(HERE.parents[1] / "build" / "python"),
                        help="folder of the Python package trussmap")
    parser.add_argument("out", help="folder of what is written")
    parser.add_argument("pages", nargs="*", help="notebooks; else all")
    options = parser.parse_args()
    out = Path(options.out).resolve()
    out.mkdir(parents=True, exist_ok=True)
    if not (Path(options.package) / "trussmap").is_dir():
        sys.exit(f"{options.package} has no package trussmap: make python")
    os.environ["PYTHONPATH"] = str(Path(options.package).resolve())
    os.environ.update(PYTHONDONTWRITEBYTECODE="1", OPENBLAS_NUM_THREADS="1",
                      PYDEVD_DISABLE_FILE_VALIDATION="1",
                      IPYTHONDIR=str(out / "ipython"), MPLCONFIGDIR=str(out / "matplotlib"))
    pages = [Path(one).resolve() for one in options.pages] or sorted(HERE.glob("*.md"))
    failed = False
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        runs = [pool.submit(execute, page, out) for page in pages]
        for page, run in zip(pages, runs):
            took, fault = run.result()
            failed = failed or bool(fault)
            print(f"{took:6.1f} s  {page.stem}{': FAILED' if fault else ''}", flush=True)
            if fault:
                print(fault)
    print(f"written: {os.path.relpath(out)}/*.html, *.ipynb")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
