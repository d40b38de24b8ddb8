# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Makes the logs in maps/logs: a bag and a team's table, out of simulated recordings.

    python3 maps/make_logs.py build/trussmap

Needs python3-zstandard. The logs are written by tests/logs/bags, which share nothing with the readers.
"""

import csv
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "tests", "io", "bags"))
from recording_as_logs import Recording, bag_of, read  # noqa: E402

LOGS = os.path.join(HERE, "logs")
RADIUS, TICKS = 0.05, 2048  # m; a turn


def simulate(trussmap, folder, *options):
    subprocess.run([trussmap, "simulate", "--mesh", "3x3", "--out", folder, *options], check=True,
                   capture_output=True)


def make_bag(trussmap, scratch):
    folder = os.path.join(scratch, "bag")
    simulate(trussmap, folder, "--tours", "2", "--seed", "7", "--range-sensor", "--markers",
             "--effect", "load on one wheel (payload_kg)=-0.0015")
    recording = Recording(folder, 0.34)
    recording.covariates = ["payload_kg"]
    bag_of(recording, "joints", every=10).write_mcap(os.path.join(LOGS, "warehouse.mcap"),
                                                     compression="zstd")


def make_table(trussmap, scratch):
    folder = os.path.join(scratch, "table")
    simulate(trussmap, folder, "--tours", "3", "--seed", "11", "--no-compass", "--gyro", "--effect",
             "gyro scale=0.02")
    rows = read(os.path.join(folder, "drive.csv"))
    seen = {round(1000 * float(one["t"])): one["landmark"]
            for one in read(os.path.join(folder, "sightings.csv"))}
    step = float(rows[1]["t"]) - float(rows[0]["t"])
    rows.insert(0, {"t": float(rows[0]["t"]) - step, "left": 0, "right": 0, "yaw_rate": 0})
    left = right = gyro = 0.0
    with open(os.path.join(LOGS, "team.csv"), "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["Time (ms)", "Left Encoder (ticks)", "Right Encoder (ticks)", "Gyro (deg)",
                        "Battery (V)", "Floor Tag"])
        for k, row in enumerate(rows):
            left += float(row["left"])
            right += float(row["right"])
            gyro += float(row["yaw_rate"]) * step
            ms = round(1000 * float(row["t"]))
            table.writerow([ms, *(round(d / (2 * math.pi * RADIUS) * TICKS) for d in (left, right)),
                            f"{math.degrees(gyro):.4f}", f"{12.6 - 0.0001 * k:.2f}",
                            seen.get(ms, "")])
    with open(os.path.join(LOGS, "team_survey.csv"), "w", encoding="utf-8") as file:
        with open(os.path.join(folder, "survey.csv"), encoding="utf-8") as survey:
            file.write(survey.read())


def main():
    os.makedirs(LOGS, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        make_bag(os.path.abspath(sys.argv[1]), scratch)
        make_table(os.path.abspath(sys.argv[1]), scratch)


if __name__ == "__main__":
    main()
