# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Writes MCAP files, record by record, from the specification (https://mcap.dev/spec).

    with McapFile("a.mcap", compression="zstd") as file:
        schema = file.schema("std_msgs/msg/String", "ros2msg", b"string data")
        channel = file.channel(schema, "/chatter", "cdr")
        file.message(channel, log_time, data)
"""

import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
ATTACHMENT, STATISTICS, METADATA, SUMMARY_OFFSET, DATA_END = 0x09, 0x0B, 0x0C, 0x0E, 0x0F


def text(value):
    raw = value if isinstance(value, bytes) else value.encode()
    return struct.pack("<I", len(raw)) + raw


def pairs(items):
    return text(b"".join(items))


def record(kind, content):
    return struct.pack("<BQ", kind, len(content)) + content


def compressed(data, compression):
    if compression == "lz4":
        import lz4.frame

        return lz4.frame.compress(data)
    if compression == "zstd":
        import zstandard

        return zstandard.ZstdCompressor().compress(data)
    return data


class McapFile:
    """`compression` is "", lz4 or zstd; without `chunked` messages stand in the file one by one.

    `crc` says whether checksums are stated, `data_crc` whether that of all data is, too (rosbag2
    states none), `summary` whether the file has one, `index` whether chunks are indexed. `end` False
    leaves the file as a power cut does, after the last chunk.
    """

    def __init__(self, path, compression="", chunk_size=1 << 20, chunked=True, crc=True,
                 data_crc=True, summary=True, index=True, end=True, others=False):  # fmt: skip
        self.file = open(path, "wb")
        self.at = 0
        self.crc_so_far = 0
        self.compression, self.chunk_size, self.chunked = compression, chunk_size, chunked
        self.data_crc = crc and data_crc
        self.crc, self.summary, self.index, self.end = crc, summary, index, end
        self.described = []  # schemas and channels, again in the summary
        self.schemas = 0
        self.counts = {}
        self.times = []
        self.chunks = []
        self._empty_chunk()
        self._put(MAGIC)
        self._put(record(HEADER, text("ros2") + text("trussmap tests")))
        if others:  # what readers pass over
            self._put(record(METADATA, text("about") + pairs([text("key") + text("value")])))
            attached = struct.pack("<QQ", 1, 2) + text("a.txt") + text("text/plain")
            attached += struct.pack("<Q", 3) + b"abc"
            self._put(record(ATTACHMENT, attached + struct.pack("<I", zlib.crc32(attached))))
            self._put(record(0x7E, b"from the future") + record(0x80, b""))

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.close()

    def _put(self, data):
        self.file.write(data)
        self.at += len(data)
        self.crc_so_far = zlib.crc32(data, self.crc_so_far)

    def _empty_chunk(self):
        self.chunk = []
        self.chunk_bytes = 0
        self.chunk_times = []
        self.chunk_index = {}

    def _add(self, data):
        if not self.chunked:
            self._put(data)
            return
        self.chunk.append(data)
        self.chunk_bytes += len(data)

    def schema(self, name, encoding, data):
        self.schemas += 1
        one = record(SCHEMA, struct.pack("<H", self.schemas) + text(name) + text(encoding) + text(data))
        self.described.append(one)
        self._add(one)
        return self.schemas

    def channel(self, schema, topic, encoding):
        number = len(self.counts) + 3  # ids need not begin at 0
        self.counts[number] = 0
        one = record(CHANNEL, struct.pack("<HH", number, schema) + text(topic) + text(encoding) + text(b""))
        self.described.append(one)
        self._add(one)
        return number

    def message(self, channel, log_time, data, publish_time=None):
        self.chunk_index.setdefault(channel, []).append((log_time, self.chunk_bytes))
        publish = log_time if publish_time is None else publish_time
        head = struct.pack("<HIQQ", channel, self.counts[channel], log_time, publish)
        self.counts[channel] += 1
        self.times.append(log_time)
        self.chunk_times.append(log_time)
        self._add(record(MESSAGE, head + data))
        if self.chunk_bytes >= self.chunk_size:
            self.flush()

    def flush(self):
        """Ends the chunk."""
        if not self.chunk:
            return
        data = b"".join(self.chunk)
        packed = compressed(data, self.compression)
        first, last = min(self.chunk_times, default=0), max(self.chunk_times, default=0)
        head = struct.pack("<QQQI", first, last, len(data), zlib.crc32(data) if self.crc else 0)
        begin = self.at
        self._put(record(CHUNK, head + text(self.compression) + struct.pack("<Q", len(packed)) + packed))
        length = self.at - begin
        offsets = []
        after = self.at
        for channel, entries in self.chunk_index.items() if self.index else ():
            offsets.append(struct.pack("<HQ", channel, self.at))
            times = [struct.pack("<QQ", *entry) for entry in entries]
            self._put(record(MESSAGE_INDEX, struct.pack("<H", channel) + pairs(times)))
        self.chunks.append(
            struct.pack("<QQQQ", first, last, begin, length) + pairs(offsets)
            + struct.pack("<Q", self.at - after) + text(self.compression)
            + struct.pack("<QQ", len(packed), len(data)))  # fmt: skip
        self._empty_chunk()

    def close(self):
        self.flush()
        if self.end:
            self._put(record(DATA_END, struct.pack("<I", self.crc_so_far if self.data_crc else 0)))
            self._end()
        self.file.close()

    def _end(self):
        start = self.at
        groups = []
        if self.summary:
            statistics = struct.pack(
                "<QHIIIIQQ", sum(self.counts.values()), self.schemas, len(self.counts), 0, 0,
                len(self.chunks), min(self.times, default=0), max(self.times, default=0))  # fmt: skip
            counts = [struct.pack("<HQ", *item) for item in self.counts.items()]
            by_kind = {SCHEMA: [], CHANNEL: []}
            for one in self.described:
                by_kind[one[0]].append(one)
            by_kind[STATISTICS] = [record(STATISTICS, statistics + pairs(counts))]
            if self.index:
                by_kind[CHUNK_INDEX] = [record(CHUNK_INDEX, one) for one in self.chunks]
            summed = b""
            for kind, records in by_kind.items():
                data = b"".join(records)
                if data:
                    groups.append(struct.pack("<BQQ", kind, start + len(summed), len(data)))
                summed += data
        else:
            summed = b""
        offsets_at = start + len(summed)
        summed += b"".join(record(SUMMARY_OFFSET, one) for one in groups)
        footer = struct.pack("<QQ", start if summed else 0, offsets_at if groups else 0)
        head = struct.pack("<BQ", FOOTER, 20)
        crc = zlib.crc32(summed + head + footer) if self.crc else 0
        self._put(summed + head + footer + struct.pack("<I", crc) + MAGIC)
