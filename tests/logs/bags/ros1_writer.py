# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Bags as ROS 1 records them (format 2.0), without ROS, out of the same dicts as those of ROS 2.

    bag = Ros1Bag()
    bag.topic("/odom", "nav_msgs/Odometry")                      # a type that messages.py has
    bag.topic("/wheel", "my_msgs/Wheel", "int64 ticks\\ntime at\\n")   # any other
    bag.write("/odom", time_ns, odometry(time_ns, x=0.0, y=0.0, heading=0.0, speed=0.5))
    bag.write_bag("drive.bag", compression="bz2", chunk_size=64 * 1024)

Written from the ROS wiki ("Bags/Format/2.0", "msg") for tests of the readers in src/logs, of which it
shares nothing. Needs python3-lz4 where lz4 compresses.
"""

import bz2
import re
import struct

from bag_writer import BagWriter
from mcap_file import compressed
from messages import BODIES, definition as ros2_definition
from ros2_cdr import Encoder, short

LINE = b"#ROSBAG V2.0\n"
MESSAGE, BAG_HEADER, INDEX, CHUNK, CHUNK_INFO, CONNECTION = range(2, 8)
HEADER_SIZE = 4096  # bytes of the bag's header with what pads it


def definition(kind):
    """Of a type of messages.py, as ROS 1 has it."""
    parts = re.split(r"^=+\nMSG: *(\S+) *\n", ros2_definition(kind), flags=re.MULTILINE)
    texts = {short(kind): parts[0], **{short(n): t for n, t in zip(parts[1::2], parts[2::2])}}
    texts.pop("builtin_interfaces/Time", None)
    if "std_msgs/Header" in texts:
        texts["std_msgs/Header"] = "# id, consecutive\nuint32 seq\ntime stamp\nstring frame_id\n"
    for name, text in texts.items():  # there fields have no defaults
        texts[name] = re.sub(r"^(float64 \w) [01]$", r"\1", text, flags=re.MULTILINE)
    own = texts.pop(short(kind)).replace("std_msgs/Header header", "Header header")
    return "\n".join([own] + ["=" * 80 + f"\nMSG: {n}\n{t}" for n, t in texts.items()])


class Ros1Encoder(Encoder):
    """Fields one after the other, little-endian, without gaps."""

    def __init__(self, kind, text):
        for old, new in (("time", "builtin_interfaces/Time"), ("byte", "int8"),
                         ("duration", "builtin_interfaces/Duration"),
                         ("Header", "std_msgs/Header")):  # fmt: skip
            text = re.sub(rf"^{old}(?=[ \[])", new, text, flags=re.MULTILINE)
        super().__init__(kind, text)
        self.types["builtin_interfaces/Time"][0].base = "uint32"
        self.types["builtin_interfaces/Duration"][1].base = "int32"

    def encode(self, message):
        return super().encode(message)[4:]

    def _align(self, size):
        pass

    def _text(self, kind, value):
        raw = value.encode()
        self._number("I", len(raw))
        self.out += raw

    def _group(self, kind, message):
        if self.types[kind]:
            super()._group(kind, message)


def fields(**values):
    out = b""
    for name, value in values.items():
        raw = value if isinstance(value, bytes) else value.encode()
        field = name.encode() + b"=" + raw
        out += struct.pack("<I", len(field)) + field
    return out


def record(op, data, **values):
    header = fields(op=struct.pack("<B", op), **values)
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def u32(value):
    return struct.pack("<I", value)


def time_of(ns):
    return struct.pack("<II", ns // 10**9, ns % 10**9)


class Ros1Topic:
    def __init__(self, name, kind, text):
        self.name, self.kind = name, short(kind)
        self.definition = definition(kind) if text is None and self.kind in BODIES else text or ""
        self.encoder = Ros1Encoder(self.kind, self.definition)


class Ros1Bag(BagWriter):
    def topic(self, name, kind, definition=None):
        self.topics[name] = Ros1Topic(name, kind, definition)

    def _connection(self, number, topic):
        data = fields(topic=topic.name, type=topic.kind, md5sum="0" * 32,
                      message_definition=topic.definition, callerid="/robot", latching="1")  # fmt: skip
        return record(CONNECTION, data, conn=u32(number), topic=topic.name)

    def write_bag(self, path, compression="none", chunk_size=768 * 1024, closed=True, messages=None):
        """Not `closed`: as a power cut leaves it, with its last chunk as long as it is being written."""
        messages = self.messages if messages is None else messages
        numbers = {}
        chunks = []  # records, index: number -> [(time, offset)]
        size = chunk_size
        for name, log, _, data, _ in messages:
            if size >= chunk_size:
                chunks.append([b"", {}])
                size = 0
            chunk = chunks[-1]
            if name not in numbers:
                numbers[name] = len(numbers)
                chunk[0] += self._connection(numbers[name], self.topics[name])
            chunk[1].setdefault(numbers[name], []).append((log, len(chunk[0])))
            chunk[0] += record(MESSAGE, data, conn=u32(numbers[name]), time=time_of(log))
            size = len(chunk[0])
        body, infos = b"", b""
        at = len(LINE) + HEADER_SIZE
        for k, (records, index) in enumerate(chunks):
            begin = at + len(body)
            packed = bz2.compress(records) if compression == "bz2" else compressed(records, compression)
            if not closed and k + 1 == len(chunks):  # its size comes when it is full
                body += record(CHUNK, b"", compression=compression, size=u32(0)) + packed
                break
            body += record(CHUNK, packed, compression=compression, size=u32(len(records)))
            for number, entries in index.items():
                data = b"".join(time_of(t) + u32(offset) for t, offset in entries)
                body += record(INDEX, data, ver=u32(1), conn=u32(number), count=u32(len(entries)))
            times = [t for entries in index.values() for t, _ in entries]
            counts = b"".join(u32(n) + u32(len(entries)) for n, entries in index.items())
            infos += record(CHUNK_INFO, counts, ver=u32(1), chunk_pos=struct.pack("<Q", begin),
                            start_time=time_of(min(times)), end_time=time_of(max(times)),
                            count=u32(len(index)))  # fmt: skip
        index_at = at + len(body) if closed else 0
        empty = record(BAG_HEADER, b"", index_pos=struct.pack("<Q", index_at),
                       conn_count=u32(len(numbers) if closed else 0),
                       chunk_count=u32(len(chunks) if closed else 0))  # fmt: skip
        padding = b" " * (HEADER_SIZE - len(empty))
        header = empty[:-4] + u32(len(padding)) + padding
        with open(path, "wb") as file:
            file.write(LINE + header + body)
            if closed:
                for name, number in numbers.items():
                    file.write(self._connection(number, self.topics[name]))
                file.write(infos)
