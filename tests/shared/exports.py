#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""What a shared library exports is declared in the public headers, and nothing else is.

Usage: exports.py LIBRARY HEADER_FOLDER. Prints how many names there are of which kind; status 1 if
one is not public, or if they are too few to be all.
"""
import pathlib
import re
import subprocess
import sys

KINDS = ("typeinfo for ", "typeinfo name for ", "vtable for ")


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def path_of(symbol):
    """a::b::c of `a::b::c[abi:cxx11](x const&) const`."""
    for kind in KINDS:
        symbol = symbol.removeprefix(kind)
    return re.match(r"[\w:~]*(operator[^\w(]+)?", symbol)[0]


def main(library, folder):
    words = set()
    for header in pathlib.Path(folder).glob("*.hpp"):
        words |= set(re.findall(r"\w+", without_comments(header.read_text())))
    table = subprocess.run(["nm", "-D", "-C", "--defined-only", "--without-symbol-versions", library], check=True,
                           capture_output=True, text=True).stdout
    symbols = [line.split(" ", 2)[1:] for line in table.splitlines()]
    symbols = [(kind, name) for kind, name in symbols if kind != "A"]
    wrong = []
    for kind, name in symbols:
        parts = path_of(name).replace("~", "").split("::")
        named = [part for part in parts[1:] if part and not part.startswith("operator")]
        if parts[0] != "trussmap" or not named or not set(named) <= words or {"Impl", "State"} & set(named):
            wrong.append(name)
    weak = sum(kind in "VWu" for kind, _ in symbols)
    print(f"{len(symbols)} exported: {len(symbols) - weak} defined once, {weak} of inline code; "
          f"{len(wrong)} not public")
    for name in wrong:
        print("not public:", name)
    return 1 if wrong or len(symbols) - weak < 300 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
