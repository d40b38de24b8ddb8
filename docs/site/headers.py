# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The reference of the C++ headers: a page each, in reading order. What stands on top of a header,
# its idea and equations, comes first; then its declarations, by Breathe.
import re

from pages import TOP

GUIDE = "docs/reading-the-code.md"


def in_reading_order():
    """[(header, subject)], as the guide's table has them."""
    guide = (TOP / GUIDE).read_text()
    section = guide[guide.index("## Public headers"):guide.index("\n## Working")]
    found = []
    for names, subject in re.findall(r"^\| ?\d* ?\| ([^|]*) \| ([^|]*) \|$", section, re.M):
        found += [(name, subject) for name in re.findall(r"`([a-z_]+)`", names)]
    return found


def opening(path):
    """The comment on top, without licence."""
    lines = []
    for line in path.read_text().splitlines():
        if not line.startswith("//"):
            break
        if "SPDX-" not in line:
            lines.append(line[2:].removeprefix(" "))
    return "\n".join(lines).strip("\n")


def write(stage):
    order = in_reading_order()
    text = ("# C++ headers\n\nIn reading order; `#include <trussmap/NAME.hpp>`. All is in `namespace trussmap`, which is left out here. [Reading the code]"
            "(../reading-the-code.md) says what to read for what.\n\n| header | subject |\n|---|---|\n")
    for name, subject in order:
        text += f"| [{name}]({name}.rst) | {subject} |\n"
        title = f"{name}.hpp"
        idea = "".join(f"   {line}\n" if line else "\n"
                       for line in opening(TOP / "include/trussmap" / title).splitlines())
        stage.write(f"cpp/{name}", f"{title}\n{'=' * len(title)}\n\n.. code-block:: none\n\n{idea}\n"
                    f".. doxygenfile:: {title}\n   :project: trussmap\n   :sections: briefdescription detaileddescription func public-attrib public-func public-static-func public-type enum typedef user-defined var innerclass\n", ".rst")
    text += "\n```{toctree}\n:hidden:\n\n" + "\n".join(name for name, _ in order) + "\n```\n"
    stage.write("cpp/index", text)
