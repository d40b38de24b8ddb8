#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The table of the catalogue in docs/effects.md: a row for every effect that `trussmap effects --json`
# lists. Usage: effects_table.py COMMAND writes it anew; gallery.py --check looks whether it is right.
import json
import re
import subprocess
import sys

sys.dont_write_bytecode = True  # nothing is left beside the sources

from pages import TOP

PAGE = TOP / "docs/effects.md"
TABLE = re.compile(r"^\| name \| unit of a coefficient \|.*?(?=\n\n)", re.M | re.S)
HEAD = "| name | unit of a coefficient | channel × shapes | what causes it | what helps |\n|---|---|---|---|---|"


def effects_of(command):
    ran = subprocess.run([command, "effects", "--json", "/dev/stdout"], text=True, capture_output=True, check=True)
    return json.loads(ran.stdout.split("\n}\n")[0] + "\n}")["effects"]


def unit_of(entry):
    return entry["unit"].replace("^2", "²").replace(" ", "·") or "–"


def table_of(entries):
    rows = [HEAD]
    for one in entries:
        shapes = ", ".join(f"`{shape}`" for shape in one["shape"])
        rows.append(f"| `{one['in_full']}` | {unit_of(one)} | `{one['channel']}` × {shapes} | {one['cause']} | "
                    f"{one['remedy']} |")
    return "\n".join(rows)


def is_right(entries):
    return table_of(entries) in PAGE.read_text()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: effects_table.py COMMAND")
    table = table_of(effects_of(sys.argv[1]))
    text, count = TABLE.subn(lambda match: table, PAGE.read_text())
    if count != 1:
        sys.exit(f"{PAGE}: there is no table of the catalogue, or there are several")
    PAGE.write_text(text)
