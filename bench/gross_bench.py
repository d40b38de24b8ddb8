#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Constants of a two-wheeled robot that are wrong by a factor: are they named, and mended?

Usage: bench/gross_bench.py [--command build/trussmap] [--cases 100] [--seed 1] [--jobs 1] [--only TEXT] [--csv FILE]

Draws worlds (simulate --mesh 4x4 --tours 2 --uneven) in which the stated

    scale   of both wheels     track   of the wheels (the wheelbase)     left, right   wheel's size

is wrong by FACTORS (true over stated), or whose drive.csv has its wheels exchanged or negated (left, right, both), for
robots with 12 equipments: a compass, a gyro or none of them; a survey, truth, fixes or ranges alone; landmarks stood
on, or seen (range and bearing from the stops, none stood on). In all 600 cases, of which --cases takes a part in which
factors, kinds and equipments are as even as can be. Each is judged against what was simulated:

    named      diagnose: the right cause is the first that is missing
    consistent diagnose says so: never right
    alone      diagnose names causes, and the right one is none of them
    calibrated calibrate: both wheels and the wheelbase within 3 of their standard errors (factors alone, and where
               there is survey, truth or fixes)
    map        by the model that discover found: at most 1.3 times as wrong (rms of landmarks, aligned to their true
               places by a rigid motion) as by the true constants

What no data can tell is not asked for:

    scale of both wheels     measured by survey, truth, fixes or ranges, of which every equipment has one; without any
                             of them it would be unobservable, and a factor of it no gross misfit at all
    wheels exchanged         a mirrored world: seen by survey, truth, fixes, bearings, compass or gyro. Ranges alone,
                             without compass or gyro, tell nothing: any verdict but a wrong cause is right
    both wheels negated      the robot backs mirrored. Where nothing tells ahead from back (compass, truth's heading,
                             landmarks seen aside) the same as exchanged wheels: both names are right; by ranges alone,
                             without gyro, it is no misfit, either
    one wheel negated        where nothing tells ahead from back nor left from right, the same as the other negated

