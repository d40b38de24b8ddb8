#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Hostile values for every key of a model or a map of a log, and every option that takes a number.

Usage: tests/sweep/values.py [--command build/trussmap] [--part models options maps] [--every 1]

Keys and options are those that the program itself names: in --help, and in what it expects in place of
an unknown key. Each run ends with status 0 and figures, or with 2 (1: no solution) and one line that
names file and line, or the option; within 20 s and 2 GB. Status 1: some did not.
"""
import argparse
import collections
import json
import pathlib
import re
import sys
import tempfile

from report_rules import walk
from running import Command, wrong_way_out

VALUES = ["0", "-0.0", "-1", "1e-320", "1e-300", "1e-12", "0.5", "3", "1e6", "1e12", "1e300", "1e308",
          "nan", "inf", "-inf", "", "99999999999999999999999", "9223372036854775807", "2147483648"]
LARGEST = 1e100  # a figure beyond is none
DRIVES = ["differential", "unicycle", "skid-steer", "tricycle", "ackermann", "omni3", "mecanum", "wheels"]
NUMERIC = re.compile(r"^  --([\w-]+) (X|N|K|S|LENGTH|LENGTHS|N\|\w[\w|]*|PORT|(?:X|N)(?:,(?:X|N|Y|YAW))+|"
                     r"X,X\.\.\.|N,N\.\.\.|NxN|TIME,\.\.\.|K/N)(?:=| |$)", re.M)


# What a refusal may speak of in place of the option: what comes of it.
COMES_OF = {"--sighting-noise": "apart", "--spacing": "apart", "--min-drive": "leg", "--true-k": "a turn",
            "--true-E-d": "wheel scale", "--scatter": "a turn"}


class Sweep:
    def __init__(self, trussmap, scratch, every):
        self.trussmap = trussmap
        self.scratch = scratch
        self.every = every
        self.turn = 0
        self.runs = 0
        self.statuses = collections.Counter()
        self.wrong = collections.Counter()

    def hold(self, arguments, named, own_file=None):
        """Runs it: what is `named` has to be named where it is refused."""
        self.turn += 1
        if self.turn % self.every:
            return
        self.runs += 1
        written = self.scratch / "figures.json"
        written.unlink(missing_ok=True)
        more = ["--json", written] if arguments[0] not in ("apply", "convert", "add", "fleet") else []
        ran = self.trussmap.run(*arguments, *more, cwd=self.scratch)
        self.statuses[ran.status] += 1
        what = wrong_way_out(ran) or self._wrong_with(ran, named, written, own_file)
        if what:
            self.wrong[what.split(":")[0]] += 1
            said = ran.err.strip().splitlines()
            given = f" with {own_file.read_text()!r}" if own_file else ""
            print(f"{what} | {' '.join(map(str, arguments))}{given} | {said[-1][:300] if said else ''}",
                  flush=True)

    def _wrong_with(self, ran, named, written, own_file):
        if ran.status == 2:
            line = ran.err.strip().splitlines()[-1]
            if own_file and not re.search(r"\w+\.(toml|csv)\b", line):
                return "names no file"
            words = [one for one in re.split(r"\W", named) if len(one) > 2]
            words += [said for option, said in COMES_OF.items() if named.startswith(option)]
            if not own_file and not re.search(r"\w+\.(toml|csv|g2o)\b", line) and not any(
                    one.rstrip("s") in line for one in words):
                return f"does not name {named}"
            return None
        odd = re.search(r"(?<![\w.-])[-+]?(nan|inf|infinity)(?![\w-])", ran.out, re.I)
        if odd and odd.group() not in " ".join(ran.arguments):
            return f"prints {odd.group()}: {ran.out[max(0, odd.start() - 60):odd.end() + 20]!r}"
        blank = re.search(r"(\+-|±)\s*(?![\s\d.])|(\+-|±)\s*$", ran.out, re.M)
        if blank:
            return "prints a blank figure"
        if written.exists():
            for path, value in walk(json.loads(written.read_text())):
                if isinstance(value, float) and abs(value) > LARGEST:
                    return f"writes {path} = {value:g}"
        return None


def sweep_options(sweep, inputs):
    calls = {
        "simulate": ["--mesh", "2x2", "--tours", 1, "--out", "out"],
        "tour": ["--mesh", "2x2", "--tours", 2, "--seeds", 1],
        "explore": ["--mesh", "2x2"],
        "umbmark": ["--simulate"], "tape": ["--simulate"], "noise": ["--simulate", "--path", "10,-10"],
        "adjust": [inputs.graph]}
    for name in ("build", "compare", "diagnose", "discover", "fit", "calibrate", "watch", "apply"):
        calls[name] = [inputs.recording, "--model", inputs.fitted if name == "fit" else inputs.model]
    calls["convert"] = [inputs.map, "out.yaml", "--tag-size", 0.1]
    calls["apply"] += ["--out", "poses.csv"]
    calls["fleet add"] = ["fleet.db", "R2", inputs.recording, "--model", inputs.model, "--replace"]
    calls["serve"] = [inputs.recording, "--model", inputs.model]
    for name, arguments in calls.items():
        words = name.split()
        told = sweep.trussmap.run(*words, "--help").out
        for option, kind in NUMERIC.findall(told):
            if name == "serve" and not kind.startswith("PORT"):
                continue
            for value in VALUES:
                given = value
                if "," in kind and "..." not in kind:
                    given = ",".join([value] * (kind.count(",") + 1))
                elif kind == "NxN":
                    given = f"{value}x{value}"
                extra = ["--maps", "maps"] if option == "maps-after" else []
                rest = [one for k, one in enumerate(arguments)
                        if one != f"--{option}" and (k == 0 or arguments[k - 1] != f"--{option}")]
                sweep.hold([*words, *rest, *extra, f"--{option}={given}"], f"--{option}")


def expected_keys(sweep, file, text, arguments):
    """The keys that the program expects in place of zzz."""
    file.write_text(text)
    line = sweep.trussmap.run(*arguments, cwd=sweep.scratch).err.strip().splitlines()[-1]
    names = line.rsplit("expected ", 1)[-1].removeprefix("one of ").replace(" or ", ", ")
    return [one.strip() for one in names.split(",") if one.strip().isidentifier()]


def model_lines(sweep, inputs, file):
    """Every key of a model with what must stand around it: text before, key, text after."""
    arguments = ["apply", inputs.recording, "--model", file, "--out", "poses.csv"]
    keys = lambda text: expected_keys(sweep, file, text, arguments)
    base = '[robot]\nwheelbase = 0.34\n'
    tables = {"columns", "sensor", "antenna", "tracked", "scanner", "wheel", "matrix", "drive", "process"}
    for drive in DRIVES:
        head = f'[robot]\ndrive = "{drive}"\n' + columns_of(inputs.of_drive(drive))
        needed = {"skid-steer": ["wheelbase"], "tricycle": ["length"], "ackermann": ["length"],
                  "omni3": ["radius"], "mecanum": ["wheelbase", "length"]}.get(drive, [])
        for key in keys(head + "zzz = 1\n"):
            if key not in tables:
                others = "".join(f"{one} = 0.3\n" for one in needed if one != key)
                yield drive, head + others, key, ""
    for mounting in ("sensor", "antenna", "tracked", "scanner"):
        for key in keys(base + f"[robot.{mounting}]\nzzz = 1\n"):
            yield "differential", base + f"[robot.{mounting}]\n", key, ""
    wheel = '[[robot.wheel]]\ncolumn = "wheel1"\n'
    rest = "".join(f'[[robot.wheel]]\ncolumn = "wheel{k}"\nx = {x}\ny = {y}\ndirection = {d}\n'
                   for k, x, y, d in ((2, 0.1, -0.1, 2.4), (3, -0.1, 0.1, 2.4), (4, -0.1, -0.1, 0.8)))
    for key in keys('[robot]\ndrive = "wheels"\n' + wheel + "zzz = 1\n"):
        if key != "column":
            others = "".join(f"{one} = 0.1\n" for one in ("x", "y", "direction") if one != key)
            yield "wheels", '[robot]\ndrive = "wheels"\n' + wheel + others, key, rest
    for key in keys(base + "[noise]\nzzz = 1\n"):
        if key != "process":
            yield "differential", base + "[noise]\n", key, ""
            if key in ("left", "right", "steer"):
                yield "ackermann", '[robot]\ndrive = "ackermann"\nlength = 0.5\n[noise]\n', key, ""
    process = '[[noise.process]]\n'
    for kind in keys(base + process + 'channel = "turn"\nprocess = "zzz"\nsd = 1\n') or [
            "white", "per leg", "correlated in t", "correlated in distance", "walk in t"]:
        for key in ("sd", "length", "tails"):
            if key == "length" and "correlated" not in kind:
                continue
            others = "".join(f"{one} = {size}\n" for one, size in
                             (("sd", 0.01), ("length", 2.0)) if one != key and
                             (one != "length" or "correlated" in kind))
            yield "differential", base + process + f'channel = "turn"\nprocess = "{kind}"\n' + others, \
                key, ""
    for channel in channels_of(sweep, file, arguments):
        effect = f'[[effect]]\nname = "own"\nchannel = "{channel}"\nshape = ["1"]\n'
        yield "differential", base + effect, "coefficients", ""
        process = f'[[noise.process]]\nchannel = "{channel}"\nprocess = "per leg"\n'
        yield "differential", base + process, "sd", ""


def columns_of(recording):
    """The line of the recording's own model that names its wheels, if there is one."""
    lines = (recording / "model.toml").read_text().splitlines()
    return "".join(line + "\n" for line in lines if line.startswith("columns ="))


