# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""One drive as loggers of five kinds would write it, each in tables of its own, and as one table.

usage: joined_layouts.py DIR [DRIVES]   writes DIR/single, DIR/one ... DIR/five, DIR/still

Wheels with noise, a gyro that says 3 % too much, tags by range and bearing. It knows nothing of the
readers that it tests. Seed 7.
"""
import datetime
import math
import os
import random
import sys

OUT = sys.argv[1]
DRIVES = int(sys.argv[2]) if len(sys.argv) > 2 else 10
B = 0.34  # m, wheelbase
GYRO = 1.03
DT = 0.05  # s
EPOCH = 1748457053  # s
MARKS = {f"L{i}{j}": (2.0 * i, 2.0 * j) for i in range(4) for j in range(4)}
rng = random.Random(7)

x = y = heading = 0.0
T, L, R, W = [0.0], [0.0], [0.0], [0.0]
tags = []


def wrapped(angle):
    return math.remainder(angle, 2 * math.pi)


def drive(v, w, rows):
    global x, y, heading
    for _ in range(rows):
        ds, turn = v * DT, w * DT
        x += ds * math.cos(heading + turn / 2)
        y += ds * math.sin(heading + turn / 2)
        heading += turn
        left, right = ds - B / 2 * turn, ds + B / 2 * turn
        T.append(round(T[-1] + DT, 6))
        L.append(L[-1] + left + rng.gauss(0, 6e-4) * math.sqrt(abs(left)))
        R.append(R[-1] + right + rng.gauss(0, 6e-4) * math.sqrt(abs(right)))
        W.append(w * GYRO)


def look():
    seen = 0
    for name, (mx, my) in MARKS.items():
        away = math.hypot(mx - x, my - y)
        if 0.3 < away < 3.1 and seen < 3:
            seen += 1
            bearing = wrapped(math.atan2(my - y, mx - x) - heading) + rng.gauss(0, 5e-3)
            tags.append((T[-1], name, f"{away + rng.gauss(0, 0.01):.6f}", f"{bearing:.6f}"))


for _ in range(DRIVES):
    gx, gy = 2.0 * rng.randrange(4), 2.0 * rng.randrange(4)
    if math.hypot(gx - x, gy - y) < 0.5:
        continue
    turn = wrapped(math.atan2(gy - y, gx - x) - heading)
    rows = max(1, int(abs(turn) / (0.9 * DT)))
    drive(0.0, turn / rows / DT, rows)
    way = math.hypot(gx - x, gy - y)
    rows = max(1, int(way / (0.5 * DT)))
    drive(way / rows / DT, 0.0, rows)
    drive(0.0, 0.0, 10)
    look()
N = len(T)


def table(path, head, rows, separator=","):
    file = os.path.join(OUT, path)
    os.makedirs(os.path.dirname(file), exist_ok=True)
    with open(file, "w", encoding="utf-8") as text:
        for row in ([head] if head else []) + rows:
            text.write(separator.join(row) + "\n")


def muddled(rows, twice):
    """Some rows twice, all in any order."""
    rows = rows + rng.sample(rows, min(twice, len(rows)))
    rng.shuffle(rows)
    return rows


ROBOT = """[robot]
wheelbase = 0.34
[noise]
left = 0.001
right = 0.001
range = 0.01
bearing = 0.005
[survey]
file = "survey.csv"
"""


def finish(folder, text, before=""):
    table(f"{folder}/survey.csv", ["landmark", "x", "y"],
          [[name, str(a), str(b)] for name, (a, b) in MARKS.items()])
    with open(os.path.join(OUT, folder, "map.toml"), "w", encoding="utf-8") as file:
        file.write(before + ROBOT + text)


def sightings(file, names, extra=""):
    keys = "".join(f'{key} = "{name}"\n' for key, name in zip(("landmark", "range", "bearing"), names))
    return "[[sightings]]\n" + (f'file = "{file}"\n' if file else "") + keys + extra


def clock(file, field, extra=""):
    return f'[[time]]\nfile = "{file}"\nfield = "{field}"\n' + extra


# One table with all.
seen_at = {}
for tag in tags:
    seen_at.setdefault(tag[0], []).append(tag)
rows = []
for k in range(N):
    row = [f"{T[k]:.3f}", f"{L[k]:.9f}", f"{R[k]:.9f}", f"{W[k]:.9f}"]
    for m in range(3):
        here = seen_at.get(T[k], [])
        row += list(here[m][1:]) if m < len(here) else ["", "", ""]
    rows.append(row)
table("single/all.csv", "t left right gyro".split() +
      [f"{name}{m}" for m in range(3) for name in ("tag", "range", "bearing")], rows)
finish("single", '[wheels]\nleft.field = "left"\nright.field = "right"\n[yaw_rate]\nfield = "gyro"\n' +
       "".join(sightings("", (f"tag{m}", f"range{m}", f"bearing{m}")) for m in range(3)),
       '[time]\nfield = "t"\n')

# One clock, rows out of order and twice.
table("one/encoders.csv", ["t", "left", "right"],
      muddled([[f"{T[k]:.3f}", f"{L[k]:.9f}", f"{R[k]:.9f}"] for k in range(N)], 90))
table("one/imu.csv", ["t", "gyro_x", "gyro_y", "gyro_z"],
      muddled([[f"{T[k]:.3f}", f"{0.01 * (k % 3)}", "0.0", f"{W[k]:.9f}"] for k in range(N)], 50))
table("one/tags.csv", ["t", "tag_id", "range", "bearing"],
      muddled([[f"{tag[0]:.3f}", *tag[1:]] for tag in tags], 10))
finish("one", '[wheels]\nfile = "encoders.csv"\nleft.field = "left"\nright.field = "right"\n'
       '[yaw_rate]\nfile = "imu.csv"\nfield = "gyro_z"\n' +
       sightings("tags.csv", ("tag_id", "range", "bearing")), '[time]\nfield = "t"\n')


# Unix time in two columns; an IMU that counts ms since its own start.
def split(t):
    ns = round(t * 1e9)
    return [str(EPOCH + ns // 10**9), str(ns % 10**9)]


table("two/wheels.csv", ["sec", "nanosec", "l_mm", "r_mm"],
      [split(T[k]) + [f"{1000 * v[k]:.6f}".replace(".", ",") for v in (L, R)] for k in range(N)], ";")
table("two/imu.csv", ["ms", "gz_dps"],
      [[f"{(T[k] + 17.35) * 1000:.1f}", f"{math.degrees(W[k]):.12f}"] for k in range(N)], "\t")
table("two/tags.csv", ["sec", "nanosec", "name", "range_cm", "bearing_deg"],
      [split(tag[0]) + [tag[1], f"{100 * float(tag[2]):.4f}", f"{math.degrees(float(tag[3])):.9f}"]
       for tag in tags])
finish("two", '[wheels]\nfile = "wheels.csv"\nunit = "mm"\nleft.field = "l_mm"\nright.field = "r_mm"\n'
       '[yaw_rate]\nfile = "imu.csv"\nfield = "gz_dps"\nunit = "deg/s"\n' +
       sightings("tags.csv", ("name", "range_cm", "bearing_deg"), 'range_unit = "cm"\nbearing_unit = "deg"\n'),
       '[[time]]\nfield = "sec"\nfraction = "nanosec"\n' +
       clock("imu.csv", "ms", f'unit = "ms"\nclock = {EPOCH - 17.35}\n'))

# An odometry as rostopic echo -p prints it; sightings on a clock of their own.
HEAD = ("%time,field.header.seq,field.header.stamp,field.header.frame_id,field.child_frame_id," +
        ",".join(f"field.pose.pose.{part}" for part in
                 ("position.x position.y position.z orientation.x orientation.y orientation.z "
                  "orientation.w").split()) + "," +
        ",".join(f"field.pose.covariance{k}" for k in range(36)) + "," +
        ",".join(f"field.twist.twist.{part}.{axis}" for part in ("linear", "angular") for axis in "xyz"))
odometry = []
px = py = turned = 0.0
for k in range(N):
    ds = turn = 0.0
    if k:
        ds = (L[k] - L[k - 1] + R[k] - R[k - 1]) / 2
        turn = (R[k] - R[k - 1] - L[k] + L[k - 1]) / B
        chord = ds if abs(turn) < 1e-12 else ds * math.sin(turn / 2) / (turn / 2)
        px += chord * math.cos(turned + turn / 2)
        py += chord * math.sin(turned + turn / 2)
        turned += turn
    ns = EPOCH * 10**9 + round(T[k] * 1e9)
    odometry.append([str(ns + 19694687), str(k), str(ns), "odom", "base_link", f"{px:.12f}", f"{py:.12f}",
                     "0.0", "0.0", "0.0", f"{math.sin(turned / 2):.15f}", f"{math.cos(turned / 2):.15f}"] +
                    ["0.0"] * 36 + [f"{ds / DT:.12f}", "0.0", "0.0", "0.0", "0.0", f"{turn / DT:.12f}"])
table("three/odom.csv", HEAD.split(","), odometry)
table("still/odom.csv", HEAD.split(","),
      [row[:5] + ["0.0"] * 6 + ["1.0"] + row[12:] for row in odometry])
table("three/gyro.csv", ["stamp_ns", "wx", "wy", "wz"],
      [[odometry[k][2], "0.0", "0.0", f"{W[k]:.9f}"] for k in range(N)])
table("three/detections.csv", ["time_us", "marker", "range_m", "bearing_rad"],
      [[f"{(tag[0] + 3) * 1e6:.0f}", *tag[1:]] for tag in tags])
POSE = "field.pose.pose."
finish("three", '[odometry]\nfile = "odom.csv"\n' +
       f'x = "{POSE}position.x"\ny = "{POSE}position.y"\n' +
       "quaternion = [" + ", ".join(f'"{POSE}orientation.{part}"' for part in "xyzw") + "]\n" +
       '[yaw_rate]\nfile = "gyro.csv"\nfield = "wz"\n' +
       sightings("detections.csv", ("marker", "range_m", "bearing_rad")),
       clock("odom.csv", "field.header.stamp", 'unit = "ns"\n') +
       clock("gyro.csv", "stamp_ns", 'unit = "ns"\n') +
       clock("detections.csv", "time_us", f'unit = "us"\nclock = {EPOCH - 3}\n'))


# What each row adds, rows twice; dates.
def date(t):
    when = datetime.datetime(2026, 3, 1, 12) + datetime.timedelta(milliseconds=round(t * 1e3))
    return when.isoformat(timespec="milliseconds")


def added(values, k):
    return f"{values[k] - values[k - 1] if k else 0.0:.12f}"


table("four/increments.csv", ["stamp", "dl", "dr"],
      muddled([[date(T[k]), added(L, k), added(R, k)] for k in range(N)], 90))
table("four/imu.csv", ["stamp", "yaw_rate"], [[date(T[k]), f"{W[k]:.9f}"] for k in range(N)])
table("four/tags.csv", ["stamp", "tag", "range", "bearing"], [[date(tag[0]), *tag[1:]] for tag in tags])
finish("four", '[wheels]\nfile = "increments.csv"\nkind = "per row"\nleft.field = "dl"\nright.field = "dr"\n'
       '[yaw_rate]\nfile = "imu.csv"\nfield = "yaw_rate"\n' +
       sightings("tags.csv", ("tag", "range", "bearing")), '[time]\nfield = "stamp"\nunit = "calendar"\n')

# Speeds; the gyro's sum as a quaternion, on a clock of its own.
table("five/odometry.csv", ["time [s]", "v [m/s]", "omega [rad/s]"],
      [[f"{T[k]:.3f}", odometry[k][48], odometry[k][53]] for k in range(N)])
angle = 0.0
rows = []
for k in range(N):
    angle += W[k] * DT if k else 0.0
    rows.append([f"{T[k] + 100:.3f}", "0", "0", f"{math.sin(angle / 2):.15f}", f"{math.cos(angle / 2):.15f}"])
table("five/imu.txt", "t qx qy qz qw".split(), rows, " ")
table("five/tags.tsv", ["t", "id", "range", "bearing"], [[f"{tag[0]:.3f}", *tag[1:]] for tag in tags], "\t")
finish("five", '[odometry]\nfile = "odometry.csv"\nspeed = "v [m/s]"\nturn_rate = "omega [rad/s]"\n'
       '[yaw_rate]\nfile = "imu.txt"\nquaternion = ["qx", "qy", "qz", "qw"]\n' +
       sightings("tags.tsv", ("id", "range", "bearing")),
       clock("odometry.csv", "time [s]") + clock("imu.txt", "t", "clock = -100\n") + clock("tags.tsv", "t"))