Prints what fails, and tables by kind, factor and equipment; the exit status is 1 where a target is missed.
"""
import argparse
import concurrent.futures
import csv
import itertools
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import tomllib

FACTORS = (0.2, 0.3, 0.5, 0.6, 0.8, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0, 5.0)
KINDS = ("scale", "track", "left", "right")
SIGNS = ("exchanged", "negated left", "negated right", "negated both")
HEADINGS = ("compass", "gyro", "none")
PLACES = ("survey", "truth", "fixes", "ranges")
EQUIPMENTS = [(heading, place, ("stood on", "seen")[(i + k) % 2])
              for i, heading in enumerate(HEADINGS) for k, place in enumerate(PLACES)]
NAMES = {"scale": "wheel scale", "track": "wheelbase", "left": "left wheel", "right": "right wheel"}
CHANNELS = {"wheel scale": "wheels", "wheelbase": "turn", "left wheel": "left", "right wheel": "right"}
WHEELBASE = 0.34
MOST_WORSE = 1.3    # of the map
MOST_ERRORS = 3.0   # standard errors of a calibrated constant
LEAST_SHARE = 0.95
LONGEST = 600       # s, of one command
EXACT = 1e-9


class Case:
    def __init__(self, number, kind, factor, equipment):
        self.number, self.kind, self.factor = number, kind, factor
        self.heading, self.place, self.eye = EQUIPMENTS[equipment]
        self.name = f"{number:03d} {kind} {factor or ''} {' '.join(EQUIPMENTS[equipment])}".replace("  ", " ")

    def cause(self):
        """Name and g of the effect that is there."""
        if self.kind in NAMES:
            return NAMES[self.kind], (1 / self.factor if self.kind == "track" else self.factor) - 1
        return {"exchanged": "wheelbase", "negated left": "left wheel", "negated right": "right wheel",
                "negated both": "wheel scale"}[self.kind], -2.0

    def tells_ahead(self):
        return self.heading == "compass" or self.place == "truth" or self.eye == "seen"

    def tells_sides(self):
        """Left from right."""
        return self.heading != "none" or self.place != "ranges" or self.eye == "seen"

    def right(self):
        names = {self.cause()[0]}
        if self.kind == "negated both" and not self.tells_ahead():
            names.add("wheelbase")
        if self.kind in ("negated left", "negated right") and not self.tells_ahead() and not self.tells_sides():
            names |= {"left wheel", "right wheel"}
        return names

    def undecidable(self):
        return self.kind in ("exchanged", "negated both") and not self.tells_sides()


def drawn(count, seed):
    """Round by round: each kind with each factor once, each kind with each equipment, and two wrong signs of each."""
    draw = random.Random(seed)
    numbers = itertools.count()
    shift = {kind: draw.randrange(12) for kind in KINDS + SIGNS}
    cases = []
    for turn in range(12):
        batch = [(kind, factor, (k + shift[kind] + 5 * turn) % 12) for kind in KINDS
                 for k, factor in enumerate(FACTORS)]
        batch.append(("exchanged", None, (shift["exchanged"] + 5 * turn) % 12))
        batch.append((SIGNS[1 + turn % 3], None, (shift["negated left"] + 5 * turn) % 12))
        draw.shuffle(batch)
        cases += [Case(next(numbers), *one) for one in batch]
    return cases[:count]


def effect_text(name, g):
    return (f'\n[[effect]]\nname = "{name}"\nchannel = "{CHANNELS[name]}"\nshape = ["1"]\n'
            f'coefficients = [{g!r}]\n')


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def write_rows(file, rows):
    with open(file, "w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def places_in(file):
    return {row["landmark"]: (float(row["x"]), float(row["y"])) for row in rows_of(file)}


def map_error(found, truth):
    """rms [m] after the rigid motion that brings them nearest; nothing of fewer than two."""
    names = sorted(found.keys() & truth.keys())
    if len(names) < 2:
        return None
    a, b = (centred([one[name] for name in names]) for one in (found, truth))
    dot = sum(x * u + y * v for (x, y), (u, v) in zip(a, b))
    cross = sum(x * v - y * u for (x, y), (u, v) in zip(a, b))
    cos, sin = dot / math.hypot(dot, cross), cross / math.hypot(dot, cross)
    return math.sqrt(sum((cos * x - sin * y - u) ** 2 + (sin * x + cos * y - v) ** 2
                         for (x, y), (u, v) in zip(a, b)) / len(names))


def centred(points):
    x, y = (sum(one[k] for one in points) / len(points) for k in (0, 1))
    return [(one[0] - x, one[1] - y) for one in points]


class Bench:
    def __init__(self, command, seed):
        self.command, self.seed = command.resolve(), seed

    def run(self, *command):
        """Whether it came to an end: exit status 0, or 1 as misfits have."""
        try:
            done = subprocess.run([str(one) for one in (self.command, *command, "--threads", 1)],
                                  capture_output=True, timeout=LONGEST, check=False,
                                  env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        except subprocess.TimeoutExpired:
            return False
        return done.returncode in (0, 1)

    def simulate(self, case, folder):
        """The recording, the true places of its landmarks, and the model with the true constants."""
        recording, exact = folder / "recording", folder / "exact"
        effects = folder / "effects.toml"
        name, g = case.cause()
        effects.write_text(f"[robot]\nwheelbase = {WHEELBASE}\n" + (effect_text(name, g) if case.factor else ""))
        options = ["--mesh", "4x4", "--tours", 2, "--uneven", "--fixes", 1 if case.place == "truth" else 0.5,
                   "--seed", 1000 * self.seed + case.number, "--effects", effects]
        if case.heading == "gyro":
            options.append("--gyro")
        if case.eye == "seen":
            options.append("--range-sensor")
        elif case.place == "ranges":
            options.append("--beacons")
        if not (self.run("simulate", *options, "--out", recording)
                and self.run("simulate", *options, "--out", exact, "--fix-noise", EXACT, "--compass-noise", EXACT,
                             "--survey-noise", EXACT)):
            sys.exit(f"{case.name}: cannot be simulated")
        self.equip(case, recording, exact)
        stated = (recording / "model.toml").read_text()
        (folder / "true.toml").write_text(stated + effect_text(name, g))
        return recording, places_in(exact / "survey.csv"), folder / "true.toml"

    def equip(self, case, recording, exact):
        """Takes away what the robot does not have, and spoils the wheels' signs."""
        drive, true = rows_of(recording / "drive.csv"), rows_of(exact / "drive.csv")
        if any(a["left"] != b["left"] or a["right"] != b["right"] for a, b in zip(drive, true)):
            sys.exit(f"{case.name}: the exact twin drove another way")
        if case.place == "truth":
            self.write_truth(case, recording, rows_of(exact / "fixes.csv"), true)
        for row in drive:
            if case.heading != "compass":
                del row["heading"]
            left, right = row["left"], row["right"]
            back = lambda travel: repr(-float(travel))
            if case.kind == "exchanged":
                row["left"], row["right"] = right, left
            if case.kind in ("negated left", "negated both"):
                row["left"] = back(left)
            if case.kind in ("negated right", "negated both"):
                row["right"] = back(right)
        write_rows(recording / "drive.csv", drive)
        if case.place != "fixes":
            (recording / "fixes.csv").unlink()
        if case.place != "survey":
            (recording / "survey.csv").unlink()
        if case.eye == "seen":
            write_rows(recording / "sightings.csv",
                       [row for row in rows_of(recording / "sightings.csv") if row["range"]])

    def write_truth(self, case, recording, fixes, drive):
        """With the noise that the model states of it."""
        noise = tomllib.loads((recording / "model.toml").read_text())["noise"]
        draw = random.Random(case.name)
        heading = {round(float(row["t"]), 6): float(row["heading"]) for row in drive}
        rows = []
        for one in fixes:
            at = heading.get(round(float(one["t"]), 6))
            if at is not None:
                rows.append({"t": one["t"], "x": float(one["x"]) + draw.gauss(0, noise["truth"]),
                             "y": float(one["y"]) + draw.gauss(0, noise["truth"]),
                             "heading": at + draw.gauss(0, noise["truth_heading"])})
        write_rows(recording / "truth.csv", rows)

    def map_by(self, model, recording, folder, truth):
        out = folder / f"{model.stem}.map.csv"
        self.run("build", recording, "--model", model, "--csv", out)
        return map_error(places_in(out), truth) if out.exists() else None

    def judge_diagnosis(self, case, recording, folder, result):
        out = folder / "diagnosis.json"
        self.run("diagnose", recording, "--model", recording / "model.toml", "--json", out)
        if not out.exists():
            result.update(verdict="failed", named=False, consistent=False, alone=False)
            return
        diagnosis = json.loads(out.read_text())
        found = [one["effect"] for one in diagnosis["candidates"] if one["status"] == "missing"]
        verdict = diagnosis["verdict"]
        right = case.right()
        result.update(verdict=verdict, found="; ".join(found), consistent=verdict == "consistent",
                      named=bool(found) and found[0] in right, alone=bool(found) and not right & set(found))
        if case.undecidable():
            result.update(named=not found or found[0] in right, consistent=False)

    def judge_calibration(self, case, recording, folder, result):
        if not case.factor or case.place == "ranges":
            return
        out = folder / "calibration.json"
        self.run("calibrate", recording, "--model", recording / "model.toml", "--json", out)
        truth = {"left wheel": 1.0, "right wheel": 1.0, "wheelbase": WHEELBASE}
        for kind, names in {"scale": ["left wheel", "right wheel"], "track": ["wheelbase"], "left": ["left wheel"],
                            "right": ["right wheel"]}.items():
            for name in names if kind == case.kind else []:
                truth[name] *= case.factor
        found = {}
        if out.exists():
            found = {one["name"]: one for one in json.loads(out.read_text())["constants"] if one["sd"]}
        errors = [abs(found[name]["new"] - value) / found[name]["sd"] if name in found else math.inf
                  for name, value in truth.items()]
        result.update(errors=float(max(errors)), calibrated=bool(max(errors) <= MOST_ERRORS))

    def judge(self, case):
        result = {"case": case.name, "number": case.number, "kind": case.kind, "factor": case.factor or "",
                  "heading": case.heading, "place": case.place, "eye": case.eye, "cause": case.cause()[0],
                  "undecidable": case.undecidable()}
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            recording, truth, true_model = self.simulate(case, folder)
            self.judge_diagnosis(case, recording, folder, result)
            self.judge_calibration(case, recording, folder, result)
            found = folder / "found.toml"
            self.run("discover", recording, "--model", recording / "model.toml", "--out", found)
            by_truth = self.map_by(true_model, recording, folder, truth)
            error = self.map_by(found if found.exists() else recording / "model.toml", recording, folder, truth)
            result.update(map_true_mm=1e3 * (by_truth or math.nan), map_mm=1e3 * (error or math.nan))
            if not case.undecidable():
                result["map"] = bool(by_truth and error and error <= MOST_WORSE * by_truth)
        return result


