# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Small recordings of simulated robots, drawn by a seed: other drives, sensors, effects, noise, and
what people do to recordings (exchanged columns, other units, lost files)."""
import csv
import math
import random

DRIVES = ["differential"] * 6 + ["unicycle", "skid-steer", "tricycle", "ackermann", "omni3", "mecanum",
                                 "wheels"]
SIZES = {"": (0.003, 0.08), "m": (0.005, 0.08), "rad": (0.005, 0.15), "rad/s": (0.0003, 0.005),
         "s": (0.02, 0.4), "s^2/m": (0.005, 0.05), "s/m": (0.005, 0.08), "m/rad": (0.001, 0.02),
         "s/rad": (0.01, 0.1), "rad/s^2": (1e-6, 1e-5), "rad s/m": (0.01, 0.1)}
OF_A_DRIVE = ("steer", "read", "radius of wheel", "scanner", "antenna", "truth", "fix delay", "roller")


class World:
    """A recording in `folder`; `arguments` made it, `known` says what the robot has."""

    def __init__(self, trussmap, effects, seed, folder):
        self.seed = seed
        self.folder = folder
        self.random = random.Random(seed)
        self.known = {}
        self.arguments = self._arguments(effects)
        self.simulated = trussmap.run("simulate", *self.arguments, "--out", folder, "--json",
                                      f"{folder}.json")
        self.damage = self._damage(trussmap) if self.simulated.status == 0 else ""

    def _arguments(self, effects):
        draw = self.random
        chance = lambda share: draw.random() < share
        drive = draw.choice(DRIVES)
        arguments = ["--mesh", draw.choice(["2x2", "3x2", "3x3", "3x3", "4x3"]), "--spacing",
                     draw.choice([1, 2, 3, 5]), "--tours", draw.choice([1, 2, 2, 3]), "--seed",
                     self.seed, "--drive", drive, "--walk",
                     draw.choice(["euler", "face", "depth-first", "random"])]
        flags = {"--uneven": 0.3, "--rests": 0.3, "--gyro": 0.5, "--no-compass": 0.4, "--markers": 0.15,
                 "--true-rates": 0.1, "--no-survey": 0.5, "--loops": 0.2}
        arguments += [flag for flag, share in flags.items() if chance(share)]
        sensor = draw.choice([None, None, None, "--range-sensor", "--beacons", "--camera"])
        arguments += [sensor] if sensor else []
        if chance(0.25):
            arguments += ["--fixes", draw.choice([0.2, 1])]
        if chance(0.1):
            arguments += ["--scans", draw.choice([1, 2])]
        if chance(0.1):
            arguments += ["--antenna", "0.2,0.05"]
        if chance(0.2):
            arguments += ["--full-turns", 2]
        if chance(0.25):
            arguments += ["--wheel-noise", draw.choice([0.0003, 0.001, 0.01, 0.03])]
        if chance(0.15):
            arguments += ["--rough", draw.choice(["half", "memory", "haze", "tails", "floor", "all"])]
        elif chance(0.1):
            arguments += ["--noise-free"]
        self.known = {"gyro": "--gyro" in arguments, "compass": "--no-compass" not in arguments,
                      "survey": "--no-survey" not in arguments, "drive": drive}
        for _ in range(draw.choice([0, 0, 1, 1, 2])):
            arguments += ["--effect", self._effect(draw.choice(effects))]
        return arguments

    def _effect(self, effect):
        least, most = SIZES.get(effect["unit"], (0.003, 0.05))
        size = math.exp(self.random.uniform(math.log(least), math.log(most)))
        if self.random.random() < 0.1 and effect["name"] in ("wheelbase", "travel scale"):
            size = self.random.choice([0.4, 0.8])
        values = [self.random.choice([-1, 1]) * size for _ in effect["shape"]]
        return f"{effect['name']}={','.join(f'{one:.6g}' for one in values)}"

    def _rows(self, name, change):
        path = self.folder / name
        if not path.exists():
            return
        with open(path, newline="") as stream:
            rows = list(csv.DictReader(stream))
        if not rows:
            return
        rows = change(rows)
        with open(path, "w", newline="") as stream:
            writer = csv.DictWriter(stream, fieldnames=list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)

    def _damage(self, trussmap):
        """What happens to recordings on their way; most stay as they are."""
        draw = self.random
        kinds = {"": 12, "swap wheels": 1, "survey in mm": 1, "survey mirrored": 1, "half": 1,
                 "wrong label": 1, "few sightings": 1, "truth": 2, "truth in mm": 1, "truth mirrored": 1,
                 "twice": 1, "fixes mirrored": 1, "compass backwards": 1, "no sightings": 1}
        kind = draw.choices(list(kinds), list(kinds.values()))[0]

        def scale(rows, factor, *names):
            for row in rows:
                for name in names:
                    if row.get(name):
                        row[name] = repr(float(row[name]) * factor)
            return rows

        if kind == "swap wheels":
            self._rows("drive.csv", lambda rows: [
                {**row, "left": row["right"], "right": row["left"]} if "left" in row and "right" in row
                else row for row in rows])
        elif kind == "survey in mm":
            self._rows("survey.csv", lambda rows: scale(rows, 1000.0, "x", "y"))
        elif kind == "survey mirrored":
            self._rows("survey.csv", lambda rows: scale(rows, -1.0, "x"))
        elif kind == "fixes mirrored":
            self._rows("fixes.csv", lambda rows: scale(rows, -1.0, "x"))
        elif kind == "compass backwards":
            self._rows("drive.csv", lambda rows: scale(rows, -1.0, "heading"))
        elif kind == "half":
            factor = draw.choice([0.5, 2.0, 0.001])
            self._rows("drive.csv", lambda rows: scale(rows, factor, "left", "right"))
        elif kind == "wrong label":
            self._rows("sightings.csv", self._mislabelled)
        elif kind == "few sightings":
            self._rows("sightings.csv", lambda rows: rows[:draw.choice([2, 3, 5])])
        elif kind == "twice":
            self._rows("sightings.csv", lambda rows: [row for row in rows for _ in (0, 1)])
        elif kind.startswith("truth"):
            self._truth(trussmap, kind)
        elif kind == "no sightings" and (self.folder / "fixes.csv").exists():
            (self.folder / "sightings.csv").unlink()
        return kind

    def _mislabelled(self, rows):
        names = sorted({row["landmark"] for row in rows})
        for _ in range(self.random.choice([1, 2])):
            self.random.choice(rows)["landmark"] = self.random.choice(names)
        return rows

    def _truth(self, trussmap, kind):
        """Poses as adjusted stand in for a tracker's."""
        poses = self.folder / "poses.csv"
        done = trussmap.run("apply", self.folder, "--model", self.folder / "model.toml", "--adjusted",
                            "--out", poses)
        if done.status != 0:
            return
        factor = 1000.0 if kind == "truth in mm" else 1.0
        sign = -1.0 if kind == "truth mirrored" else 1.0
        with open(poses, newline="") as stream:
            rows = list(csv.DictReader(stream))[1::20]
        poses.unlink()
        with open(self.folder / "truth.csv", "w", newline="") as stream:
            writer = csv.writer(stream)
            writer.writerow(["t", "x", "y", "heading"])
            for row in rows:
                x, y, heading = (float(row[one]) for one in ("x", "y", "heading"))
                writer.writerow([row["t"], repr(factor * x), repr(factor * sign * y),
                                 repr(sign * heading)])
        if self.random.random() < 0.5 and (self.folder / "sightings.csv").exists():
            (self.folder / "sightings.csv").unlink()


def catalogue_of(trussmap, file):
    """Effects that simulate can draw for most drives, with unit and shapes."""
    import json
    trussmap.run("effects", "--json", file)
    with open(file) as stream:
        effects = json.load(stream)["effects"]
    return [one for one in effects if not one["column"] and not one["parameters"]
            and not any(word in one["name"] for word in OF_A_DRIVE)]
