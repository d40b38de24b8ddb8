#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""A constant error, one that each leg draws anew, or both: are they told apart?

Usage: bench/constant_or_process.py [--command build/trussmap] [--worlds 200] [--seed 1] [--jobs 1]

Draws worlds (simulate --mesh 4x4 --tours 3 --fixes 1), in turn with an error of the travel (with a compass) and one of the
turns (without), of size s, 1 to 8 %. Each is driven three times:

    constant   travel scale, or wheelbase, of s or -s
    process    each leg misreads its travel, or its turns, by a factor of its own, normal with standard deviation s
    both       both

and `discover` is asked. Named: an effect that it found is that constant (or both wheels' scale in place of the
travel's). Held: its 95 % interval (1.96 standard errors) has the value that was drawn. Of a process alone a constant is
named by mistake. Prints what fails, and a table; the exit status is 1 where a target is missed.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import sys
import tempfile

from gross_bench import Bench, rows_of, write_rows

KINDS = ("constant", "process", "both")
NAMES = {"travel": ("travel scale", "wheel scale"), "turn": ("wheelbase",)}
TARGETS = {"constant": (0.95, 1.0), "process": (0.0, 0.05), "both": (0.95, 1.0)}  # share that is named
HELD = (0.92, 0.98)
FEWEST = 50  # of fewer intervals no share says anything


def spoil(folder, channel, size, draw):
    """Each leg, from one sighting to the next, reads its travel or its turns wrongly by a factor of its own."""
    ends = [float(row["t"]) for row in rows_of(folder / "sightings.csv")]
    rows, leg, factor = rows_of(folder / "drive.csv"), 0, 1.0
    for row in rows:
        while leg < len(ends) and float(row["t"]) > ends[leg]:
            leg += 1
            factor = 1.0 / (1.0 + draw.gauss(0.0, size))
        left, right = float(row["left"]), float(row["right"])
        mean, half = (left + right) / 2.0, (right - left) / 2.0
        mean, half = (mean * factor, half) if channel == "travel" else (mean, half * factor)
        row["left"], row["right"] = repr(mean - half), repr(mean + half)
    write_rows(folder / "drive.csv", rows)


def judged(bench, number, kind):
    draw = random.Random(f"{bench.seed} {number}")
    channel = ("travel", "turn")[number % 2]
    size = 0.01 * math.exp(draw.uniform(0.0, math.log(8.0)))
    g = size * draw.choice((-1.0, 1.0))
    result = {"number": number, "kind": kind, "channel": channel, "g": g, "named": None, "held": None, "found": ""}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        options = ["--mesh", "4x4", "--tours", 3, "--fixes", 1, "--seed", 10000 * bench.seed + number]
        if channel == "turn":
            options.append("--no-compass")
        if kind != "process":
            options += ["--effect", f"{NAMES[channel][0]}={g!r}"]
        if not bench.run("simulate", *options, "--out", folder / "recording"):
            sys.exit(f"world {number}: cannot be simulated")
        if kind != "constant":
            spoil(folder / "recording", channel, size, draw)
        out = folder / "found.json"
        bench.run("discover", folder / "recording", "--model", folder / "recording/model.toml", "--json", out)
        if not out.exists():
            return {**result, "found": "discover failed", "named": False}
        effects = json.loads(out.read_text())["effects"]
    result["found"] = "; ".join(f"{one['effect']} {one['coefficients'][0]:.4g} +- {one['sd'][0] or math.nan:.2g}"
                                for one in effects)
    right = [one for one in effects if one["effect"] in NAMES[channel]]
    result["named"] = bool(right)
    if right and kind != "process" and right[0]["sd"][0]:
        result["held"] = abs(right[0]["coefficients"][0] - g) <= 1.96 * right[0]["sd"][0]
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", type=pathlib.Path, default=pathlib.Path("build/trussmap"))
    parser.add_argument("--worlds", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args()
    bench = Bench(asked.command, asked.seed)
    results = []
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        cases = [(number, kind) for number in range(asked.worlds) for kind in KINDS]
        for one in pool.map(lambda case: judged(bench, *case), cases):
            results.append(one)
            if one["named"] != (one["kind"] != "process") or one["held"] is False:
                print(f"{one['number']:3d} {one['kind']}, {one['channel']} {one['g']:+.4f}: {one['found'] or 'nothing'}",
                      flush=True)
    good = True
    print("\n| | channel | worlds | constant named | 95 % interval holds |\n|---|---|---|---|---|")
    for kind in KINDS:
        for channel in NAMES:
            ones = [one for one in results if one["kind"] == kind and one["channel"] == channel]
            held = [one["held"] for one in ones if one["held"] is not None]
            print(f"| {kind} | {channel} | {len(ones)} | {sum(one['named'] for one in ones)} | "
                  f"{f'{sum(held)}/{len(held)}' if held else '-'} |")
        ones = [one for one in results if one["kind"] == kind]
        low, high = TARGETS[kind]
        good &= not ones or low <= sum(one["named"] for one in ones) / len(ones) <= high
    held = [one["held"] for one in results if one["held"] is not None]
    good &= len(held) < FEWEST or HELD[0] <= sum(held) / len(held) <= HELD[1]
    print(f"\nintervals hold in {sum(held)} of {len(held)}; targets {'hold' if good else 'MISSED'}")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
