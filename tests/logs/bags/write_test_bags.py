# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Writes one of the bags that the tests of the readers read: write_test_bags.py FOLDER VARIANT

Into FOLDER go the bag and expected.txt, with all that a reader must find in it; the bag's path is
printed. VARIANT "" lists them.
"""

import math
import os
import random
import re
import sys

from bag_writer import BagWriter
import messages as ros
from ros1_writer import Ros1Bag

EVERYTHING = (
    """# every kind of field
uint8 ANSWER=42
string WORDS = "a # b = c"
bool flag true
byte raw
char letter
int8 i8 -5
uint8 u8
int16 i16
uint16 u16
int32 i32
uint32 u32
int64 i64
uint64 u64
float32 f32 1.5
float64 f64
string words "a # b"
string<=9 short_words
bool[3] flags
int16[] steps
float64[<=4] few
string<=5[<=3] names
Part[2] parts
Part[] more
my_msgs/Nothing nothing
uint8 last
"""
    + "=" * 80
    + "\nMSG: my_msgs/Part\nint8 a\nfloat64 b\nstd_msgs/Header header\nmy_msgs/msg/Nothing[] none\n"
    + "=" * 80
    + "\nMSG: my_msgs/Nothing\n"
    + "=" * 80
    + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\r\n"
)
WIDE = "wstring a\nuint8 mark\nwstring<=6 b\nstring after\n"
START = 1_700_000_000_123_456_789  # ns
NUMBERS = [0.0, -0.0, 1.5, 5e-324, 1.7976931348623157e308, float("inf"), float("-inf"), float("nan")]


def everything(draw):
    part = lambda: {  # noqa: E731
        "a": draw.randrange(-128, 128), "b": draw.gauss(0, 1),
        "header": ros.header(draw.randrange(2**60), "x" * draw.randrange(9)),
        "none": [{}] * draw.randrange(4)}  # fmt: skip
    return {
        "flag": draw.random() < 0.5, "raw": draw.randrange(256), "letter": draw.randrange(256),
        "i8": draw.randrange(-128, 128), "u8": draw.randrange(256),
        "i16": draw.randrange(-(2**15), 2**15), "u16": draw.randrange(2**16),
        "i32": draw.randrange(-(2**31), 2**31), "u32": draw.randrange(2**32),
        "i64": draw.choice([-(2**63), 2**63 - 1, draw.randrange(2**62)]),
        "u64": draw.choice([2**64 - 1, draw.randrange(2**63)]),
        "f32": draw.choice([draw.gauss(0, 1), float("inf"), 1e-45, -0.0]),
        "f64": draw.choice(NUMBERS), "words": "ä€𝄞"[: draw.randrange(4)],
        "short_words": "123456789"[: draw.randrange(10)],
        "flags": [draw.random() < 0.5 for _ in range(3)],
        "steps": [draw.randrange(-9, 9) for _ in range(draw.randrange(5))],
        "few": [draw.gauss(0, 1) for _ in range(draw.randrange(5))],
        "names": ["abcde"[: draw.randrange(6)] for _ in range(draw.randrange(4))],
        "parts": [part(), part()], "more": [part() for _ in range(draw.randrange(3))],
        "last": 255}  # fmt: skip


EVERYTHING_OF_ROS1 = (
    """# every kind of field
