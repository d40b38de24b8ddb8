#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""A week of driving: what compare and diagnose cost beside building the map, and how it grows.

Usage: bench/week_bench.py [--command build/trussmap] [--sides 4 10 30] [--rounds 1]

Draws tours of square meshes (simulate --tours 6), with and without compass, of about 10^2, 10^3 and
10^4 legs, and prints processor time (user and system) and the largest memory of each command, ratios
within one run, and a line "holds" or "MISSED" for each target.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

MOST_COMPARE = 3.0   # times build
MOST_DIAGNOSE = 10.0
MOST_MEMORY = 1.5    # GB
MOST_PER_LEG = 1.5   # of 10^4 legs over 10^2 and 10^3


def run(command):
    """Processor time [s] and largest memory [GB] of a command that has to succeed."""
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, stdout=output, stderr=output)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            output.seek(0)
            sys.exit(f"{' '.join(map(str, command))}: {output.read().decode()}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e6


def least(command, rounds):
    return min(run(command) for _ in range(rounds))


def verdict(what, value, most):
    print(f"  {what}: {value:.2f}, target {most:g}: {'holds' if value <= most else 'MISSED'}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default="build/trussmap", type=pathlib.Path)
    parser.add_argument("--sides", nargs="+", type=int, default=[4, 10, 30])
    parser.add_argument("--rounds", type=int, default=1)
    options = parser.parse_args()
    trussmap = options.command.resolve()
    with tempfile.TemporaryDirectory() as scratch:
        for compass in (True, False):
            print("with compass" if compass else "without compass")
            per_leg = {"compare": [], "diagnose": []}
            for side in options.sides:
                folder = pathlib.Path(scratch) / f"{side}_{compass}"
                run([trussmap, "simulate", "--mesh", f"{side}x{side}", "--tours", "6", "--out",
                     folder] + ([] if compass else ["--no-compass"]))
                model = ["--model", folder / "model.toml", folder]
                build, memory = least([trussmap, "build", "--method", "adjustment", "--out",
                                       folder / "map.graphml"] + model, options.rounds)
                report = folder / "compare.json"
                compare = least([trussmap, "compare", "--json", report] + model, options.rounds)
                diagnose = least([trussmap, "diagnose"] + model, options.rounds)
                legs = json.loads(report.read_text())["legs"]
                print(f" {side} x {side}, {legs} legs: build {build:.2f} s {memory:.2f} GB, compare"
                      f" {compare[0]:.2f} s {compare[1]:.2f} GB, diagnose {diagnose[0]:.2f} s"
                      f" {diagnose[1]:.2f} GB")
                per_leg["compare"].append(compare[0] / legs)
                per_leg["diagnose"].append(diagnose[0] / legs)
            verdict("compare over build", compare[0] / build, MOST_COMPARE)
            verdict("diagnose over build", diagnose[0] / build, MOST_DIAGNOSE)
            verdict("largest memory [GB]", max(compare[1], diagnose[1]), MOST_MEMORY)
            for name, costs in per_leg.items():
                verdict(f"{name} per leg, the most over the fewest", costs[-1] / costs[0],
                        MOST_PER_LEG)


if __name__ == "__main__":
    main()
