#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Commands over inputs that were damaged at random, end to end.

Usage: tests/sweep/mutations.py [--command build/trussmap] [--runs 20000] [--seed 1]
                                [--inputs ../shared/data/reports] [--keep DIR]

Bytes, numbers, fields and lines of recordings, models, graphs, maps and logs are changed. Each run has to
end by itself, within 180 s of processor and 2 GB, with status 0, 1 or 2, and where it refuses with one
line in words of its own. What fails is kept in DIR. Status 1: something did.
"""
import argparse
import collections
import json
import pathlib
import random
import shutil
import sys
import tempfile

from running import Command, wrong_way_out

TOP = pathlib.Path(__file__).resolve().parents[2]
NUMBERS = [b"0", b"-0.0", b"-1", b"1e-320", b"1e308", b"nan", b"inf", b"", b"99999999999999999999", b"1e9",
           b"0x10", b"1,5", b"2147483648", b"1e-9"]
LARGEST = 60_000  # bytes of a file that is damaged


def damaged(data, draw):
    """The bytes with one change."""
    kind = draw.randrange(9)
    lines = data.split(b"\n")
    line = draw.randrange(len(lines))
    at = draw.randrange(len(data) + 1)
    if kind == 0 and data:  # a byte
        at = min(at, len(data) - 1)
        return data[:at] + bytes([draw.randrange(256)]) + data[at + 1:]
    if kind == 1:  # cut off
        return data[:at]
    if kind == 2:  # a line twice, or somewhere else
        lines.insert(draw.randrange(len(lines) + 1), lines[line])
    elif kind == 3:
        del lines[line]
    elif kind == 4:  # a number, or another field
        separator = next((one for one in (b",", b" ", b"=", b"\t") if one in lines[line]), b" ")
        fields = lines[line].split(separator)
        fields[draw.randrange(len(fields))] = draw.choice(NUMBERS)
        lines[line] = separator.join(fields)
    elif kind == 5:  # fields exchanged in all lines
        rows = [one.split(b",") for one in lines]
        one, other = (draw.randrange(max(1, len(rows[0]))) for _ in (0, 1))
        for row in rows:
            if max(one, other) < len(row):
                row[one], row[other] = row[other], row[one]
        lines = [b",".join(row) for row in rows]
    elif kind == 6:  # a piece once more
        end = min(len(data), at + draw.choice([1, 10, 1000]))
        return data[:end] + data[at:end] * draw.choice([1, 3, 50]) + data[end:]
    elif kind == 7:  # two lines exchanged
        other = draw.randrange(len(lines))
        lines[line], lines[other] = lines[other], lines[line]
    else:  # what no text has
        return data[:at] + draw.choice([b"\0", b"\xff\xfe", b"\r", b"\"", b"[[", b"#", b"\x1b[2J"]) + data[at:]
    return b"\n".join(lines)


class Inputs:
    """Folders of recordings, and files by what reads them."""

    def __init__(self, folder, trussmap, scratch):
        self.recordings = [one.parent for one in sorted(folder.rglob("drive.csv"))] if folder else []
        self.graphs = sorted(folder.rglob("*.g2o")) if folder else []
        self.tables = sorted(folder.rglob("tables/*.csv")) if folder else []
        corpus = TOP / "tests/fuzz/corpus"
        self.others = [one for kind in ("g2o", "graphml", "mcap", "rosbag2", "logmap", "roadrunner", "wpilog",
                                        "ros1", "model") for one in sorted((corpus / kind).glob("*"))]
        self.runs = scratch / "squares.csv"
        trussmap.run("umbmark", "--simulate", "--scatter", 0.01, "--write", self.runs)
        for seed in (1, 2, 3):
            made = scratch / f"made{seed}"
            more = [["--range-sensor", "--gyro"], ["--fixes", 1, "--loops"], ["--markers"]][seed - 1]
            trussmap.run("simulate", "--mesh", "2x2", "--spacing", 2, "--tours", 1, "--seed", seed, *more,
                         "--out", made)
            self.recordings.append(made)
        self.map = scratch / "map.graphml"
        trussmap.run("build", self.recordings[-1], "--model", self.recordings[-1] / "model.toml", "--out",
                     self.map)


def hurt_file(path, draw):
    data = path.read_bytes()
    if len(data) > LARGEST:
        return
    for _ in range(draw.choice([1, 1, 2, 5])):
        data = damaged(data, draw)
    path.write_bytes(data)


def call_over(inputs, draw, place):
    """Damages a copy of an input in `place` and says how it is to be read."""
    kind = draw.choices(["recording", "graph", "table", "other", "runs", "map"], [60, 10, 5, 12, 5, 8])[0]
    if kind == "recording" or not (inputs.graphs and inputs.tables):
        folder = place / "recording"
        shutil.copytree(draw.choice(inputs.recordings), folder)
        files = [one for one in sorted(folder.iterdir()) if one.suffix in (".csv", ".toml")]
        hurt_file(draw.choice(files), draw)
        name = draw.choice(["check", "check", "build", "build", "apply", "watch", "calibrate", "compare",
                            "diagnose"])
        model = ["--model", folder / "model.toml"]
        return [name, folder, *model, *(["--out", place / "poses.csv"] if name == "apply" else [])]
    source = {"graph": lambda: draw.choice(inputs.graphs), "table": lambda: draw.choice(inputs.tables),
              "other": lambda: draw.choice(inputs.others), "runs": lambda: inputs.runs,
              "map": lambda: inputs.map}[kind]()
    suffix = source.suffix or {"graphml": ".graphml", "g2o": ".g2o", "mcap": ".mcap", "rosbag2": ".db3",
                               "logmap": ".toml", "wpilog": ".wpilog", "ros1": ".bag", "model": ".toml",
                               "roadrunner": ".log"}.get(source.parent.name, ".g2o")
    file = place / ("input" + suffix)
    shutil.copy(source, file)
    hurt_file(file, draw)
    if kind == "runs":
        return ["umbmark", file, "--wheelbase", 0.34]
    if suffix == ".toml":
        return ["convert", inputs.recordings[0] / "drive.csv", place / "out", "--map", file]
    if suffix == ".g2o" and draw.random() < 0.7:
        return [draw.choice(["check", "adjust"]), file]
    if suffix in (".g2o", ".graphml"):
        return ["convert", file, place / "out.geojson"]
    return ["convert", "--inspect", file, "--map", place / "map.toml"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default="build/trussmap", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--inputs", type=pathlib.Path, default=TOP.parent / "shared/data/reports")
    parser.add_argument("--keep", type=pathlib.Path)
    options = parser.parse_args()
    trussmap = Command(options.command, seconds=180)
    statuses, wrong = collections.Counter(), collections.Counter()
    with tempfile.TemporaryDirectory() as temporary:
        scratch = pathlib.Path(temporary)
        inputs = Inputs(options.inputs if options.inputs.is_dir() else None, trussmap, scratch)
        for number in range(options.seed, options.seed + options.runs):
            place = scratch / "run"
            place.mkdir()
            ran = trussmap.run(*call_over(inputs, random.Random(number), place), cwd=place)
            statuses[ran.status] += 1
            what = wrong_way_out(ran)
            if what:
                wrong[what.split(":")[0]] += 1
                print(f"run {number}, {what} | {' '.join(ran.arguments)} | {ran.err.strip()[-200:]}", flush=True)
                if options.keep:
                    shutil.copytree(place, options.keep / str(number), dirs_exist_ok=True)
            shutil.rmtree(place)
    print(f"{options.runs} runs, statuses {dict(statuses)}, wrong {json.dumps(wrong)}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