byte ANSWER=42
string WORDS= "a # b = c"
bool flag
byte raw
char letter
int8 i8
uint8 u8
int16 i16
uint16 u16
int32 i32
uint32 u32
int64 i64
uint64 u64
float32 f32
float64 f64
string words
bool[3] flags
int16[] steps
string[] names
time at
duration[] lasting
Part[2] parts
Part[] more
my_msgs/Nothing nothing
uint8 last
"""
    + "=" * 80
    + "\nMSG: my_msgs/Part\nint8 a\nfloat64 b\nHeader header\nNothing[] none\n"
    + "=" * 80
    + "\nMSG: my_msgs/Nothing\n"
    + "=" * 80
    + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
)


def everything_of_ros1(draw):
    message = everything(draw)
    for name in ("short_words", "few"):
        del message[name]
    message["raw"] -= 128
    message["at"] = {"sec": draw.randrange(2**32), "nanosec": draw.randrange(10**9)}
    message["lasting"] = [{"sec": -1, "nanosec": -5}] * draw.randrange(3)
    for part in message["parts"] + message["more"]:
        part["header"]["seq"] = draw.randrange(2**32)
        part["header"]["stamp"]["sec"] %= 2**32
    return message


def test_bag(standard=False, count=60, wide_characters=2, bag=None, **topic_options):
    """Topics at different rates; every 13th message comes late."""
    draw = random.Random(20261125)
    bag = bag or BagWriter()
    kinds = {
        "/odom": "nav_msgs/msg/Odometry", "/joint_states": "sensor_msgs/msg/JointState",
        "/imu": "sensor_msgs/msg/Imu", "/tf": "tf2_msgs/msg/TFMessage",
        "/pose": "geometry_msgs/msg/PoseStamped", "/gps": "sensor_msgs/msg/NavSatFix",
        "/chatter": "std_msgs/msg/String", "/sonar": "sensor_msgs/msg/Range",
        "/empty": "std_msgs/msg/Empty", "/tags": "apriltag_msgs/msg/AprilTagDetectionArray",
        "/aruco": "ros2_aruco_interfaces/msg/ArucoMarkers",
        "/image": "sensor_msgs/msg/Image"}  # fmt: skip
    for name, kind in kinds.items():
        bag.topic(name, kind, **topic_options)
    if not standard:
        bag.topic("/everything", "my_msgs/msg/Everything", EVERYTHING, **topic_options,
                  wide_characters=wide_characters)  # fmt: skip
        bag.topic("/wide", "my_msgs/msg/Wide", WIDE, **topic_options,
                  wide_characters=wide_characters)  # fmt: skip
    rows = []
    for k in range(count):
        time = START + k * 20_000_000 + draw.randrange(1000)
        full = [draw.gauss(0, 1) for _ in range(36)]
        odometry = ros.odometry(time, draw.gauss(0, 9), draw.gauss(0, 9), draw.gauss(0, 1))
        odometry["pose"]["covariance"] = full
        rows.append(("/odom", time, odometry))
        if k % 2 == 0:
            rows.append(("/imu", time + 1, ros.imu(time, draw.gauss(0, 1))))
            rows.append(("/tf", time + 2, ros.tf(*[
                ros.transform(time, "odom", f"link_{n}", draw.random(), n, draw.random())
                for n in range(k % 3)])))  # fmt: skip
        if k % 5 == 0:
            names = ["left", "right"]
            turns = [draw.gauss(0, 9), draw.gauss(0, 9)]
            rows.append(("/joint_states", time + 3, ros.joint_state(time, names, turns, turns)))
            rows.append(("/pose", time + 4, ros.pose_stamped(time, 1.0, draw.random(), 0.1)))
            corners = [{"x": draw.random(), "y": n} for n in range(4)]
            tag = {"family": "36h11", "id": k, "goodness": 0.1, "corners": corners}
            rows.append(("/tags", time, {"header": ros.header(time), "detections": [tag] * (k % 3)}))
            rows.append(("/aruco", time, {"header": ros.header(time), "marker_ids": [k, -k],
                                          "poses": [ros.pose(1, 2, 3), {}]}))  # fmt: skip
        if k % 10 == 0:
            rows.append(("/gps", time + 5, ros.nav_sat_fix(time, 49 + draw.random(), 8.4)))
            rows.append(("/chatter", time + 6, ros.string("Grüße " * (k % 7))))
            rows.append(("/sonar", time + 7, ros.range_(time, draw.random())))
            rows.append(("/empty", time + 8, {}))
            rows.append(("/image", time + 9, {"height": 2, "width": 5, "data": bytes(range(10))}))
        if not standard:
            rows.append(("/everything", time + 10, everything(draw)))
            wide = {"a": "", "mark": 7, "b": "aß€𝄞"[: 1 + k % 4], "after": "after"}
            rows.append(("/wide", time + 11, wide))
    for k in range(0, len(rows) - 9, 13):
        rows.insert(k + 8, rows.pop(k))
    for topic, time, message in rows:
        bag.write(topic, time, message, time - draw.randrange(10**6))
    return bag


def mcap(folder, *, definitions=True, standard=False, topics=None, **options):
    bag = test_bag(standard, **(topics or {}))
    path = os.path.join(folder, "bag.mcap")
    bag.write_mcap(path, definitions, **options)
    return path, bag.flat()


def write_little(bag, odometry, string):
    """Two topics of these types, eight messages each."""
    bag.topic("/odom", odometry)
    bag.topic("/chatter", string)
    for k in range(8):
        bag.write("/odom", START + k, ros.odometry(START, 0.1 * k, 0.2 * k, 0.3 * k))
        bag.write("/chatter", START + k, ros.string("word " * k))


def small(folder, **options):
    """Small enough to be cut off and changed everywhere."""
    bag = BagWriter()
    write_little(bag, "nav_msgs/msg/Odometry", "std_msgs/msg/String")
    path = os.path.join(folder, "bag.mcap")
    bag.write_mcap(path, chunk_size=1600, **options)
    return path, bag.flat()


def db3(folder, schema, standard=False):
    bag = test_bag(standard)
    path = os.path.join(folder, "bag.db3")
    bag.write_db3(path, schema)
    return path, bag.flat(log_times_alone=True)


def rosbag2(folder, storage="sqlite3", **options):
    bag = test_bag()
    path = os.path.join(folder, "drive")
    bag.write_rosbag2(path, storage, **options)
    return path, bag.flat(log_times_alone=storage == "sqlite3")


def ros1(folder, name="bag.bag", **options):
    """What test_bag has, with a type of ROS 1 in place of those with what ROS 2 alone has."""
    bag = test_bag(True, bag=Ros1Bag())
    draw = random.Random(20261129)
    bag.topic("/everything", "my_msgs/Everything", EVERYTHING_OF_ROS1)
    for k in range(60):
        bag.write("/everything", START + k, everything_of_ros1(draw))
    path = os.path.join(folder, name)
    bag.write_bag(path, **options)
    return path, bag.flat(log_times_alone=True)


def ros1_split(folder, files=12):
    bag = test_bag(True, bag=Ros1Bag())
    path = os.path.join(folder, "drive")
    os.makedirs(path)
    share = -(-len(bag.messages) // files)
    for k in range(files):
        part = bag.messages[k * share : (k + 1) * share]
        bag.write_bag(os.path.join(path, f"drive_{k}.bag"), messages=part)
    return path, bag.flat(log_times_alone=True)


def drive(folder, of_ros1):
    """A minute of curves with wheels, odometry, gyro and tags, the same by ROS 1 and ROS 2."""
    bag = Ros1Bag() if of_ros1 else BagWriter()
    for name, kind in {"/odom": "nav_msgs/msg/Odometry", "/cmd": "geometry_msgs/msg/TwistStamped",
                       "/joint_states": "sensor_msgs/msg/JointState", "/imu": "sensor_msgs/msg/Imu",
                       "/tf": "tf2_msgs/msg/TFMessage", "/gps": "sensor_msgs/msg/NavSatFix"}.items():  # fmt: skip
        bag.topic(name, kind)
    x = y = heading = left = right = 0.0
    for k in range(1200):
        time = START + k * 50_000_000
        turn = math.sin(k / 40)
        bag.write("/odom", time, ros.odometry(time, x, y, heading, 0.5, turn))
        bag.write("/cmd", time + 1, {"header": ros.header(time, "base_link"),
                                     "twist": {"linear": {"x": 0.5}, "angular": {"z": turn}}})  # fmt: skip
        turns = [left / 0.05, right / 0.05]
        bag.write("/joint_states", time, ros.joint_state(time, ["left_wheel", "right_wheel"], turns))
        bag.write("/imu", time + 7, ros.imu(time, turn, heading=heading))
        if k % 100 == 0:
            tag = ros.transform(time, "base_link", f"tag36h11:{k // 300}", 0.5 + k / 2400, 0.2, 0.1)
            bag.write("/tf", time, ros.tf(tag))
            bag.write("/gps", time, ros.nav_sat_fix(time, 49 + y / 111000, 8.4))
        heading += 0.05 * turn
        x, y = x + 0.025 * math.cos(heading), y + 0.025 * math.sin(heading)
        left, right = left + 0.025 - 0.01 * turn, right + 0.025 + 0.01 * turn
    path = os.path.join(folder, "drive" + (".bag" if of_ros1 else ".mcap"))
    if of_ros1:
        bag.write_bag(path, compression="bz2")
    else:
        bag.write_mcap(path)
    return path, bag.flat(log_times_alone=of_ros1)


def ros1_small(folder, **options):
    """Small enough to be cut off and changed everywhere."""
    bag = Ros1Bag()
    write_little(bag, "nav_msgs/Odometry", "std_msgs/String")
    path = os.path.join(folder, "bag.bag")
    bag.write_bag(path, chunk_size=1600, **options)
    return path, bag.flat(log_times_alone=True)


def definitions_apart(folder, write):
    """The bag has no definitions; those of its own types are files of a workspace beside it."""
    parts = re.split(r"^=+\nMSG: *(\S+) *\n", EVERYTHING, flags=re.MULTILINE)
    files = {"my_msgs/Everything": parts[0], "my_msgs/Wide": WIDE, **dict(zip(parts[1::2], parts[2::2]))}
    for name, text in files.items():
        package, kind = name.split("/")
        if package != "my_msgs":
            continue
        within = os.path.join(folder, "src", package, "msg" if kind != "Wide" else "")
        os.makedirs(within, exist_ok=True)
        with open(os.path.join(within, kind + ".msg"), "w", encoding="utf-8") as file:
            file.write(text)
    return write()


VARIANTS = {
    "mcap_plain": lambda f: mcap(f, chunk_size=5000),
    "mcap_lz4": lambda f: mcap(f, compression="lz4", chunk_size=5000),
    "mcap_zstd": lambda f: mcap(f, compression="zstd", chunk_size=5000),
    "mcap_one_chunk": lambda f: mcap(f, compression="zstd", chunk_size=1 << 30),
    "mcap_unchunked": lambda f: mcap(f, chunked=False),
    "mcap_without_summary": lambda f: mcap(f, chunk_size=5000, summary=False, index=False),
    "mcap_without_checksums": lambda f: mcap(f, compression="lz4", chunk_size=900, crc=False),
    "mcap_without_definitions": lambda f: mcap(f, definitions=False, standard=True),
    "mcap_definitions_apart": lambda f: definitions_apart(f, lambda: mcap(f, definitions=False)),
    "db3_definitions_apart": lambda f: definitions_apart(f, lambda: db3(f, 3)),
    "mcap_idl": lambda f: mcap(f, standard=True, topics={"schema_encoding": "ros2idl"}),
    "mcap_as_rosbag2": lambda f: mcap(f, compression="zstd", data_crc=False),
    "mcap_big_endian": lambda f: mcap(f, compression="lz4", topics={"big_endian": True}),
    "mcap_wide_characters": lambda f: mcap(f, topics={"wide_characters": 4}),
    "mcap_with_others": lambda f: mcap(f, others=True),
    "small_plain": small,
    "small_lz4": lambda f: small(f, compression="lz4"),
    "small_zstd": lambda f: small(f, compression="zstd"),
    "small_as_rosbag2": lambda f: small(f, compression="lz4", data_crc=False),
    "small_unchunked": lambda f: small(f, chunked=False),
    "ros1_plain": lambda f: ros1(f, chunk_size=5000),
    "ros1_bz2": lambda f: ros1(f, compression="bz2", chunk_size=5000),
    "ros1_lz4": lambda f: ros1(f, compression="lz4", chunk_size=5000),
    "ros1_one_chunk": lambda f: ros1(f, compression="bz2", chunk_size=1 << 30),
    "ros1_of_any_name": lambda f: ros1(f, name="drive.bag.active"),
    "ros1_not_closed": lambda f: ros1(f, chunk_size=5000, closed=False),
    "ros1_bz2_not_closed": lambda f: ros1(f, compression="bz2", chunk_size=5000, closed=False),
    "ros1_split": ros1_split,
    "drive_of_ros1": lambda f: drive(f, True),
    "drive_of_ros2": lambda f: drive(f, False),
    "ros1_small": ros1_small,
    "ros1_small_bz2": lambda f: ros1_small(f, compression="bz2"),
    "ros1_small_lz4": lambda f: ros1_small(f, compression="lz4"),
    "db3_of_galactic": lambda f: db3(f, 2, standard=True),
    "db3_of_humble": lambda f: db3(f, 3, standard=True),
    "db3_of_iron": lambda f: db3(f, 4),
    "folder_sqlite3": rosbag2,
    "folder_mcap": lambda f: rosbag2(f, "mcap", compression="zstd"),
    "folder_three_files": lambda f: rosbag2(f, files=3),
    "folder_twelve_mcap_files": lambda f: rosbag2(f, "mcap", files=12),
    "folder_without_metadata": lambda f: rosbag2(f, files=12, metadata=False),
    "folder_mcap_without_metadata": lambda f: rosbag2(f, "mcap", files=12, metadata=False),
    "folder_file_compression": lambda f: rosbag2(f, files=2, mode="FILE"),
    "folder_message_compression": lambda f: rosbag2(f, mode="MESSAGE"),
    "folder_mcap_file_compression": lambda f: rosbag2(f, "mcap", mode="FILE"),
    "folder_mcap_message_compression": lambda f: rosbag2(f, "mcap", mode="MESSAGE"),
    "folder_compressed_without_metadata": lambda f: rosbag2(f, files=2, mode="FILE", metadata=False),
}  # fmt: skip


def main():
    if sys.argv[1:] == [""]:
        print("\n".join(VARIANTS))
        return
    folder, variant = sys.argv[1:]
    path, lines = VARIANTS[variant](folder)
    with open(os.path.join(folder, "expected.txt"), "w", encoding="utf-8") as file:
        file.writelines(line + "\n" for line in lines)
    print(path)


main()
