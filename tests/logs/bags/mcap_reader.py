#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Reads an MCAP file of ROS 2 messages, strictly, by the specification alone.

Shares nothing with the library that it tests: records and indexes by mcap.dev/spec, messages (CDR)
by the definitions that stand in the file. Every checksum, length, count and offset is checked;
whatever is wrong ends it with a message and status 1.

    mcap_reader.py FILE     prints {"profile", "chunks", "schemas", "channels", "messages"} as JSON

Numbers are printed so that they read back to the same bits.
"""

import json
import re
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX = 1, 2, 3, 4, 5, 6, 7
CHUNK_INDEX, STATISTICS, SUMMARY_OFFSET, DATA_END = 8, 11, 14, 15


class Wrong(Exception):
    """What does not follow the specification."""


def expect(condition, what):
    if not condition:
        raise Wrong(what)


class Bytes:
    """Fields of a record, one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        expect(self.at + count <= len(self.data), "a record ends too soon")
        self.at += count
        return self.data[self.at - count : self.at]

    def number(self, code):
        return struct.unpack("<" + code, self.take(struct.calcsize("<" + code)))[0]

    def counted(self):
        return self.take(self.number("I"))

    def text(self):
        return self.counted().decode("utf-8")

    def pairs(self, first, second):
        part, result = Bytes(self.counted()), []
        while part.at < len(part.data):
            result.append((first(part), second(part)))
        return result

    def end(self, what):
        expect(self.at == len(self.data), what + " has bytes beyond its fields")


def u16(of):
    return of.number("H")


def u64(of):
    return of.number("Q")


def records(data, base=0):
    """(offset, opcode, content) of each."""
    of = Bytes(data)
    while of.at < len(data):
        begin = of.at
        opcode, length = of.number("B"), of.number("Q")
        yield base + begin, opcode, of.take(length)


def decompressed(name, data, size):
    if name == "":
        return data
    if name == "zstd":
        import zstandard

        return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    if name == "lz4":
        import lz4.frame

        return lz4.frame.decompress(data)
    raise Wrong("unknown compression " + name)


# ---------------------------------------- messages

PRIMITIVES = {
    "bool": "?", "byte": "B", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H",
    "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d",
}


def parsed_definitions(name, text):
    """{type: [(field type, array, field name)]}, by full names PACKAGE/NAME."""
    parts = re.split(r"^={80}\n", text, flags=re.M)
    found = {}
    for number, part in enumerate(parts):
        lines = part.split("\n")
        own = name.replace("/msg/", "/")
        if number > 0:
            expect(lines[0].startswith("MSG: "), "a definition without MSG:")
            own = lines.pop(0)[5:]
        expect(own not in found, own + " is defined twice")
        fields = []
        for line in lines:
            line = line.split("#")[0].strip()
            if not line or re.match(r"^\S+\s+[A-Z0-9_]+\s*=", line):  # nothing, or a constant
                continue
            kind, field = line.split()[:2]
            array = re.match(r"^(.*?)\[(\d*)\]$", kind)
            count = None
            if array:
                kind, count = array.group(1), int(array.group(2) or -1)
            if kind not in PRIMITIVES and kind != "string" and "/" not in kind:
                kind = own.split("/")[0] + "/" + kind
            fields.append((kind, count, field))
        found[own] = fields
    for fields in found.values():
        for kind, _, _ in fields:
            expect(kind in PRIMITIVES or kind == "string" or kind in found, kind + " is not defined")
    return found


class Cdr:
    def __init__(self, data):
        expect(data[:4] == b"\x00\x01\x00\x00", "not little-endian CDR")
        self.of = Bytes(data[4:])

    def primitive(self, code):
        size = struct.calcsize("<" + code)
        expect(not any(self.of.take(-self.of.at % size)), "padding that is not 0")
        return self.of.number(code)

    def value(self, kind, definitions):
        if kind in PRIMITIVES:
            return self.primitive(PRIMITIVES[kind])
        if kind == "string":
            raw = self.of.take(self.primitive("I"))
            expect(raw[-1:] == b"\x00" and b"\x00" not in raw[:-1], "a string that 0 does not end")
            return raw[:-1].decode("utf-8")
        return {name: self.field(part, count, definitions) for part, count, name in definitions[kind]}

    def field(self, kind, count, definitions):
        if count is None:
            return self.value(kind, definitions)
        if count < 0:
            count = self.primitive("I")
        return [self.value(kind, definitions) for _ in range(count)]