COLUMNS = ("case", "number", "kind", "factor", "heading", "place", "eye", "cause", "undecidable", "verdict", "found",
           "named", "consistent", "alone", "errors", "calibrated", "map_true_mm", "map_mm", "map")


def share(results, column):
    asked = [one[column] for one in results if one.get(column) is not None]
    return f"{sum(asked)}/{len(asked)}"


def print_table(results, by, key):
    print(f"\n| {by} | cases | named first | consistent | a wrong cause alone | calibrated | map |")
    print("|---|---|---|---|---|---|---|")
    groups = {}
    for one in results:
        groups.setdefault(key(one), []).append(one)
    for group, ones in sorted(groups.items()):
        print(f"| {group} | {len(ones)} | {share(ones, 'named')} | {share(ones, 'consistent')} | "
              f"{share(ones, 'alone')} | {share(ones, 'calibrated')} | {share(ones, 'map')} |")


def told(one):
    """What fails of a case."""
    faults = [] if one["named"] else [f"named: {one.get('found') or '-'} ({one['verdict']})"]
    faults += [word for word in ("consistent", "alone") if one[word]]
    if one.get("calibrated") is False:
        faults.append(f"calibrated: {one['errors']:.1f} errors off")
    if one.get("map") is False:
        faults.append(f"map: {one['map_mm']:.1f} mm, by the truth {one['map_true_mm']:.1f} mm")
    return "; ".join(faults)


