#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Writes wall_runs.csv: ten squares of a robot that measures where it stands by three distances to
the walls of a corner, before and after (wall_sensors.csv), made up without trussmap.

    python3 maps/make_wall_runs.py > maps/wall_runs.csv
"""
import math
import random

SIDE, WHEELBASE = 4.0, 0.34
E_D, E_B = 1.0008, 0.989          # its right wheel over its left, true over believed wheelbase
K = 0.001                         # m^1/2, noise of each wheel
SD = 0.002                        # m, of a distance
BEHIND, RIGHT = (-0.2, 0.2), (-0.2, -0.2)
SIDEWAYS = (0.1, -0.2)            # of the sensor that faces right
STEPS = 200


def rolled(pose, left, right):
    """What the wheels' true travels make of a pose."""
    x, y, heading = pose
    for _ in range(STEPS):
        a = left / STEPS + K * math.sqrt(abs(left) / STEPS) * random.gauss(0, 1)
        b = right / STEPS + K * math.sqrt(abs(right) / STEPS) * random.gauss(0, 1)
        turn = (b - a) / (WHEELBASE * E_B)
        x += (a + b) / 2 * math.cos(heading + turn / 2)
        y += (a + b) / 2 * math.sin(heading + turn / 2)
        heading += turn
    return x, y, heading


def distances(pose):
    """From the walls, which are the axes: two sensors face x = 0, one faces y = 0."""
    x, y, heading = pose
    c, s = math.cos(heading), math.sin(heading)
    first, second = (x + c * at[0] - s * at[1] for at in (BEHIND, RIGHT))
    third = y + s * SIDEWAYS[0] + c * SIDEWAYS[1]
    return [d + random.gauss(0, SD) for d in (first, second, third)]


random.seed(4)
left_share = 2 / (1 + E_D)
right_share = E_D * left_share
print(f"# Ten squares of {SIDE:g} m, by a simulated robot in a corner (maps/make_wall_runs.py), m and rad")
print("direction,start1,start2,start3,end1,end2,end3,odometry_x,odometry_y,odometry_heading")
for direction, sign in [("cw", -1)] * 5 + [("ccw", 1)] * 5:
    pose = (0.6 + random.gauss(0, 0.02), 0.8 + random.gauss(0, 0.02), random.gauss(0, 0.02))
    before = distances(pose)
    quarter = sign * WHEELBASE * math.pi / 4
    for _ in range(4):
        pose = rolled(pose, left_share * SIDE, right_share * SIDE)
        pose = rolled(pose, -left_share * quarter, right_share * quarter)
    after = distances(pose)
    print(direction, *(f"{d:.4f}" for d in before + after), "0,0,0", sep=",")
