# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Writes Road Runner logs (.log of FTC robots), for tests: from the format that
acmerobotics/road-runner-ftc writes (LogFile.kt), with no code of trussmap.

    POSE = struct_of(timestamp=LONG, x=DOUBLE, y=DOUBLE, heading=DOUBLE)
    MODE = enum_of("INIT", "RUN")
    with RoadRunnerLog("a.log") as log:
        log.channel("ESTIMATED_POSE", POSE)                # optional `version=0`: see below
        log.write("ESTIMATED_POSE", {"timestamp": 10, "x": 0.0, "y": 0.5, "heading": 0.1})
        log.channel("MODE", MODE)
        log.write("MODE", "RUN")

Schemas: INT, LONG, DOUBLE, STRING, BOOLEAN, struct_of(name=schema, ...), enum_of(name, ...) and
array_of(schema). Values: int, float, str, bool; a dict; a constant's name or its number; a list.
Everything big endian. Version 0 pads the entry of a channel by four bytes for each array in it.
"""
import struct

INT, LONG, DOUBLE, STRING, BOOLEAN = ("int",), ("long",), ("double",), ("string",), ("boolean",)
_TAGS = {"struct": 0, "int": 1, "long": 2, "double": 3, "string": 4, "boolean": 5, "enum": 6,
         "array": 7}


def struct_of(**members):
    return ("struct", members)


def enum_of(*constants):
    return ("enum", constants)


def array_of(element):
    return ("array", element)


def _text(text):
    return struct.pack(">i", len(text.encode())) + text.encode()


def _schema(schema):
    out = struct.pack(">i", _TAGS[schema[0]])
    if schema[0] == "struct":
        out += struct.pack(">i", len(schema[1]))
        for name, member in schema[1].items():
            out += _text(name) + _schema(member)
    elif schema[0] == "enum":
        out += struct.pack(">i", len(schema[1])) + b"".join(map(_text, schema[1]))
    elif schema[0] == "array":
        out += _schema(schema[1])
    return out


def _arrays(schema):
    if schema[0] == "struct":
        return sum(map(_arrays, schema[1].values()))
    return 1 + _arrays(schema[1]) if schema[0] == "array" else 0


def _value(schema, value):
    kind = schema[0]
    if kind == "struct":
        return b"".join(_value(member, value[name]) for name, member in schema[1].items())
    if kind == "enum":
        return struct.pack(">i", value if isinstance(value, int) else schema[1].index(value))
    if kind == "array":
        return struct.pack(">i", len(value)) + b"".join(_value(schema[1], one) for one in value)
    if kind == "string":
        return _text(value)
    return struct.pack({"int": ">i", "long": ">q", "double": ">d", "boolean": ">?"}[kind], value)


class RoadRunnerLog:
    """A log that is written entry by entry."""

    def __init__(self, path, version=1):
        self.file = open(path, "wb")
        self.version = version
        self.channels = {}
        self.file.write(b"RR" + struct.pack(">h", version))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()

    def channel(self, name, schema):
        self.channels[name] = (len(self.channels), schema)
        padding = 4 * _arrays(schema) if self.version == 0 else 0
        self.file.write(struct.pack(">i", 0) + _text(name) + _schema(schema) + bytes(padding))

    def write(self, name, value):
        number, schema = self.channels[name]
        self.file.write(struct.pack(">ii", 1, number) + _value(schema, value))
