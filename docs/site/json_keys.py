# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The reference of what commands write with --json, from the schema that the command prints.
import json
import re
import subprocess

FEW = 3  # keys that are said again where others build on them
WORDS = {"string": "text", "integer": "whole number", "boolean": "true or false", "null": "null"}


def reference_of(schema):
    """The definition that a value is of; None: it is described in place."""
    if "$ref" in schema:
        return schema["$ref"].removeprefix("#/definitions/")
    only = schema.get("allOf", [])
    return reference_of(only[0]) if len(only) == 1 and "properties" not in schema else None


def kind_of(schema):
    """A value's type in words."""
    reference = reference_of(schema)
    if reference:
        return f"[{reference}](#{reference})"
    if "anyOf" in schema:
        return " or ".join(kind_of(one) for one in schema["anyOf"])
    if "enum" in schema:
        return ", ".join("null" if one is None else f"`{one}`" for one in schema["enum"])
    kinds = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
    if kinds == ["array"]:
        return "list of " + plural(schema["items"])
    if kinds == ["object"]:
        return "by key: " + kind_of(schema["additionalProperties"]) if "additionalProperties" in schema else "object"
    return " or ".join(WORDS.get(one, one) for one in kinds)


def plural(items):
    kind = kind_of(items)
    if kind.startswith("list of"):
        return kind.replace("list", "lists", 1)
    return {"object": "objects", "text": "texts", "number": "numbers", "whole number": "whole numbers"}.get(kind, kind)


def rows_of(schema, before, definitions):
    """(key, type, meaning) of an object's keys, those of objects within it after their own."""
    for base in schema.get("allOf", []):
        whole = definitions[reference_of(base)]
        if len(whole["properties"]) <= FEW:
            yield from rows_of(whole, before, definitions)
        else:
            yield (f"{before}…", kind_of(base), "its keys, too")
    required = schema.get("required", [])
    for key, value in schema.get("properties", {}).items():
        meaning = value.get("description", "")
        if key not in required:
            meaning = f"{meaning} (may be absent)".strip()
        yield (before + key, kind_of(value), meaning)
        if reference_of(value):
            continue
        for inner, mark in ((value, ""), *((one, "") for one in value.get("anyOf", [])), (value.get("items", {}), "[]"),
                            (value.get("additionalProperties", {}), ".*")):
            if "properties" in inner:
                yield from rows_of(inner, f"{before}{key}{mark}.", definitions)


def table_of(schema, definitions):
    lines = ["| key | type | meaning |", "|---|---|---|"]
    for key, kind, meaning in rows_of(schema, "", definitions):
        meaning = re.sub(r"--[a-z-]+", r"`\g<0>`", meaning).replace("|", r"\|")
        lines.append(f"| `{key}` | {kind} | {meaning} |")
    return "\n".join(lines)


def is_command(name, commands):
    return name.split("-")[0] in commands


def section(name, definitions, level):
    schema = definitions[name]
    text = f"\n{level} {name}\n\n"
    if "description" in schema:
        text += f"{schema['description'].capitalize()}.\n\n"
    if reference_of(schema):
        return text + f"As {kind_of(schema)}.\n"
    inner = schema.get("items", schema.get("additionalProperties"))
    if inner is None:
        return text + table_of(schema, definitions) + "\n"
    text += f"A {kind_of(schema)}.\n" if "items" in schema else f"An object, {kind_of(schema)}.\n"
    return text + ("\n" + table_of(inner, definitions) + "\n" if "properties" in inner else "")


def write(stage, command, commands):
    """A page with a section for each command, and their common parts after them."""
    printed = subprocess.run([command, "schema"], text=True, capture_output=True, check=True).stdout
    schema = json.loads(printed)
    text = ("# JSON keys\n\nWhat each command writes with `--json`, by the schema that `trussmap schema` prints "
            "([how to use it](formats.md#json-keys)). " + schema["description"] + "\n")
    definitions = schema["definitions"]
    own = sorted(name for name in definitions if is_command(name, commands))
    for name in own:
        text += section(name, definitions, "##")
    text += "\n## Common parts\n\nWhat several of them have.\n"
    for name in definitions:
        if name not in own:
            text += section(name, definitions, "###")
    stage.write("json", text)
