#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Dead reckoning of real recordings, as their own model has it and as trussmap mends it.

    real_bench.py TRUSSMAP DATA JUDGE [--only TEXT] [--jobs 1] [--json OUT]

TRUSSMAP is the command, DATA the folder of recordings, JUDGE a program that judges a path by truth
or fixes (judge.py TRUTH.csv POSES.csv [--fix] [--t0 T] [--t1 T]): none of the project's code. Of each
recording, the error after 10 s and after 30 s of dead reckoning, in mm, by

  nominal     the model that comes with it
  discover    what `discover` adds to it
  calibrate   what `calibrate` makes of it, where something measures distances
  other       what `discover` finds on another recording of the same robot

A dash: there is no such recording, or the command says no.
"""
import argparse
import concurrent.futures
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Name, recording, truth where it is not its own, and another one of the same robot.
RECORDINGS = [
    ("small vehicle, poles", "mtrn-ugv/rec", "mtrn-ugv/judge_truth.csv", None),
    ("Lego robot, overhead camera", "lego-overhead/rec", None, None),
    ("Lego robot, first half", "lego-overhead/first_half", None, "lego-overhead/second_half"),
    ("Lego robot, second half", "lego-overhead/second_half", None, "lego-overhead/first_half"),
    ("mecanum, first drive", "polimi-mecanum/bag1", None, "polimi-mecanum/bag2"),
    ("mecanum, second drive", "polimi-mecanum/bag2", None, "polimi-mecanum/bag1"),
]
TEAMS = [(f"MRCLAM {team}, robot {robot}", team, robot) for team in (1, 4, 6) for robot in range(1, 6)]


def run(command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    return done.returncode == 0


class Bench:
    def __init__(self, options, scratch):
        self.command, self.data, self.judge = options.trussmap, Path(options.data), options.judge
        self.scratch = Path(scratch)

    def errors(self, name, recording, model, truth):
        """After 10 and 30 s, m; of nothing where a path cannot be had or judged."""
        poses = self.scratch / f"{name}.csv"
        if model is None or not run([self.command, "apply", recording, "--model", model, "--out", poses]):
            return None
        command = [sys.executable, self.judge, truth, poses]
        if truth.name == "fixes.csv":
            command.append("--fix")
        said = subprocess.run([str(part) for part in command], capture_output=True, text=True).stdout
        found = {int(seconds): float(error)
                 for seconds, error in re.findall(r"(?:after|over) (\d+) s ([\d.]+) m", said)}
        return [found.get(10), found.get(30)] if found else None

    def model_by(self, name, verb, recording, model, *more):
        out = self.scratch / f"{name}.{verb}.toml"
        if run([self.command, verb, recording, "--model", model, "--out", out, *more]) and out.exists():
            return out
        return None

    def judged(self, name, recording, truth, other, *more):
        """`more`: options of discover."""
        key = re.sub(r"\W+", "_", name)
        model = next((one for one in (recording / "model.toml", recording.parent / "rec" / "model.toml")
                      if one.exists()), None)
        if model is None:
            return None
        truth = truth or next((recording / file for file in ("truth.csv", "fixes.csv")
                               if (recording / file).exists()), None)
        if truth is None or not truth.exists():
            return None
        taught = self.model_by(key + ".other", "discover", other, model, *more) if other else None
        models = {"nominal": model,
                  "discover": self.model_by(key, "discover", recording, model, *more),
                  "calibrate": self.model_by(key, "calibrate", recording, model),
                  "other": taught}
        return {by: self.errors(f"{key}.{by}", recording, one, truth) for by, one in models.items()}

    def team(self, name, team, robot):
        """One of a public data set, which is converted first."""
        packed = self.data / "mrclam" / f"MRCLAM_Dataset{team}"
        plain = self.scratch / f"team{team}.{robot}"
        plain.mkdir(exist_ok=True)
        for file in packed.glob("*"):
            target = plain / (file.stem if file.suffix == ".xz" else file.name)
            with open(target, "wb") as out:
                subprocess.run(["xz", "-dc", str(file)] if file.suffix == ".xz" else ["cat", str(file)],
                               stdout=out, check=True)
        recording = self.scratch / f"recording{team}.{robot}"
        if not run([self.command, "convert", plain / f"Robot{robot}", recording]):
            return None
        return self.judged(name, recording, None, None, "--without", "truth")


def cell(errors):
    if not errors:
        return "–"
    return " / ".join("–" if one is None else f"{1e3 * one:.0f}" for one in errors)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("trussmap")
    parser.add_argument("data")
    parser.add_argument("judge")
    parser.add_argument("--only", default="", help="recordings whose name contains this")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--json")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(options, scratch)
        tasks = {}
        for name, recording, truth, other in RECORDINGS:
            place = [bench.data / one if one else None for one in (recording, truth, other)]
            if place[0].is_dir():
                tasks[name] = lambda name=name, place=place: bench.judged(name, *place)
        for name, team, robot in TEAMS:
            if (bench.data / "mrclam" / f"MRCLAM_Dataset{team}").is_dir():
                tasks[name] = lambda name=name, team=team, robot=robot: bench.team(name, team, robot)
        tasks = {name: task for name, task in tasks.items() if options.only in name}
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            waiting = {name: pool.submit(task) for name, task in tasks.items()}
            results = {name: one.result() for name, one in waiting.items()}
    results = {name: one for name, one in results.items() if one}
    print("| recording (mm after 10 s / 30 s) | nominal | discover | calibrate | discovered elsewhere |")
    print("|---|---|---|---|---|")
    for name, one in results.items():
        print(f"| {name} | " + " | ".join(cell(one[by]) for by in one) + " |")
    if options.json:
        Path(options.json).write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
