# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Ten bags, an effect hidden in each: is it found with the map.toml that --inspect writes?

    python3 bench/hidden_bags.py build/trussmap [SCRATCH]

Each bag is written by tests/logs/bags (not by trussmap), out of a simulated recording; `convert` and
`discover` have it and the first map.toml alone, with the lines changed that are listed. Needs
python3-lz4 and python3-zstandard.
"""

import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
WRITER = os.path.join(HERE, "..", "tests", "io", "bags", "recording_as_logs.py")

# name, simulate's options, the writer's, lines to change as (from, to)
BAGS = [
    ("hard iron", ["--effect", "hard iron=0.05,0.02"], [], []),
    ("wheelbase", ["--no-compass", "--effect", "wheelbase=0.03"], ["--style", "odometry"],
     [('# survey.file = "survey.csv"', 'survey.file = "sim/survey.csv"')]),
    ("wheel diameter ratio", ["--range-sensor", "--effect", "wheel diameter ratio=0.01"], [], []),
    ("gyro bias", ["--gyro", "--no-compass", "--effect", "gyro bias=0.002"], [], []),
    ("sighting delay", ["--effect", "sighting delay=0.15"],
     ["--style", "odometry"], []),
    ("load on one wheel (payload_kg)", ["--effect", "load on one wheel (payload_kg)=-0.0015"], [],
     []),
    ("turn scrub", ["--no-compass", "--full-turns", "6", "--effect", "turn scrub=-0.06"], [], []),
    ("compass lag", ["--effect", "compass lag=0.2"], ["--style", "odometry"], []),
    ("antenna ahead of the axle", ["--fixes", "2", "--effect", "antenna ahead of the axle=0.25"],
     [], []),
    ("twist per spin", ["--no-compass", "--effect", "twist per spin=0.03"], ["--compression", "lz4"],
     []),
]


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def main():
    trussmap = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as scratch:
        scratch = sys.argv[2] if len(sys.argv) > 2 else scratch
        right = 0
        for number, (effect, simulated, written, changes) in enumerate(BAGS):
            folder = os.path.join(scratch, str(number))
            names = {name: os.path.join(folder, name)
                     for name in ("sim", "drive.mcap", "map.toml", "rec", "fitted.toml")}
            os.makedirs(folder, exist_ok=True)
            if os.path.exists(names["map.toml"]):
                os.remove(names["map.toml"])
            run(trussmap, "simulate", "--mesh", "5x5", "--tours", "3", "--seed", str(100 + number),
                *simulated, "--out", names["sim"])
            run("/usr/bin/python3", WRITER, names["sim"], folder, "--only", "mcap", *written)
            run(trussmap, "convert", "--inspect", names["drive.mcap"], "--map", names["map.toml"])
            with open(names["map.toml"], encoding="utf-8") as file:
                text = file.read()
            for before, after in changes:
                if before not in text:
                    sys.exit(f"{names['map.toml']} has no line {before}")
                text = text.replace(before, after)
            with open(names["map.toml"], "w", encoding="utf-8") as file:
                file.write(text)
            run(trussmap, "convert", names["drive.mcap"], names["rec"], "--map", names["map.toml"])
            out = run(trussmap, "discover", names["rec"], "--model",
                      os.path.join(names["rec"], "model.toml"), "--out", names["fitted.toml"])
            with open(names["fitted.toml"], encoding="utf-8") as file:
                found = re.findall(r"\[\[effect\]\]\nname = \"(.*)\"", file.read())
            good = found == [effect]
            right += good
            print(f"{'right' if good else 'WRONG':5}  {effect:32} {len(changes)} lines changed; "
                  f"found {', '.join(found) or 'nothing'}", flush=True)
            if not good:
                print(out)
        print(f"{right} of {len(BAGS)}")


if __name__ == "__main__":
    main()