def channels_of(sweep, file, arguments):
    return expected_keys(sweep, file, '[robot]\nwheelbase = 0.34\n[[effect]]\nname = "own"\n'
                         'channel = "zzz"\nshape = ["1"]\n', arguments)


def sweep_models(sweep, inputs):
    file = sweep.scratch / "swept.toml"
    commands = ["build", "compare", "diagnose", "calibrate", "watch", "fit", "check", "apply --adjusted",
                "discover", "build --method elastic"]
    turn = 0
    for drive, before, key, after in list(model_lines(sweep, inputs, file)):
        for value in VALUES:
            given = f"[{value}]" if key == "coefficients" else value
            file.write_text(f"{before}{key} = {given}\n{after}")
            recording = inputs.of_drive(drive)
            sweep.hold(["apply", recording, "--model", file, "--out", "poses.csv"], key, file)
            for _ in (0, 1):
                turn += 1
                words = commands[turn % len(commands)].split()
                sweep.hold([words[0], recording, "--model", file, *words[1:]], key, file)


LOG = {"wheels.left": ['field = "l"'], "wheels.right": ['field = "r"'], "heading": ['field = "h"'],
       "yaw_rate": ['field = "g"'], "truth": ['x = "x"', 'y = "y"', 'heading = "h"'],
       "fixes": ['x = "x"', 'y = "y"'], "odometry": ['x = "x"', 'y = "y"', 'heading = "h"'],
       "time": ['field = "t"'], "rows": [], "robot": ["wheelbase = 0.34"],
       "[sightings]": ['landmark = "m"', 'range = "d"', 'bearing = "b"'],
       "survey.landmarks": ["A = [1, 2]"], "covariates": []}


