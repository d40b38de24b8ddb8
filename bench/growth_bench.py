#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""How processor time grows with what is wrong or many in a recording, at twice the size each.

Usage: bench/growth_bench.py [--command build/trussmap] [--doublings 2]

Draws drives whose sightings contradict each other (three in ten have another landmark's name), drives with
many columns, and models with many effects. Prints a line "holds" or "MISSED" for each ratio: 2 is linear.
"""
import argparse
import math
import os
import pathlib
import random
import subprocess
import tempfile

MOST = 3.0  # times as long for twice the size
MODEL = "[robot]\nwheelbase = 0.34\n[noise]\nleft = 0.003\nright = 0.003\ncompass = 0.02\n"


def seconds(*command):
    process = subprocess.Popen([str(one) for one in command], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    usage = os.wait4(process.pid, 0)[2]
    process.returncode = 0
    return usage.ru_utime + usage.ru_stime


def contradicting(folder, rows):
    """Squares of 8 m, driven again and again over 16 landmarks."""
    draw = random.Random(1)
    drive, sightings, heading = ["t,left,right,heading"], ["t,landmark"], 0.0
    for k in range(1, rows + 1):
        turn = math.pi / 2 if k % 40 == 0 else 0.0
        heading += turn
        left, right = (0.05 + side * 0.17 * turn + draw.gauss(0, 2e-4) for side in (-1, 1))
        read = math.remainder(heading + draw.gauss(0, 0.02), 2 * math.pi)
        drive.append(f"{k / 10},{left:.6f},{right:.6f},{read:.5f}")
        if k % 10 == 5:
            label = draw.randrange(16) if draw.random() < 0.3 else k // 10 % 16
            sightings.append(f"{k / 10},L{label}")
    write(folder, drive, sightings)


def many_columns(folder, columns):
    names = ",".join(f"c{k}" for k in range(columns))
    drive = ["t,left,right," + names]
    drive += [f"{row},0.1,0.1," + ",".join(str(row * k % 7) for k in range(columns)) for row in range(1, 21)]
    write(folder, drive, ["t,landmark", "1,A", "10,B", "20,A"])


def write(folder, drive, sightings):
    folder.mkdir()
    (folder / "drive.csv").write_text("\n".join(drive) + "\n")
    (folder / "sightings.csv").write_text("\n".join(sightings) + "\n")
    (folder / "model.toml").write_text(MODEL)


def many_effects(count):
    channels = ["turn", "left", "right", "travel", "compass", "drift"]
    return MODEL + "".join(f'[[effect]]\nname = "own {k}"\nchannel = "{channels[k % 6]}"\n'
                           f'shape = ["sin({k + 1}*t/50)"]\ncoefficients = [0.0]\n' for k in range(count))


def told(what, sizes, times):
    print(f"{what}: " + ", ".join(f"{size}: {time:.2f} s" for size, time in zip(sizes, times)))
    ratio = times[-1] / max(times[-2], 0.05)
    print(f"  {ratio:.2f} times for twice as many, target {MOST:g}: {'holds' if ratio <= MOST else 'MISSED'}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default="build/trussmap", type=pathlib.Path)
    parser.add_argument("--doublings", type=int, default=2)
    options = parser.parse_args()
    trussmap = options.command.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        scratch = pathlib.Path(temporary)
        doubled = lambda first: [first << k for k in range(options.doublings + 1)]
        for what, first, make, command in (("contradicting sightings, build", 6250, contradicting, "build"),
                                           ("columns, check", 25_000, many_columns, "check")):
            times = []
            for size in doubled(first):
                folder = scratch / f"{command}{size}"
                make(folder, size)
                times.append(seconds(trussmap, command, folder, "--model", folder / "model.toml"))
            told(what, doubled(first), times)
        seconds(trussmap, "simulate", "--mesh", "4x4", "--tours", 4, "--out", scratch / "drive")
        times = []
        for count in doubled(62):
            model = scratch / f"effects{count}.toml"
            model.write_text(many_effects(count))
            times.append(seconds(trussmap, "compare", scratch / "drive", "--model", model))
        told("effects, compare", doubled(62), times)


if __name__ == "__main__":
    main()
