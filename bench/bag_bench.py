# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Reading a large bag: processor time and memory, beside decompressing the same chunks alone.

    bag_bench.py FOLDER [--mebibytes 1024] READER [ARGUMENT...]

Writes FOLDER/lz4.mcap and FOLDER/zstd.mcap (images and clouds of points, odometry at 50 Hz, tf at
100 Hz; with the checksums that rosbag2 states, of chunks alone), each with its chunks alone beside it, and runs READER with {} replaced by the bag:

    bag_bench.py /var/tmp/bags trussmap convert {} --odom /odom ...

The rival is `lz4 -d` or `zstd -d` of the chunks alone (Debian: lz4, zstd, python3-lz4,
python3-zstandard). Each runs three times in turn; the least processor time counts.
"""

import argparse
import os
import random
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "../tests/logs/bags"))
import mcap_file  # noqa: E402
import messages as ros  # noqa: E402
from ros2_cdr import Encoder  # noqa: E402

START = 1_700_000_000_000_000_000  # ns
TARGET_TIMES, TARGET_MEMORY = 3.0, 200.0  # of the rival's time; MB


class WithPayloads(mcap_file.McapFile):
    """Keeps the compressed chunks in a file of their own, too."""

    def __init__(self, path, payloads, **options):
        self.payloads = open(payloads, "wb")
        super().__init__(path, **options)

    def _put(self, data):
        if data[:1] == bytes([mcap_file.CHUNK]):
            self.payloads.write(data[9 + 28 + 4 + len(self.compression) + 8 :])
        super()._put(data)

    def close(self):
        super().close()
        self.payloads.close()


def image(draw):
    """640 x 480 pixels, a third of them noise."""
    rows = []
    for row in range(480):
        rows.append(bytes([row // 4]) * 430 + draw.randbytes(210))
    return {"height": 480, "width": 640, "encoding": "mono8", "step": 640, "data": b"".join(rows)}


def cloud(draw):
    """30000 points of 16 bytes, of which the low ones are noise."""
    noise = draw.randbytes(30000 * 4)
    points = bytearray(30000 * 16)
    for k in range(4):
        points[k * 4 :: 16] = noise[k::4]
    points[3::4] = b"\x40" * 120000
    fields = [{"name": name, "offset": 4 * k, "datatype": 7, "count": 1} for k, name in
              enumerate(("x", "y", "z", "i"))]  # fmt: skip
    return {"height": 1, "width": 30000, "fields": fields, "point_step": 16,
            "row_step": 480000, "data": bytes(points)}  # fmt: skip


def write(path, payloads, compression, mebibytes):
    draw = random.Random(1)
    kinds = {"/odom": "nav_msgs/msg/Odometry", "/tf": "tf2_msgs/msg/TFMessage",
             "/camera": "sensor_msgs/msg/Image", "/points": "sensor_msgs/msg/PointCloud2"}  # fmt: skip
    with WithPayloads(path, payloads, compression=compression, chunk_size=4 << 20,
                      data_crc=False) as file:  # fmt: skip
        channels, encoders = {}, {}
        for topic, kind in kinds.items():
            text = ros.definition(kind)
            channels[topic] = file.channel(file.schema(kind, "ros2msg", text), topic, "cdr")
            encoders[topic] = Encoder(kind, text)
        k = 0
        while file.at < mebibytes << 20:
            time = START + k * 10_000_000
            out = {"/tf": ros.tf(ros.transform(time, "odom", "base_link", k * 0.01, 0.0, 0.1))}
            if k % 2 == 0:
                out["/odom"] = ros.odometry(time, k * 0.01, 0.0, 0.1, 1.0)
            if k % 4 == 0:
                out["/camera"] = image(draw)
            if k % 10 == 0:
                out["/points"] = cloud(draw)
            for topic, message in out.items():
                file.message(channels[topic], time, encoders[topic].encode(message))
            k += 1


def run(command):
    """Processor time in s, peak memory in MB."""
    with open(os.devnull, "wb") as nowhere:
        process = subprocess.Popen(command, stdout=nowhere)
        _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(command)} failed")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--mebibytes", type=int, default=1024)
    parser.add_argument("reader", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    for compression in ("lz4", "zstd"):
        bag = os.path.join(options.folder, compression + ".mcap")
        chunks = os.path.join(options.folder, "chunks." + compression)
        if not os.path.exists(bag):
            write(bag, chunks, compression, options.mebibytes)
        rounds = [(run([compression, "-d", "-q", "-c", chunks]),
                   run([part.replace("{}", bag) for part in options.reader])) for _ in range(3)]  # fmt: skip
        rival = min(one[0][0] for one in rounds)
        time = min(one[1][0] for one in rounds)
        memory = max(one[1][1] for one in rounds)
        holds = time <= TARGET_TIMES * rival and memory <= TARGET_MEMORY
        print(f"{compression}: {os.path.getsize(bag) / 2**20:.0f} MiB, read in {time:.2f} s, "
              f"{time / rival:.2f} times the {rival:.2f} s of {compression} -d (at most "
              f"{TARGET_TIMES:g}), {memory:.0f} MB (at most {TARGET_MEMORY:g}): "
              f"{'holds' if holds else 'MISSED'}")  # fmt: skip


main()
