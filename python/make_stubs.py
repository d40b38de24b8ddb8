# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Writes the type stubs of the module: _core.pyi.in, with what the module says of its own results.

    make_stubs.py PACKAGE_FOLDER

"# FIELDS" in a class stands for the attributes that the module notes of it, "# ROWS" for all
classes that consist of such attributes alone.
"""
import importlib.util
import re
import sys
from pathlib import Path

TEMPLATE = Path(__file__).with_name("_core.pyi.in")


def module_in(folder):
    """The module alone: the package may not be whole yet."""
    (file,) = folder.glob("_core*.so")
    spec = importlib.util.spec_from_file_location("trussmap._core", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def main():
    folder = Path(sys.argv[1])
    noted = {name: "".join(f"    {line}\n" for line in lines)
             for name, lines in module_in(folder)._stub_lines().items()}
    text = TEMPLATE.read_text(encoding="utf-8")
    by_hand = set(re.findall(r"^class (\w+)", text, re.M))
    rows = "\n".join(f"class {name}:\n{lines}" for name, lines in noted.items() if name not in by_hand)
    text = text.replace("# ROWS\n", rows)
    text = re.sub(r"^(class (\w+).*\n)    # FIELDS\n", lambda found: found[1] + noted[found[2]], text, flags=re.M)
    (folder / "_core.pyi").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
