#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Reports of every command over small worlds, read by rules for what cannot be.

Usage: tests/sweep/reports.py [--command build/trussmap] [--reports 2000] [--first-seed 1] [--keep DIR]

Prints each rule that a report breaks, with the world's seed and the call, and how many reports there
were of each command. Status 1: some did.
"""
import argparse
import collections
import json
import pathlib
import random
import shutil
import sys
import tempfile

import report_rules
from running import Command, wrong_way_out
from worlds import World, catalogue_of


def calls_of(world):
    """Commands over a world, each with what its name in the output is."""
    draw = random.Random(world.seed + 1_000_000)
    model = world.folder / "model.toml"
    yield "build", ["build", world.folder, "--model", model]
    method = draw.choice(["elastic", "elastic-printed", "gauss-markov"])
    yield f"build {method}", ["build", world.folder, "--model", model, "--method", method]
    for name in ("compare", "diagnose", "discover", "calibrate", "watch"):
        more = ["--holdout", draw.choice(["0", "0.5"])] if name != "watch" and draw.random() < 0.2 else []
        yield name, [name, world.folder, "--model", model, *more]
    yield "check", ["check", world.folder, *(["--model", model] if draw.random() < 0.7 else [])]
    yield "apply", ["apply", world.folder, "--model", model, "--out", world.folder / "out.csv",
                    *(["--adjusted"] if draw.random() < 0.5 else [])]


def rehearsals_of(seed):
    """Commands that need no recording."""
    draw = random.Random(seed + 2_000_000)
    about = lambda spread: f"{1 + draw.choice([0, 0.3, 1, -1]) * spread:g}"
    noisy = ["--scatter", draw.choice([0, 0.001, 0.02]), "--true-k-left", draw.choice([0, 0.002, 0.01]),
             "--true-k-right", draw.choice([0, 0.002]), "--seed", seed]
    yield "umbmark", ["umbmark", "--simulate", "--true-E-d", about(0.01), "--true-E-b", about(0.03),
                      *noisy, "--runs", draw.choice([2, 5]), "--rounds", draw.choice([1, 2])]
    yield "tape", ["tape", "--simulate", "--true-E-s", about(0.02), "--true-E-b", about(0.05), *noisy,
                   "--runs", draw.choice([2, 3, 5])]
    yield "noise", ["noise", "--simulate", "--path", draw.choice(["10,-10", "eight@1", "3,a90,3"]),
                    *noisy, "--runs", draw.choice([3, 20, 60])]
    yield "tour", ["tour", "--mesh", draw.choice(["2x2", "3x3"]), "--tours", draw.choice([1, 2, 3]),
                   "--seeds", draw.choice([1, 2]), "--first-seed", seed,
                   *(["--wheels", 0.003, "--no-compass"] if draw.random() < 0.4 else [])]
    yield "explore", ["explore", "--mesh", draw.choice(["2x2", "3x3", "4x3"]), "--seed", seed,
                      *(["--no-compass"] if draw.random() < 0.4 else []),
                      *(["--reach", 6] if draw.random() < 0.3 else [])]


class Reading:
    """Reports as they are read, and what was wrong."""

    def __init__(self, trussmap, keep):
        self.trussmap = trussmap
        self.keep = keep
        self.counted = collections.Counter()
        self.broken = collections.Counter()
        self.nulls = collections.Counter()

    def wrong(self, rule, what, seed, arguments):
        self.broken[rule] += 1
        print(f"seed {seed}, {rule}: {what}\n    {' '.join(map(str, arguments))}", flush=True)

    def read(self, name, arguments, seed, known, written):
        """The report of a call, or None where it refused its input."""
        ran = self.trussmap.run(*arguments, *([] if name == "apply" else ["--json", written]))
        ill = wrong_way_out(ran)
        if ill:
            self.wrong("ends", f"{ill}: {ran.err.strip()[:200]}", seed, arguments)
        self.counted[name.split()[0]] += 1
        if ran.status not in (0, 1) or not ran.out:
            return None
        data = {} if name == "apply" or not pathlib.Path(written).exists() else \
            report_rules.read_json(written)
        report = report_rules.Report(name, ran.out, ran.err, data, known)
        for path, value in report_rules.walk(data):
            if value is None:
                self.nulls[f"{name.split()[0]}: {path}"] += 1
        for rule, what in report_rules.broken_rules(report):
            self.wrong(rule, what, seed, arguments)
        return report


def read_world(reading, effects, seed, scratch):
    folder = scratch / f"world{seed}"
    world = World(reading.trussmap, effects, seed, folder)
    if world.simulated.status != 0:
        ill = wrong_way_out(world.simulated)
        if ill or world.simulated.status != 2:
            reading.wrong("ends", f"{ill}: {world.simulated.err[:200]}", seed, world.arguments)
        return
    reports = []
    for name, arguments in calls_of(world):
        report = reading.read(name, arguments, seed, world.known, scratch / "report.json")
        if report and "--holdout" not in arguments:
            reports.append(report)
    read_fitted(reading, world, scratch)
    for rule, what in report_rules.rules_across(reports):
        reading.wrong(rule, what, seed, world.arguments)
    if not reading.keep:
        shutil.rmtree(folder)


def read_fitted(reading, world, scratch):
    """A model with an effect, fitted, and its map as a pose graph, adjusted."""
    added, graph = world.folder / "added.toml", world.folder / "graph.g2o"
    effect = world.random.choice(["wheelbase", "travel scale", "wheel diameter ratio", "turn scrub"])
    model = world.folder / "model.toml"
    if reading.trussmap.run("add", model, effect, "--out", added).status == 0:
        more = ["--noise"] if world.random.random() < 0.3 else []
        reading.read("fit", ["fit", world.folder, "--model", added, *more], world.seed, world.known,
                     scratch / "report.json")
    if reading.trussmap.run("build", world.folder, "--model", model, "--out", graph).status == 0 \
            and graph.exists():
        reading.read("adjust", ["adjust", graph], world.seed, world.known, scratch / "report.json")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default="build/trussmap", type=pathlib.Path)
    parser.add_argument("--reports", type=int, default=2000)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path)
    options = parser.parse_args()
    trussmap = Command(options.command, seconds=180, memory=None)
    with tempfile.TemporaryDirectory() as temporary:
        scratch = options.keep or pathlib.Path(temporary)
        scratch.mkdir(parents=True, exist_ok=True)
        effects = catalogue_of(trussmap, scratch / "effects.json")
        reading = Reading(trussmap, options.keep)
        seed = options.first_seed
        while sum(reading.counted.values()) < options.reports:
            read_world(reading, effects, seed, scratch)
            for name, arguments in rehearsals_of(seed):
                reading.read(name, arguments, seed, {"gyro": name == "tape"}, scratch / "report.json")
            seed += 1
    print(f"{sum(reading.counted.values())} reports: {json.dumps(reading.counted)}")
    print(f"null in JSON: {json.dumps(dict(reading.nulls.most_common(40)))}")
    print(f"rules broken: {json.dumps(reading.broken)}")
    return 1 if reading.broken else 0


if __name__ == "__main__":
    sys.exit(main())
