# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""One recording as the logs that robots write: MCAP, rosbag2, WPILib, Road Runner and a team's table.

    recording_as_logs.py RECORDING FOLDER [--style joints|odometry] [--only NAME...]

Writes drive.mcap, bag/ (rosbag2, sqlite3), drive.wpilog, drive.log and drive.csv into FOLDER, with the
same wheels in all: whole ticks of an encoder, in a bag as the angles that they are. Positions where the
robot stood go out as names, ranges and bearings as tags in a camera's frame, the compass in degrees
where a team would write degrees. And truth.csv's poses, fixes, the gyro, covariates.

Shares nothing with the readers in src/logs.
"""

import argparse
import csv
import math
import os

from bag_writer import BagWriter
from messages import header, imu, joint_state, odometry, pose_stamped, stamp, string
from roadrunner_writer import DOUBLE, LONG, STRING, RoadRunnerLog, struct_of
from wpilog_writer import WpiLog

RADIUS = 0.05  # m, of a wheel
TICKS = 65536  # a turn of the wheel
TAGS = "tag36h11:"  # what their frames are called
EPOCH = 1_750_000_000_000_000_000  # ns
POINT_STAMPED = ("std_msgs/Header header\ngeometry_msgs/Point point\n" + 80 * "=" +
                 "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + 80 * "=" +
                 "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + 80 * "=" +
                 "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
CAMERA = (0.21, 0.03, 0.4)  # m, where it is on the robot; it looks ahead


def read(path):
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Recording:
    """Rows of a drive with the sums of its wheels in ticks, the first at its start."""

    def __init__(self, folder, wheelbase):
        self.rows = read(os.path.join(folder, "drive.csv"))
        self.sightings = read(os.path.join(folder, "sightings.csv"))
        self.truth = read(os.path.join(folder, "truth.csv"))
        self.fixes = read(os.path.join(folder, "fixes.csv"))
        known = ("t", "left", "right", "heading", "yaw_rate")
        self.covariates = [name for name in self.rows[0] if name not in known]
        self.wheelbase = wheelbase
        t = [float(row["t"]) for row in self.rows]
        self.t = [self.ns(t[0] - (t[1] - t[0]))] + [self.ns(one) for one in t]
        self.ticks = [[0], [0]]
        for side, name in enumerate(("left", "right")):
            total = 0.0
            for row in self.rows:
                total += float(row[name])
                self.ticks[side].append(round(total / (2 * math.pi * RADIUS) * TICKS))

    @staticmethod
    def ns(t):
        return round(float(t) * 1e6) * 1000

    def angle(self, side, k):
        """rad"""
        return self.ticks[side][k] / TICKS * 2 * math.pi

    def number(self, k, name):
        """Of the row that ends at time k; None where there is none."""
        value = self.rows[k - 1].get(name, "") if k > 0 else ""
        return float(value) if value else None


def product(a, b):
    """Of quaternions x, y, z, w."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


# Of a camera: x to the right, y down, z ahead.
OPTICAL = (-0.5, 0.5, -0.5, 0.5)


def turn_back(vector):
    """Axes of the robot to those of the camera."""
    x, y, z = vector
    return (-y, -z, x)


def place(time, parent, child, translation, rotation):
    names = ("x", "y", "z", "w")
    return {"header": header(time, parent), "child_frame_id": child,
            "transform": {"translation": dict(zip(names, translation)),
                          "rotation": dict(zip(names, rotation))}}