def log_map(section, line):
    """A map of the log with one more line in a section."""
    parts = dict(LOG)
    parts.pop("odometry" if section != "odometry" else "wheels.left")
    if section == "odometry":
        parts.pop("wheels.right")
    parts.setdefault(section, [])
    text = ""
    for name, lines in parts.items():
        own = [*lines, line] if name == section else lines
        if line and name == section:
            key = line.split(" =")[0]
            own = [one for one in lines if not one.startswith(key + " =")] + [line]
        if own:
            text += f"[{name}]\n" + "\n".join(own) + "\n"
    return text


def sweep_maps(sweep, inputs):
    log, file = sweep.scratch / "log.csv", sweep.scratch / "swept-map.toml"
    rows = "".join(f"{k / 5},{k * 0.1},{k * 0.11},{k * 0.1},0,{k * 0.01},0.05,{'AB'[k % 2]},2,0.1\n"
                   for k in range(60))
    log.write_text("t,l,r,x,y,h,g,m,d,b\n" + rows)
    arguments = ["convert", log, "converted", "--map", file]
    for section in LOG:
        keys = expected_keys(sweep, file, log_map(section, "zzz = 1"), arguments)
        for key in keys:
            for value in VALUES:
                file.write_text(log_map(section, f"{key} = {value}"))
                sweep.hold(arguments, key, file)


class Inputs:
    """Recordings with all that a recording may have, for each drive; a model, a map, a graph."""

    def __init__(self, trussmap, scratch):
        self.scratch = scratch
        self.trussmap = trussmap
        self.made = {}
        self.recording = self.of_drive("differential")
        self.model = self.recording / "model.toml"
        self.fitted, self.map, self.graph = (scratch / name for name in ("e.toml", "m.graphml", "g.g2o"))
        trussmap.run("add", self.model, "wheelbase", "--out", self.fitted)
        for out in (self.map, self.graph):
            trussmap.run("build", self.recording, "--model", self.model, "--out", out)

    def of_drive(self, drive):
        if drive not in self.made:
            folder = self.scratch / drive
            ran = self.trussmap.run("simulate", "--mesh", "2x2", "--spacing", 2, "--tours", 2, "--drive",
                                    drive, "--gyro", "--range-sensor", "--fixes", 0.5, "--loops",
                                    "--markers", "--out", folder)
            assert ran.status == 0, ran.err
            self.made[drive] = folder
        return self.made[drive]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default="build/trussmap", type=pathlib.Path)
    parser.add_argument("--part", nargs="+", default=["models", "options", "maps"])
    parser.add_argument("--every", type=int, default=1, help="take one run in so many")
    options = parser.parse_args()
    trussmap = Command(options.command, seconds=20)
    with tempfile.TemporaryDirectory() as temporary:
        sweep = Sweep(trussmap, pathlib.Path(temporary), options.every)
        inputs = Inputs(trussmap, pathlib.Path(temporary))
        parts = {"models": sweep_models, "options": sweep_options, "maps": sweep_maps}
        for part in options.part:
            before = sweep.runs
            parts[part](sweep, inputs)
            print(f"{part}: {sweep.runs - before} runs")
            if sweep.runs - before < 300 // options.every:
                sweep.wrong["hardly anything was swept"] += 1
    print(f"statuses {dict(sweep.statuses)}, wrong {json.dumps(sweep.wrong)}")
    return 1 if sweep.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
