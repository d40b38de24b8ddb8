#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Dense sightings: a robot in a wood, whose laser sees tree trunks at every row of its drive.

    python3 bench/woods.py woods                              # 12 609 rows, 58 000 sightings
    python3 bench/woods.py woods1s --every 8 --target 46816   # a frame each second, 5 800 sightings
    python3 bench/woods.py park --rows 4000 --every 8 --target 18000 --white --survey \
        --ahead 0.3 --wrong 0.01 --seed 5                     # 1 % of labels misread beside a survey

The model: wheelbase 0.5 m, wheels 0.002 m^1/2, range 0.05 m, bearing 0.01745 rad. Ranges have as
much more that lasts for 5 s; the robot travels 3 % further than its wheels say, on a wheelbase 4 %
smaller. Needs numpy.
"""

import argparse
import os

import numpy as np

DT = 0.125  # s
BASE = 0.5  # m
SIZE = 50.0  # m, of the wood
REACH = 15.0  # m, of the laser
LASTS = 5.0  # s
WHEELS = 0.002  # m^1/2


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out")
    parser.add_argument("--rows", type=int, default=12609)
    parser.add_argument("--every", type=int, default=1, help="rows between frames")
    parser.add_argument("--trees", type=int, default=110)
    parser.add_argument("--target", type=int, default=58000, help="sightings, times --every")
    parser.add_argument("--travel", type=float, default=0.03)
    parser.add_argument("--base", type=float, default=-0.04)
    parser.add_argument("--ahead", type=float, default=0.0, help="m, of the laser")
    parser.add_argument("--lasting", type=float, default=0.05, help="m, error of ranges that lasts")
    parser.add_argument("--white", action="store_true", help="none that lasts")
    parser.add_argument("--wrong", type=float, default=0.0, help="share of labels misread")
    parser.add_argument("--gyro", action="store_true")
    parser.add_argument("--survey", action="store_true")
    parser.add_argument("--fixes", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def wrapped(angle):
    return np.arctan2(np.sin(angle), np.cos(angle))


def planted(count, random):
    trees = []
    while len(trees) < count:
        place = random.uniform(-5, SIZE + 5, 2)
        if all(np.hypot(*(place - tree)) > 2.5 for tree in trees):
            trees.append(place)
    return np.array(trees)


def driven(rows, random):
    """Poses (one more than rows) and the way of the left and the right wheel in each row."""
    place, heading = np.array([SIZE / 2, SIZE / 2]), 0.0
    goals = random.uniform(5, SIZE - 5, (14, 2))
    order, goal = random.integers(0, 14, 4000), 0
    poses, ways, turns = [(*place, heading)], [], []
    step = DT / 4
    for row in range(rows):
        speed = 0.7 + 0.15 * np.sin(row * DT / 40)
        before = heading
        for _ in range(4):
            if np.hypot(*(goals[order[goal]] - place)) < 1.5:
                goal += 1
            to = goals[order[goal]] - place
            off = wrapped(np.arctan2(to[1], to[0]) - heading)
            turn = np.clip(1.2 * off, -0.6, 0.6) * step
            middle = heading + turn / 2
            chord = speed * step * np.sinc(turn / 2 / np.pi)
            place = place + chord * np.array([np.cos(middle), np.sin(middle)])
            heading += turn
        poses.append((*place, heading))
        ways.append(4 * speed * step)
        turns.append(heading - before)
    return np.array(poses), np.array(ways), np.array(turns)


def write_drive(args, times, ways, turns, random):
    way = ways / (1 + args.travel)
    half = turns * BASE * (1 + args.base) / (1 + args.travel) / 2
    wheels = [way - half, way + half]
    wheels = [w + WHEELS * np.sqrt(np.abs(w)) * random.normal(size=len(w)) for w in wheels]
    gyro = ""
    with open(args.out + "/drive.csv", "w", encoding="utf-8") as file:
        file.write("t,left,right" + (",yaw_rate" if args.gyro else "") + "\n")
        for k, t in enumerate(times):
            if args.gyro:
                rate = turns[k] / DT + 0.0005 + random.normal() * 0.0005 / np.sqrt(DT)
                gyro = f",{rate:.7f}"
            file.write(f"{t:.4f},{wheels[0][k]:.7f},{wheels[1][k]:.7f}{gyro}\n")


def seen(args, trees, poses):
    """Row, tree, range and bearing of all that the laser could see."""
    result = []
    for row in range(0, args.rows, args.every):
        x, y, heading = poses[row + 1]
        eye = [x + np.cos(heading) * args.ahead, y + np.sin(heading) * args.ahead]
        offset = trees - eye
        ranges = np.hypot(offset[:, 0], offset[:, 1])
        bearings = wrapped(np.arctan2(offset[:, 1], offset[:, 0]) - heading)
        visible = (ranges < REACH) & (np.abs(bearings) < np.pi / 2) & (ranges > 0.3)
        result += [(row, k, ranges[k], bearings[k]) for k in np.where(visible)[0]]
    return result


def write_sightings(args, times, sightings, random):
    share = min(1.0, args.target // args.every / len(sightings))
    last, wrong = {}, 0
    with open(args.out + "/sightings.csv", "w", encoding="utf-8") as file:
        file.write("t,landmark,range,bearing\n")
        for row, tree, distance, bearing in sightings:
            if random.random() > share:
                continue
            before, error = last.get(tree, (row, random.normal()))
            keep = np.exp(-(row - before) * DT / LASTS)
            error = keep * error + np.sqrt(1 - keep * keep) * random.normal()
            last[tree] = (row, error)
            if not args.white:
                distance += args.lasting * error
            distance += 0.05 * random.normal()
            bearing += np.radians(1) * random.normal()
            name = tree
            if random.random() < args.wrong:
                name = random.integers(0, args.trees)
                wrong += name != tree
            file.write(f"{times[row]:.4f},tree{name},{distance:.4f},{bearing:.5f}\n")
    return wrong


def main():
    args = options()
    random = np.random.default_rng(args.seed)
    trees = planted(args.trees, random)
    poses, ways, turns = driven(args.rows, random)
    times = 100.0 + DT * np.arange(1, args.rows + 1)
    os.makedirs(args.out, exist_ok=True)
    write_drive(args, times, ways, turns, random)
    wrong = write_sightings(args, times, seen(args, trees, poses), random)
    if args.survey:
        with open(args.out + "/survey.csv", "w", encoding="utf-8") as file:
            file.write("landmark,x,y,sd\n")
            for k, (x, y) in enumerate(trees + 0.005 * random.normal(size=trees.shape)):
                file.write(f"tree{k},{x:.4f},{y:.4f},0.005\n")
    if args.fixes:
        with open(args.out + "/fixes.csv", "w", encoding="utf-8") as file:
            file.write("t,x,y,sd\n")
            for row in range(0, args.rows, 8):
                x, y = poses[row + 1][:2] + 0.02 * random.normal(size=2)
                file.write(f"{times[row]:.4f},{x:.4f},{y:.4f},0.02\n")
    print(f"{wrong} labels misread")


if __name__ == "__main__":
    main()