def decoded(data, kind, definitions):
    cdr = Cdr(data)
    value = cdr.value(kind, definitions)
    cdr.of.end(kind)
    return value


# ---------------------------------------- files


class McapFile:
    """A file that was read from begin to end, and found to agree with its own index."""

    def __init__(self, data):
        self.data = data
        self.schemas, self.channels, self.messages = {}, {}, []
        self.chunks, self.chunk_places = [], {}
        self.definitions = {}
        expect(data[:8] == MAGIC and data[-8:] == MAGIC, "no magic at begin or end")
        self.read_data()
        self.read_summary()

    def take_schema(self, content):
        of = Bytes(content)
        number, name, encoding, text = u16(of), of.text(), of.text(), of.text()
        of.end("Schema")
        expect(number > 0 and encoding == "ros2msg", "a schema that is not ros2msg")
        schema = {"name": name, "text": text}
        expect(self.schemas.setdefault(number, schema) == schema, "a schema that changes")
        self.definitions[number] = parsed_definitions(name, text)

    def take_channel(self, content):
        of = Bytes(content)
        number, schema, topic, encoding = u16(of), u16(of), of.text(), of.text()
        metadata = dict(of.pairs(Bytes.text, Bytes.text))
        of.end("Channel")
        expect(schema in self.schemas, "a channel before its schema")
        expect(encoding == "cdr", "a channel that is not CDR")
        channel = {"topic": topic, "schema": schema, "metadata": metadata}
        expect(self.channels.setdefault(number, channel) == channel, "a channel that changes")

    def take_message(self, content):
        of = Bytes(content)
        channel, sequence, log_time, publish_time = u16(of), of.number("I"), u64(of), u64(of)
        expect(channel in self.channels, "a message before its channel")
        schema = self.channels[channel]["schema"]
        kind = self.schemas[schema]["name"].replace("/msg/", "/")
        value = decoded(content[of.at :], kind, self.definitions[schema])
        self.messages.append(
            {"channel": channel, "sequence": sequence, "log_time": log_time,
             "publish_time": publish_time, "value": value})
        return channel, log_time

    def take_chunk(self, offset, content):
        of = Bytes(content)
        start, end, size, crc = u64(of), u64(of), u64(of), of.number("I")
        compression = of.text()
        packed = of.take(u64(of))
        of.end("Chunk")
        data = decompressed(compression, packed, size)
        expect(len(data) == size, "a chunk of another size")
        expect(zlib.crc32(data) == crc, "a chunk whose CRC is wrong")
        index, times = {}, []
        for at, opcode, part in records(data):
            if opcode == SCHEMA:
                self.take_schema(part)
            elif opcode == CHANNEL:
                self.take_channel(part)
            else:
                expect(opcode == MESSAGE, "an opcode %d in a chunk" % opcode)
                channel, time = self.take_message(part)
                index.setdefault(channel, []).append((time, at))
                times.append(time)
        expect(times and (min(times), max(times)) == (start, end), "a chunk with other times")
        self.chunks.append(
            {"offset": offset, "length": 9 + len(content), "start": start, "end": end,
             "size": size, "packed": len(packed), "compression": compression, "index": index,
             "index_offsets": {}, "index_length": 0})

    def take_index(self, offset, content):
        of = Bytes(content)
        channel = u16(of)
        entries = of.pairs(u64, u64)
        of.end("MessageIndex")
        chunk = self.chunks[-1]
        expect(chunk["index"].get(channel) == entries, "an index that names other messages")
        expect(channel not in chunk["index_offsets"], "a channel indexed twice")
        chunk["index_offsets"][channel] = offset
        chunk["index_length"] += 9 + len(content)

    def read_data(self):
        self.profile = None
        for offset, opcode, content in records(self.data[8:-8], 8):
            if self.profile is None:
                expect(opcode == HEADER, "no header first")
                of = Bytes(content)
                self.profile, self.library = of.text(), of.text()
                of.end("Header")
            elif opcode == CHUNK:
                self.take_chunk(offset, content)
            elif opcode == MESSAGE_INDEX:
                self.take_index(offset, content)
            else:
                expect(opcode == DATA_END, "an opcode %d in the data section" % opcode)
                crc = Bytes(content).number("I")
                expect(zlib.crc32(self.data[:offset]) == crc, "a data section whose CRC is wrong")
                self.data_end = offset + 9 + len(content)
                break
        for chunk in self.chunks:
            expect(chunk["index"].keys() == chunk["index_offsets"].keys(), "messages without index")

    def read_summary(self):
        footer = len(self.data) - 8 - 29
        expect(self.data[footer : footer + 9] == b"\x02" + struct.pack("<Q", 20), "no footer last")
        of = Bytes(self.data[footer + 9 : -8])
        summary, offsets, crc = u64(of), u64(of), of.number("I")
        expect(summary == self.data_end, "a summary elsewhere")
        expect(zlib.crc32(self.data[summary : len(self.data) - 12]) == crc,
               "a summary whose CRC is wrong")
        groups, in_summary = {}, {}
        for offset, opcode, content in records(self.data[summary:offsets], summary):
            begin, length = groups.get(opcode, (offset, 0))
            expect(begin + length == offset, "a group of records that is not together")
            groups[opcode] = (begin, length + 9 + len(content))
            in_summary.setdefault(opcode, []).append(content)
        named = {}
        for _, opcode, content in records(self.data[offsets:footer], offsets):
            expect(opcode == SUMMARY_OFFSET, "an opcode %d among the offsets" % opcode)
            of = Bytes(content)
            group = of.number("B")
            named[group] = (u64(of), u64(of))
            of.end("SummaryOffset")
        expect(named == groups, "offsets that name other groups")
        schemas, channels = set(self.schemas), set(self.channels)
        for content in in_summary.get(SCHEMA, []):
            self.take_schema(content)
        for content in in_summary.get(CHANNEL, []):
            self.take_channel(content)
        expect((schemas, channels) == (set(self.schemas), set(self.channels)),
               "channels in the summary alone")
        expect(len(in_summary.get(SCHEMA, [])) == len(schemas), "schemas that the summary lacks")
        expect(len(in_summary.get(CHANNEL, [])) == len(channels), "channels that the summary lacks")
        self.check_statistics(in_summary[STATISTICS])
        self.check_chunk_indexes(in_summary.get(CHUNK_INDEX, []))

    def check_statistics(self, contents):
        expect(len(contents) == 1, "not one Statistics")
        of = Bytes(contents[0])
        found = struct.unpack("<QHIIIIQQ", of.take(42))
        counts = dict(of.pairs(u16, u64))
        of.end("Statistics")
        times = [one["log_time"] for one in self.messages] or [0]
        expect(found == (len(self.messages), len(self.schemas), len(self.channels), 0, 0,
                         len(self.chunks), min(times), max(times)), "statistics of something else")
        mine = {number: 0 for number in self.channels}
        for one in self.messages:
            mine[one["channel"]] += 1
        expect(counts == mine, "message counts of something else")

    def check_chunk_indexes(self, contents):
        expect(len(contents) == len(self.chunks), "not one ChunkIndex a chunk")
        for content, chunk in zip(contents, self.chunks):
            of = Bytes(content)
            place = (u64(of), u64(of), u64(of), u64(of))
            indexes = dict(of.pairs(u16, u64))
            rest = (u64(of), of.text(), u64(of), u64(of))
            of.end("ChunkIndex")
            expect(place == (chunk["start"], chunk["end"], chunk["offset"], chunk["length"]),
                   "a ChunkIndex that points elsewhere")
            expect(indexes == chunk["index_offsets"], "a ChunkIndex with other indexes")
            expect(rest == (chunk["index_length"], chunk["compression"], chunk["packed"],
                            chunk["size"]), "a ChunkIndex with other sizes")


def as_json(file):
    return {
        "profile": file.profile,
        "chunks": len(file.chunks),
        "compression": sorted({one["compression"] for one in file.chunks}),
        "schemas": {one["name"]: one["text"] for one in file.schemas.values()},
        "channels": {one["topic"]: file.schemas[one["schema"]]["name"]
                     for one in file.channels.values()},
        "messages": [
            {"topic": file.channels[one["channel"]]["topic"], "sequence": one["sequence"],
             "log_time": one["log_time"], "publish_time": one["publish_time"],
             "value": one["value"]}
            for one in file.messages],
    }


if __name__ == "__main__":
    try:
        with open(sys.argv[1], "rb") as opened:
            print(json.dumps(as_json(McapFile(opened.read()))))
    except (Wrong, UnicodeDecodeError, struct.error) as wrong:
        print("wrong: %s" % wrong)
        sys.exit(1)
