# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""The command `trussmap`, its recordings cut in time, and effects as text: what the scripts beside this one share."""
import csv
import json
import os
import pathlib
import subprocess
import tempfile

COMMAND = pathlib.Path(__file__).resolve().parents[2] / "build" / "trussmap"


class Refused(Exception):
    """The command would not do it; the message is its own last line."""


class Program:
    def __init__(self, path=COMMAND, seconds=600):
        self.path = pathlib.Path(path).resolve()
        self.seconds = seconds  # a run may take
        self.environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")

    def run(self, *arguments):
        try:
            ran = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True,
                                 env=self.environment, timeout=self.seconds)
        except subprocess.TimeoutExpired:
            raise Refused(f"longer than {self.seconds} s") from None
        if ran.returncode not in (0, 1):
            raise Refused((ran.stderr.strip().splitlines() or ["no word of why"])[-1])
        return ran.stdout

    def json(self, *arguments):
        """What --json writes; the exit status 1 of a run that failed leaves no file."""
        with tempfile.TemporaryDirectory() as scratch:
            file = pathlib.Path(scratch) / "out.json"
            self.run(*arguments, "--json", file)
            if not file.is_file():
                raise Refused("failed: " + " ".join(map(str, arguments)))
            return json.loads(file.read_text())


def read_csv(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


def cut(source, target, until):
    """The recording `source` up to `until` [s], in the new folder `target`."""
    target.mkdir(parents=True, exist_ok=True)
    for file in source.iterdir():
        text = file.read_text()
        if file.name in ("drive.csv", "sightings.csv", "fixes.csv", "loops.csv"):
            lines = text.splitlines(keepends=True)
            times = [k for k, name in enumerate(lines[0].strip().split(",")) if name in ("t", "t2")]
            kept = lines[:1]
            for line in lines[1:]:
                cells = line.split(",")
                if all(float(cells[k]) <= until for k in times):
                    kept.append(line)
            text = "".join(kept)
        (target / file.name).write_text(text)


def is_formula(text):
    channel, times, _ = text.partition(" x ")
    return bool(times) and channel.replace("_", "").isalnum()


def effect_of(text, coefficients=()):
    """An effect from a catalogue name, or from `channel x shape; shape`."""
    effect = {"name": text, "coefficients": list(coefficients)}
    if is_formula(text):
        channel, _, shapes = text.partition(" x ")
        effect |= {"channel": channel, "shape": [one.strip() for one in shapes.split(";")]}
    return effect


def text_of(channel, shapes):
    return f"{channel} x {'; '.join(shapes)}"


def model_text(effects, base=""):
    """TOML of these effects, after the text of a model."""
    text = base if not base or base.endswith("\n") else base + "\n"
    for one in effects:
        text += f'\n[[effect]]\nname = {json.dumps(one["name"])}\n'
        if one.get("channel"):
            text += f'channel = "{one["channel"]}"\nshape = {json.dumps(one["shape"])}\n'
        if one.get("coefficients"):
            text += f'coefficients = {json.dumps([float(c) for c in one["coefficients"]])}\n'
    return text


def numbers_of(text):
    """1..200 of `1..200`, or of one number."""
    first, _, last = text.partition("..")
    return range(int(first), int(last or first) + 1)
