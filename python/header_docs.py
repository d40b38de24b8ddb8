# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Writes what the public headers say of each name as a C++ table, for docstrings.

    header_docs.py OUT.cpp HEADER...

A key is a function's or type's name, or TYPE.MEMBER. The text is the /// comment above the
declaration, or the ///< comment behind it; of a name that occurs more than once (overloads), the
first that says anything.
"""
import re
import sys

OPENS = re.compile(r"^(?:struct|class|enum class)\s+(\w+)\b[^;]*\{")
MEMBER = re.compile(r"(\w+)\s*(?:=[^;]*|\{[^;]*\})?;$")
ENUMERATOR = re.compile(r"^(\w+)\s*(?:=[^,]*)?,?$")
FUNCTION = re.compile(r"(\w+)\(")


def name_of(declaration, in_enum):
    """The name that a declaration introduces, or None."""
    code = declaration.strip()
    if in_enum:
        found = ENUMERATOR.search(code)
        return found.group(1) if found else None
    code = re.sub(r"\[\[nodiscard\]\]\s*|^(?:explicit|static|inline|constexpr|virtual)\s+", "", code)
    if not code or code.startswith(("#", "}", "namespace", "using", "friend", "public", "private")):
        return None
    found = OPENS.match(code) or re.match(r"^(?:struct|class)\s+(\w+);", code)
    if found:
        return found.group(1)
    found = MEMBER.search(code)
    before = code.split("=")[0]
    if found and "(" not in before:
        return found.group(1)
    found = FUNCTION.search(code)
    return found.group(1) if found else None


def docs_of(text):
    docs = {}
    scope, in_enum, above, declaration, behind = [], [], [], "", []
    last_key = None
    for raw in text.split("\n"):
        line = raw.strip()
        if line.startswith("///<"):  # goes on from the line above
            if last_key:
                docs[last_key] = (docs.get(last_key, "") + " " + line[4:].strip()).strip()
            continue
        if line.startswith("///"):
            above.append(line[3:].strip())
            continue
        if line.startswith("//"):
            above, declaration = [], ""
            continue
        code, _, comment = line.partition("///<")
        code = code.split("  // ")[0].strip()
        if not code:
            if not declaration:
                above = []
            continue
        if comment:
            behind.append(comment.strip())
        declaration = (declaration + " " + code).strip()
        enum = bool(in_enum and in_enum[-1])
        if not (enum or declaration.endswith((";", "{", "}", "};")) or declaration.startswith("#")):
            continue
        found = OPENS.match(declaration)
        name = name_of(declaration, enum)
        said = " ".join(behind if behind else above)
        if name:
            key = ".".join(scope + [name])
            if said and key not in docs:
                docs[key] = said
            last_key = key
        if found and "}" not in declaration[found.end():]:
            scope.append(found.group(1))
            in_enum.append(declaration.startswith("enum"))
        elif declaration.endswith("{") and not declaration.startswith("namespace"):
            scope.append("")  # a body
            in_enum.append(False)
        closes = declaration.count("}") - declaration.count("{", 1 if declaration.endswith("{") else 0)
        if declaration.startswith("}") and scope:
            scope.pop()
            in_enum.pop()
            last_key = None
        above, declaration, behind = [], "", []
    return docs


# What a reader of Python knows by another name.
IN_PYTHON = (("like fit_model", "as fit does"), ("as fit_model does", "as fit does"),
             ("std::invalid_argument", "ValueError"), ("std::out_of_range", "IndexError"),
             ("std::nullopt", "None"), ("nullptr", "None"), ("Throws", "Raises"), ("throws", "raises"))


def in_python(said):
    for of_cpp, of_python in IN_PYTHON:
        said = said.replace(of_cpp, of_python)
    return said


def main(arguments):
    docs = {}
    for header in arguments[1:]:
        with open(header, encoding="utf-8") as file:
            for key, said in docs_of(file.read()).items():
                docs.setdefault(key, said)
    lines = ['#include "docs.hpp"', "", "namespace trussmap::python {", "",
             "const std::map<std::string_view, const char*>& header_docs() {",
             "  static const std::map<std::string_view, const char*> docs{"]
    for key in sorted(docs):
        said = in_python(docs[key]).replace("\\", "\\\\").replace('"', '\\"')
        lines.append(f'      {{"{key}", "{said}"}},')
    lines += ["  };", "  return docs;", "}", "", "}  // namespace trussmap::python", ""]
    with open(arguments[0], "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1:])
