#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# A header as doxygen and Sphinx are to see it: a backslash in a comment is a backslash, no command;
# defaults by designated initialisers, which Sphinx cannot read, are left out; all is in one namespace,
# which a page per header would declare anew each time.
import re
import sys

for line in open(sys.argv[1], encoding="utf-8"):
    if line.lstrip().startswith("///") or "///<" in line:
        line = line.replace("\\", "\\\\")
    if re.fullmatch(r"namespace trussmap \{|\}  // namespace trussmap", line.rstrip()):
        line = "\n"
    line = re.sub(r"( = )?\{ *\.[^{}]*\}(?=;)", "", line)
    sys.stdout.write(line)
