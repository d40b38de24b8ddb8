# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Writes WPILib data logs (.wpilog), for tests: from the specifications, with no code of trussmap.

    with WpiLog("a.wpilog") as log:
        speed = log.start("/drive/speed", "double")        # the entry's number
        log.write(speed, 1_000_000, 0.25)                  # time in microseconds, value
        log.schema("Reading", "double range; enum {no=0, yes=1} uint8 seen; char tag[4]")
        reading = log.start("/reading", "struct:Reading")
        log.write(reading, 1_020_000, {"range": 2.5, "seen": 1, "tag": "A7"})
        log.finish(speed)

Values by type:

    boolean, int64, float, double, string, json    bool, int, float, float, str, str
    TYPE[]                                         a list of them
    struct:NAME, struct:NAME[]                     a dict by member, a list of dicts
    anything else                                  bytes, as they are

In a struct: an array is a list, a char array a str, another struct a dict, an enum its number.
Everything little endian. Sources: WPILib Data Log File Format Specification 1.0 and WPILib Packed
Struct Serialization Specification 1.0.
"""
import re
import struct

_PLAIN = {"bool": "?", "int8": "b", "int16": "h", "int32": "i", "int64": "q", "uint8": "B",
          "uint16": "H", "uint32": "I", "uint64": "Q", "float": "f", "float32": "f",
          "double": "d", "float64": "d"}
_DECLARATION = re.compile(
    r"^(?:(?:enum)?\s*\{[^}]*\}\s*)?(\S+)\s+([^\s\[:]+)\s*(?:\[\s*(\d+)\s*\]|:\s*(\d+))?$")

# As WPILib's own classes state them.
WPILIB = {
    "Rotation2d": "double value",
    "Translation2d": "double x;double y",
    "Pose2d": "Translation2d translation;Rotation2d rotation",
    "Transform2d": "Translation2d translation;Rotation2d rotation",
    "Twist2d": "double dx;double dy;double dtheta",
    "Quaternion": "double w;double x;double y;double z",
    "Rotation3d": "Quaternion q",
    "Translation3d": "double x;double y;double z",
    "Pose3d": "Translation3d translation;Rotation3d rotation",
    "ChassisSpeeds": "double vx;double vy;double omega",
    "DifferentialDriveWheelPositions": "double left;double right",
    "DifferentialDriveWheelSpeeds": "double left;double right",
    "SwerveModulePosition": "double distance;Rotation2d angle",
    "SwerveModuleState": "double speed;Rotation2d angle",
}


class Schemas:
    """Packs dicts as the schemas say."""

    def __init__(self):
        self.members = {}

    def add(self, name, text):
        found = []
        for declared in text.split(";"):
            if not declared.strip():
                continue
            kind, member, count, bits = _DECLARATION.match(declared.strip()).groups()
            found.append((kind, member, int(count) if count else None,
                          int(bits) if bits else None))
        self.members[name] = found

    def pack(self, name, value):
        out = b""
        unit = None  # the integer that bit-fields share: [bytes, bits used, value]
        for kind, member, count, bits in self.members[name]:
            if bits:
                size = struct.calcsize(_PLAIN[kind])
                if unit and kind == "bool":
                    size = unit[0]
                if unit and (unit[0] != size or unit[1] + bits > 8 * size):
                    out += unit[2].to_bytes(unit[0], "little")
                    unit = None
                if not unit:
                    unit = [struct.calcsize(_PLAIN[kind]), 0, 0]
                unit[2] |= (int(value[member]) & ((1 << bits) - 1)) << unit[1]
                unit[1] += bits
                continue
            if unit:
                out += unit[2].to_bytes(unit[0], "little")
                unit = None
            if kind == "char":
                out += value[member].encode().ljust(count or 1, b"\0")
                continue
            elements = [value[member]] if count is None else value[member]
            assert count is None or len(elements) == count, member
            for one in elements:
                out += struct.pack("<" + _PLAIN[kind], one) if kind in _PLAIN else \
                    self.pack(kind, one)
        if unit:
            out += unit[2].to_bytes(unit[0], "little")
        return out


def _shortest(number):
    return number.to_bytes(max(1, (number.bit_length() + 7) // 8), "little")


def _text(text):
    return struct.pack("<I", len(text.encode())) + text.encode()


class WpiLog:
    """A log that is written record by record."""

    def __init__(self, path, extra="", version=0x0100):
        self.file = open(path, "wb")
        self.file.write(b"WPILOG" + struct.pack("<H", version) + _text(extra))
        self.types = {}
        self.entries = 0
        self.schemas = Schemas()
        for name, text in WPILIB.items():
            self.schemas.add(name, text)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()

    def record(self, entry, time, payload, wide=False):
        """Any record; `wide` has the longest numbers in its head, as a writer may choose."""
        fields = [_shortest(entry), _shortest(len(payload)), _shortest(time & (2**64 - 1))]
        if wide:
            fields = [one.ljust(size, b"\0") for one, size in zip(fields, (4, 4, 8))]
        lengths = sum((len(one) - 1) << shift for one, shift in zip(fields, (0, 2, 4)))
        self.file.write(bytes([lengths]) + b"".join(fields) + payload)

    def start(self, name, kind, metadata="", time=0, entry=None):
        """Starts an entry and returns its number; `entry`: one that has been finished."""
        if entry is None:
            self.entries += 1
            entry = self.entries
        self.types[entry] = kind
        self.record(0, time, b"\0" + struct.pack("<I", entry) + _text(name) + _text(kind) +
                    _text(metadata))
        return entry

    def finish(self, entry, time=0):
        self.record(0, time, b"\1" + struct.pack("<I", entry))

    def set_metadata(self, entry, metadata, time=0):
        self.record(0, time, b"\2" + struct.pack("<I", entry) + _text(metadata))

    def schema(self, name, text, prefix="", time=0):
        """Writes a schema into the log; `prefix`: "NT:" where it came by NetworkTables."""
        self.schemas.add(name, text)
        entry = self.start(prefix + "/.schema/struct:" + name, "structschema", time=time)
        self.record(entry, time, text.encode())

    def wpilib_schemas(self, *names):
        for name in names:
            self.schema(name, WPILIB[name])

    def write(self, entry, time, value, wide=False):
        self.record(entry, time, self.packed(self.types[entry], value), wide)

    def packed(self, kind, value):
        plain = {"boolean": "<?", "int64": "<q", "float": "<f", "double": "<d"}
        if kind in plain:
            return struct.pack(plain[kind], value)
        if kind in ("string", "json"):
            return value.encode()
        if kind == "string[]":
            return struct.pack("<I", len(value)) + b"".join(map(_text, value))
        if kind.endswith("[]") and kind != "raw[]":
            return b"".join(self.packed(kind[:-2], one) for one in value)
        if kind.startswith("struct:"):
            return self.schemas.pack(kind[len("struct:"):], value)
        return value