def tag_in_camera(time, sighting):
    """A tag on a wall: its z axis points into the wall; yaw is where that points."""
    r, bearing = float(sighting["range"]), float(sighting["bearing"])
    if not sighting.get("yaw"):  # who reads none puts the tag's axes along its own
        return place(time, "camera_optical", TAGS + sighting["landmark"],
                     turn_back((r * math.cos(bearing) - CAMERA[0],
                                r * math.sin(bearing) - CAMERA[1], 0.1)), (0.0, 0.0, 0.0, 1.0))
    yaw = float(sighting["yaw"])
    at = (r * math.cos(bearing) - CAMERA[0], r * math.sin(bearing) - CAMERA[1], 0.1)
    around = (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
    upright = product(around, OPTICAL)  # z to where yaw points
    x, y, z, w = OPTICAL
    return place(time, "camera_optical", TAGS + sighting["landmark"], turn_back(at),
                 product((-x, -y, -z, w), upright))


def bag_of(recording, style, every=1):
    """`every`: a covariate's message in so many rows."""
    bag = BagWriter()
    bag.topic("/joint_states", "sensor_msgs/msg/JointState")
    bag.topic("/odom", "nav_msgs/msg/Odometry")
    bag.topic("/imu/data", "sensor_msgs/msg/Imu")
    bag.topic("/tf", "tf2_msgs/msg/TFMessage")
    bag.topic("/tf_static", "tf2_msgs/msg/TFMessage")
    bag.topic("/landmark", "std_msgs/msg/String")
    bag.topic("/mocap/pose", "geometry_msgs/msg/PoseStamped")
    bag.topic("/gps/point", "geometry_msgs/msg/PointStamped", POINT_STAMPED)
    for name in recording.covariates:
        bag.topic("/status/" + name, "std_msgs/msg/Float64")
    first = EPOCH + recording.t[0]
    bag.write("/tf_static", first, {"transforms": [
        place(first, "base_link", "camera_optical", CAMERA, OPTICAL)]})
    x = y = heading = 0.0
    for k, t in enumerate(recording.t):
        now = EPOCH + t
        left, right = recording.angle(0, k), recording.angle(1, k)
        speed = turn = 0.0
        if k > 0:
            dt = (t - recording.t[k - 1]) * 1e-9
            d_left = RADIUS * (left - recording.angle(0, k - 1))
            d_right = RADIUS * (right - recording.angle(1, k - 1))
            speed = 0.5 * (d_left + d_right) / dt
            turn = (d_right - d_left) / recording.wheelbase / dt
            x += speed * dt * math.cos(heading + 0.5 * turn * dt)
            y += speed * dt * math.sin(heading + 0.5 * turn * dt)
            heading += turn * dt
        if style == "joints":
            bag.write("/joint_states", now + 700_000,
                      joint_state(now, ["left_wheel_joint", "right_wheel_joint"], [left, right]))
        bag.write("/odom", now + 900_000, odometry(now, x, y, heading, speed, turn))
        if k > 0:
            compass, rate = recording.number(k, "heading"), recording.number(k, "yaw_rate")
            if compass is not None or rate is not None:
                message = imu(now, rate or 0.0, heading=compass or 0.0)
                message["orientation_covariance"] = [-1.0 if compass is None else 1e-3] + [0.0] * 8
                bag.write("/imu/data", now + 300_000, message)
        for name in recording.covariates if k % every == 0 else []:
            value = recording.rows[max(k - 1, 0)][name]
            bag.write("/status/" + name, now, {"data": float(value)})
    tags = any(one.get("range") and one.get("bearing") for one in recording.sightings)
    for one in recording.sightings:
        now = EPOCH + recording.ns(one["t"])
        if one.get("range") and one.get("bearing"):
            bag.write("/tf", now, {"transforms": [tag_in_camera(now, one)]})
        elif not one.get("range") and not one.get("bearing"):
            bag.write("/landmark", now, string((TAGS if tags else "") + one["landmark"]))
    for one in recording.truth:
        now = EPOCH + recording.ns(one["t"])
        bag.write("/mocap/pose", now,
                  pose_stamped(now, float(one["x"]), float(one["y"]), float(one["heading"])))
    for one in recording.fixes:
        now = EPOCH + recording.ns(one["t"])
        bag.write("/gps/point", now, {"header": {"stamp": stamp(now), "frame_id": "map"},
                                      "point": {"x": float(one["x"]), "y": float(one["y"]), "z": 0.0}})
    return bag


def write_wpilog(recording, path):
    """Ticks and degrees, each entry on its own, as a robot's program logs them."""
    with WpiLog(path) as log:
        left = log.start("/drive/leftEncoderTicks", "int64")
        right = log.start("/drive/rightEncoderTicks", "int64")
        compass = log.start("/drive/compassDegrees", "double")
        tag = log.start("/vision/landmark", "string")
        status = {name: log.start("/status/" + name, "double") for name in recording.covariates}
        seen = sorted((recording.ns(one["t"]), one["landmark"]) for one in recording.sightings)
        for k, t in enumerate(recording.t):
            log.write(left, t // 1000, recording.ticks[0][k])
            log.write(right, t // 1000, recording.ticks[1][k])
            heading = recording.number(k, "heading")
            if heading is not None:
                log.write(compass, t // 1000, math.degrees(heading))
            for name, entry in status.items():
                log.write(entry, t // 1000, float(recording.rows[max(k - 1, 0)][name]))
            while seen and seen[0][0] <= t:
                at, name = seen.pop(0)
                log.write(tag, at // 1000, name)


def write_roadrunner(recording, path):
    drive = struct_of(timestamp=LONG, leftEncTicks=LONG, rightEncTicks=LONG, compass=DOUBLE)
    with RoadRunnerLog(path) as log:
        log.channel("DRIVE", drive)
        log.channel("LANDMARK", struct_of(timestamp=LONG, landmark=STRING))
        seen = sorted((recording.ns(one["t"]), one["landmark"]) for one in recording.sightings)
        for k, t in enumerate(recording.t):
            heading = recording.number(k, "heading")
            log.write("DRIVE", {"timestamp": t, "leftEncTicks": recording.ticks[0][k],
                                "rightEncTicks": recording.ticks[1][k],
                                "compass": math.nan if heading is None else heading})
            while seen and seen[0][0] <= t:
                at, name = seen.pop(0)
                log.write("LANDMARK", {"timestamp": at, "landmark": name})


def write_table(recording, path):
    """Milliseconds, ticks, degrees; a landmark's name in the row at whose time it stood there."""
    seen = {}
    for one in recording.sightings:
        seen.setdefault(recording.ns(one["t"]), []).append(one["landmark"])
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["Time (ms)", "Left Encoder (ticks)", "Right Encoder (ticks)", "Compass (deg)"]
                      + recording.covariates + ["Landmark"])
        for k, t in enumerate(recording.t):
            heading = recording.number(k, "heading")
            rows.writerow([repr(t / 1e6), recording.ticks[0][k], recording.ticks[1][k],
                           "" if heading is None else repr(math.degrees(heading))]
                          + [recording.rows[max(k - 1, 0)][name] for name in recording.covariates]
                          + seen.get(t, [""])[:1])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("recording")
    parser.add_argument("folder")
    parser.add_argument("--style", choices=["joints", "odometry"], default="joints")
    parser.add_argument("--wheelbase", type=float, default=0.34)
    parser.add_argument("--compression", default="zstd")
    parser.add_argument("--only", nargs="*", default=["mcap", "bag", "wpilog", "log", "csv"])
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    recording = Recording(options.recording, options.wheelbase)

    def path(name):
        return os.path.join(options.folder, name)

    bag = bag_of(recording, options.style)
    if "mcap" in options.only:
        bag.write_mcap(path("drive.mcap"), compression=options.compression)
    if "bag" in options.only:
        bag.write_rosbag2(path("bag"))
    if "wpilog" in options.only:
        write_wpilog(recording, path("drive.wpilog"))
    if "log" in options.only:
        write_roadrunner(recording, path("drive.log"))
    if "csv" in options.only:
        write_table(recording, path("drive.csv"))


if __name__ == "__main__":
    main()