def holds(results):
    good = True
    print()
    for column in ("named", "calibrated", "map"):
        asked = [one[column] for one in results if one.get(column) is not None]
        if asked:
            met = sum(asked) >= LEAST_SHARE * len(asked)
            good &= met
            print(f"{column}: {sum(asked)} of {len(asked)}, target {LEAST_SHARE:.0%}: {'holds' if met else 'MISSED'}")
    for column in ("consistent", "alone"):
        count = sum(one[column] for one in results)
        good &= count == 0
        print(f"{column}: {count}, target none: {'MISSED' if count else 'holds'}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default="build/trussmap", type=pathlib.Path)
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", default="", help="cases whose name contains this")
    parser.add_argument("--csv", type=pathlib.Path, help="a row per case")
    options = parser.parse_args()
    bench = Bench(options.command, options.seed)
    cases = [one for one in drawn(options.cases, options.seed) if options.only in one.name]
    rows = open(options.csv or os.devnull, "w", newline="", encoding="utf-8")
    writer = csv.DictWriter(rows, COLUMNS)
    writer.writeheader()
    results = []
    with rows, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for one in pool.map(bench.judge, cases):
            results.append(one)
            writer.writerow(one)
            rows.flush()
            if told(one):
                print(f"{one['case']}: {told(one)}", flush=True)
    print_table(results, "kind", lambda one: one["kind"])
    print_table(results, "factor", lambda one: one["factor"] or 0)
    print_table(results, "equipment", lambda one: f"{one['heading']}, {one['place']}, {one['eye']}")
    sys.exit(0 if holds(results) else 1)


if __name__ == "__main__":
    main()
