# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Bags as ROS 2 records them, without ROS: MCAP files and rosbag2 folders, out of Python dicts.

    from bag_writer import BagWriter
    from messages import odometry

    bag = BagWriter()
    bag.topic("/odom", "nav_msgs/msg/Odometry")                  # a type that messages.py has
    bag.topic("/wheel", "my_msgs/msg/Wheel", "int64 ticks\\n")   # any other
    for k in range(100):
        time = 1_700_000_000_000_000_000 + k * 20_000_000        # ns
        bag.write("/odom", time, odometry(time, x=0.01 * k, y=0.0, heading=0.0, speed=0.5))
        bag.write("/wheel", time, {"ticks": 40 * k})
    bag.write_mcap("drive.mcap", compression="zstd", chunk_size=64 * 1024)
    bag.write_rosbag2("drive", storage="sqlite3")

Messages stand in files in the order of their writing. Written from the specifications and from what
`ros2 bag record` leaves, for tests of the readers in src/logs, of which it shares nothing. Needs
the packages python3-lz4 and python3-zstandard where something is compressed.
"""

import os
import sqlite3

from mcap_file import McapFile, compressed
from messages import BODIES, definition as standard_definition
from ros2_cdr import Encoder, short

SCHEMAS = {
    # version 2 and before: Foxy to Galactic; 3: Humble; 4: Iron and later
    2: ["CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)"],
    3: ["CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)",
        "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, "
        "metadata TEXT NOT NULL)",
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)"],
    4: ["CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)",
        "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, "
        "metadata TEXT NOT NULL)",
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, "
        "type_description_hash TEXT NOT NULL)",
        "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, "
        "encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, "
        "type_description_hash TEXT NOT NULL)"],
}  # fmt: skip
MESSAGES = [
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
    "timestamp INTEGER NOT NULL, data BLOB NOT NULL)",
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC)",
]


class Topic:
    def __init__(self, name, kind, definition, encoding, schema_encoding, big_endian, wide):
        if definition is None:
            definition = standard_definition(kind) if short(kind) in BODIES else ""
        self.name, self.kind, self.definition = name, kind, definition
        self.encoding, self.schema_encoding = encoding, schema_encoding
        cdr = encoding == "cdr" and (definition or short(kind) in BODIES)
        self.encoder = Encoder(kind, definition, big_endian, wide) if cdr else None


class BagWriter:
    def __init__(self):
        self.topics = {}
        self.messages = []  # topic, log time, publish time, encoded, as written

    def topic(self, name, kind, definition=None, encoding="cdr", schema_encoding="ros2msg",
              big_endian=False, wide_characters=2):  # fmt: skip
        """`definition` is ros2msg text with that of all types within; of types of messages.py None."""
        self.topics[name] = Topic(name, kind, definition, encoding, schema_encoding, big_endian,
                                  wide_characters)  # fmt: skip

    def write(self, topic, log_time_ns, message, publish_time_ns=None):
        """`message` is a dict, or bytes as they are."""
        raw = isinstance(message, bytes)
        data = message if raw else self.topics[topic].encoder.encode(message)
        publish = log_time_ns if publish_time_ns is None else publish_time_ns
        self.messages.append((topic, log_time_ns, publish, data, None if raw else message))

    def flat(self, log_times_alone=False):
        """What a reader must find, as lines: TOPIC LOG_TIME PUBLISH_TIME, then " FIELD KIND VALUE"."""
        lines = []
        for topic, log, publish, _, message in self.messages:
            if message is None:
                continue
            lines.append(f"{topic} {log} {log if log_times_alone else publish}")
            lines += [" " + line for line in self.topics[topic].encoder.flat(message)]
        return lines

    def write_mcap(self, path, definitions=True, compression="", messages=None, pack=None, **options):
        """`options` are those of McapFile: chunk_size, chunked, crc, summary, index, end, others."""
        with McapFile(path, compression=compression, **options) as file:
            channels = {}
            schemas = {}
            for name, log, publish, data, _ in self.messages if messages is None else messages:
                if name not in channels:
                    one = self.topics[name]
                    key = (one.kind, one.definition)
                    if key not in schemas:
                        text = one.definition if definitions else ""
                        encoding = one.schema_encoding if definitions else ""
                        schemas[key] = file.schema(one.kind, encoding, text)
                    channels[name] = file.channel(schemas[key], name, one.encoding)
                file.message(channels[name], log, compressed(data, pack), publish)

    def write_db3(self, path, schema=4, messages=None, pack=None):
        """`pack` is "zstd" where each message is compressed."""
        base = sqlite3.connect(path)
        for statement in SCHEMAS[schema] + MESSAGES:
            base.execute(statement)
        if schema >= 3:
            base.execute("INSERT INTO schema VALUES (?, 'trussmap')", (schema,))
        ids = {}
        kinds = set()
        for one in self.topics.values():
            ids[one.name] = len(ids) + 1
            row = [ids[one.name], one.name, one.kind, one.encoding, ""]
            row += ["RIHS01_00"] if schema >= 4 else []
            base.execute(f"INSERT INTO topics VALUES ({', '.join('?' * len(row))})", row)
            if schema >= 4 and one.kind not in kinds:
                base.execute(
                    "INSERT INTO message_definitions (topic_type, encoding, "
                    "encoded_message_definition, type_description_hash) VALUES (?, ?, ?, '')",
                    (one.kind, one.schema_encoding, one.definition))  # fmt: skip
                kinds.add(one.kind)
        for name, log, _, data, _ in self.messages if messages is None else messages:
            base.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)",
                         (ids[name], log, compressed(data, pack)))  # fmt: skip
        base.commit()
        base.close()

    def write_rosbag2(self, folder, storage="sqlite3", schema=4, files=1, metadata=True, mode="",
                      **options):  # fmt: skip
        """`mode` is FILE or MESSAGE where zstd compresses; `options` of write_mcap."""
        os.makedirs(folder)
        name = os.path.basename(folder)
        share = -(-len(self.messages) // files)
        paths = []
        for k in range(files):
            part = self.messages[k * share : (k + 1) * share]
            ending = ".db3" if storage == "sqlite3" else ".mcap"
            path = os.path.join(folder, f"{name}_{k}{ending}")
            pack = "zstd" if mode == "MESSAGE" else None
            if storage == "sqlite3":
                self.write_db3(path, schema, part, pack)
            else:
                self.write_mcap(path, messages=part, pack=pack, **options)
            if mode == "FILE":
                with open(path, "rb") as plain, open(path + ".zstd", "wb") as packed:
                    packed.write(compressed(plain.read(), "zstd"))
                os.remove(path)
                path += ".zstd"
            paths.append(os.path.basename(path))
        if metadata:
            with open(os.path.join(folder, "metadata.yaml"), "w", encoding="utf-8") as file:
                file.write(self.metadata(paths, storage, mode))

    def metadata(self, paths, storage, mode):
        times = [one[1] for one in self.messages] or [0]
        lines = ["rosbag2_bagfile_information:", "  version: 5", f"  storage_identifier: {storage}",
                 "  duration:", f"    nanoseconds: {max(times) - min(times)}", "  starting_time:",
                 f"    nanoseconds_since_epoch: {min(times)}",
                 f"  message_count: {len(self.messages)}", "  topics_with_message_count:"]  # fmt: skip
        for one in self.topics.values():
            count = sum(message[0] == one.name for message in self.messages)
            lines += ["    - topic_metadata:", f"        name: {one.name}",
                      f"        type: {one.kind}", f"        serialization_format: {one.encoding}",
                      "        offered_qos_profiles: \"\"", f"      message_count: {count}"]  # fmt: skip
        lines += [f"  compression_format: {'zstd' if mode else chr(34) * 2}",
                  f"  compression_mode: {mode or chr(34) * 2}", "  relative_file_paths:"]  # fmt: skip
        lines += [f"    - {path}" for path in paths]
        lines += ["  files:"]
        for path in paths:
            lines += [f"    - path: {path}", "      starting_time:",
                      f"        nanoseconds_since_epoch: {min(times)}", "      duration:",
                      "        nanoseconds: 0", "      message_count: 0"]  # fmt: skip
        return "\n".join(lines) + "\n"
