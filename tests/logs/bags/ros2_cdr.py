# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""ROS 2 messages out of Python dicts, by their definitions.

    definition = "std_msgs/Header header\\nfloat64 range\\n" + "=" * 80 + "\\nMSG: std_msgs/Header\\n..."
    encoder = Encoder("my_msgs/msg/Range", definition)
    data = encoder.encode({"header": {"frame_id": "sonar"}, "range": 1.5})
    lines = encoder.flat({"range": 1.5})  # what a reader must find, field by field

Members that a dict lacks are zero or empty. Lists of uint8 may be bytes. Written from the OMG's
DDS-XTypes 1.3 (7.4, encoding version 1) and the ROS 2 documentation ("Interfaces"), for tests of the
readers in src/logs, of which it shares nothing.
"""

import re
import struct

SIZES = {
    "bool": "?", "byte": "B", "char": "B", "octet": "B", "int8": "b", "uint8": "B", "int16": "h",
    "uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f",
    "float64": "d",
}  # fmt: skip


def short(name):
    return name.replace("/msg/", "/")


class Field:
    """One line of a definition: TYPE NAME."""

    def __init__(self, kind, name, package):
        match = re.fullmatch(r"([\w/]+)(?:<=\d+)?(\[(<=)?(\d*)\])?", kind)
        if not match:
            raise ValueError(f"{kind} is no type")
        base = match[1]
        self.name = name
        self.plain = base in SIZES
        self.text = base if base in ("string", "wstring") else None
        self.base = base if self.plain or self.text or "/" in base else f"{package}/{base}"
        self.base = short(self.base)
        self.is_list = match[2] is not None
        self.count = int(match[4]) if self.is_list and match[4] and not match[3] else None


def fields_of(text, package):
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        if not line:
            continue
        kind, rest = re.split(r"\s+", line, maxsplit=1)
        match = re.match(r"(\w+)\s*(=?)", rest)
        if not match[2]:
            yield Field(kind, match[1], package)


class Encoder:
    def __init__(self, kind, definition, big_endian=False, wide_characters=2):
        self.kind = short(kind)
        self.order = ">" if big_endian else "<"
        self.big_endian = big_endian
        self.wide_characters = wide_characters
        parts = re.split(r"^=+\nMSG: *(\S+) *\n", definition, flags=re.MULTILINE)
        time = "int32 sec\nuint32 nanosec"  # every reader knows these, and some bags leave them out
        texts = {"builtin_interfaces/Time": time, "builtin_interfaces/Duration": time}
        texts[self.kind] = parts[0]
        for name, text in zip(parts[1::2], parts[2::2]):
            texts[short(name)] = text
        self.types = {name: list(fields_of(text, name.split("/")[0])) for name, text in texts.items()}

    def encode(self, message):
        self.out = bytearray()
        self._group(self.kind, message)
        return bytes([0, 0 if self.big_endian else 1, 0, 0]) + bytes(self.out)

    def _align(self, size):
        self.out += bytes(-len(self.out) % size)

    def _number(self, letter, value):
        self._align(struct.calcsize("=" + letter))
        self.out += struct.pack(self.order + letter, value)

    def _text(self, kind, value):
        if kind == "string":
            raw = value.encode() + b"\0"
            self._number("I", len(raw))
            self.out += raw
            return
        wide = "utf-16" if self.wide_characters == 2 else "utf-32"
        raw = value.encode(wide + ("-be" if self.big_endian else "-le"))
        self._number("I", len(raw) // self.wide_characters)
        self.out += raw

    def _value(self, field, value):
        if field.plain:
            self._number(SIZES[field.base], value)
        elif field.text:
            self._text(field.text, value)
        else:
            self._group(field.base, value)

    def _group(self, kind, message):
        fields = self.types[kind]
        unknown = set(message) - {field.name for field in fields}
        if unknown:
            raise ValueError(f"{kind} has no {sorted(unknown)}")
        if not fields:
            self.out += b"\0"  # structure_needs_at_least_one_member
        for field in fields:
            value = message.get(field.name, self._none(field))
            if not field.is_list:
                self._value(field, value)
                continue
            if field.count is None:
                self._number("I", len(value))
            elif len(value) != field.count:
                raise ValueError(f"{kind}.{field.name} has {len(value)} elements")
            if field.plain and isinstance(value, (bytes, bytearray)):
                self.out += value
            elif field.plain and len(value) > 0:
                letter = SIZES[field.base]
                self._align(struct.calcsize("=" + letter))
                self.out += struct.pack(f"{self.order}{len(value)}{letter}", *value)
            else:
                for one in value:
                    self._value(field, one)

    def _none(self, field):
        if not field.is_list:
            return self._none_of(field)
        return [self._none_of(field)] * (field.count or 0)

    @staticmethod
    def _none_of(field):
        return 0 if field.plain else "" if field.text else {}

    def flat(self, message):
        """A line per field: PATH KIND VALUE; numbers by their bits, texts by their UTF-8 bytes."""
        lines = []
        self._flat_group(self.kind, message, "", lines)
        return lines

    def _flat_group(self, kind, message, path, lines):
        for field in self.types[kind]:
            value = message.get(field.name, self._none(field))
            inner = f"{path}.{field.name}" if path else field.name
            if not field.is_list:
                self._flat_value(field, value, inner, lines)
                continue
            lines.append(f"{inner} list {len(value)}")
            for number, one in enumerate(value):
                self._flat_value(field, one, f"{inner}[{number}]", lines)

    def _flat_value(self, field, value, path, lines):
        if field.text:
            lines.append(f"{path} text {value.encode().hex()}")
        elif not field.plain:
            self._flat_group(field.base, value, path, lines)
        elif field.base in ("float32", "float64"):
            letter = SIZES[field.base]
            (seen,) = struct.unpack("<" + letter, struct.pack("<" + letter, value))
            lines.append(f"{path} number {struct.pack('>d', seen).hex()}")
        else:
            lines.append(f"{path} integer {min(int(value), 2**63 - 1)}")
