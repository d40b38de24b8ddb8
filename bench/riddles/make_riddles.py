#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Makes the riddles: recordings by seed whose truth lies in a folder of its own. README.md has the rules.

Usage: make_riddles.py OUT [--command build/trussmap] [--only KIND] [--seeds 1..200] [--jobs 1]
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import shutil
import sys
import tempfile

import kinds
from program import COMMAND, Program, Refused, cut, effect_of, model_text, numbers_of, read_csv

FIRST_SEED = 771000  # of riddle N: this + N
DETECTABLE = 24.4  # expected score of the smallest detectable effect: 90 % power at p = 0.05/200
TIMES = 3.0  # an effect's size, in smallest detectable ones
TIMES_ROUGH = 5.0  # the same where noise is rough
APART = 0.9  # effects of one riddle have cosines below this
GROSS = 0.02  # to this size gross constants are scaled where traces are compared


def kind_of_numbers():
    """Which kind each number is, mixed so that numbers tell nothing; and its turn within the kind."""
    listed = [(kind, turn) for kind, count in kinds.KINDS.items() for turn in range(count)]
    random.Random(2026).shuffle(listed)
    return dict(enumerate(listed, start=1))


def classes_of(kind, rough):
    """What the answer may be called."""
    if not kind.startswith("none"):
        return ["effect", "gross constant"]
    if not rough:
        return ["nothing"]
    # Noise that lasts a second or two, or has tails, may be as large over a leg as the model says.
    return ["noise"] if set(rough.split(",")) & {"half", "floor"} else ["noise", "nothing"]


class Riddle:
    def __init__(self, program, number, out, scratch):
        self.program, self.number, self.out, self.scratch = program, number, out, pathlib.Path(scratch)
        self.kind, self.turn = kind_of_numbers()[number]

    def simulate(self, folder, effects, *more):
        """All tours, of which the last is held out; how long they take [s]."""
        file = self.scratch / "effects.toml"
        file.write_text(model_text(effects, self.model if effects else ""))  # whose [robot] says what is of its drive
        hidden = ["--effects", file] if effects else []
        told = self.program.json("simulate", *self.arguments, *hidden, *more, "--out", folder)
        return told["duration_s"]

    def twin(self, effects):
        """The part that the riddle shows without noise, with these effects alone."""
        whole, shown = self.scratch / "whole", self.scratch / "shown"
        self.simulate(whole, effects, "--noise-free")
        cut(whole, shown, self.until)
        return shown

    def unexplained(self, twin, effect=None):
        """chi2 of a twin: the square of its trace, in standard deviations; or what an effect leaves of it when fitted."""
        model = self.scratch / "model.toml"
        model.write_text(model_text([effect] if effect else [], self.model))
        told = self.program.json("fit" if effect else "compare", twin, "--model", model, "--gate", 0)
        return told["chi2"]

    def sized(self, text, draw, times):
        """The effect with coefficients that show so many times the smallest detectable; None where it cannot be."""
        effect = effect_of(text)
        shapes = len(effect.get("shape", [])) or self.shapes(text)
        direction = [draw.gauss(0.0, 1.0) for _ in range(shapes)]
        if self.channels.get(text, effect.get("channel")) == "advance":
            direction = [-abs(one) for one in direction]  # a loss is one
        scale = 0.01 / math.hypot(*direction)
        wanted = times * times * DETECTABLE
        for _ in range(6):
            effect["coefficients"] = [scale * one for one in direction]
            shown = self.unexplained(self.twin([effect]))
            if abs(shown / wanted - 1.0) < 0.1:
                largest = max(map(abs, effect["coefficients"]))
                return {**effect, "chi2": shown} if largest < 1.0 else None
            if shown < 1e-6 * wanted and scale > 1.0:
                return None
            scale *= min(math.sqrt(wanted / max(shown, 1e-9)), 1e3)
            if scale * math.hypot(*direction) > 30.0:
                return None
        return None

    def shapes(self, name):
        return len(self.catalogue[name.partition(" (")[0]]["shape"])

    def alike(self, one, other):
        """Whether a trace of either could be taken for the other's."""
        for a, b in ((one, other), (other, one)):
            left = self.unexplained(self.twin([a]), {**b, "coefficients": []})
            if left < (1.0 - APART * APART) * a["chi2"]:
                return True
        return False

    def effects(self, draw, has, duration):
        """The hidden effects; None where this world shows too few."""
        if self.kind.startswith("none"):
            return []
        if self.kind == "gross":
            found = []
            for name in kinds.constants(draw, has)[: draw.choice([1, 1, 2])]:
                size = math.exp(draw.uniform(math.log(0.03), math.log(0.6)))
                found.append(effect_of(name, [round(draw.choice([-1.0, 1.0]) * size, 3)]))
            small = [{**one, "coefficients": [math.copysign(GROSS, one["coefficients"][0])]} for one in found]
            for one in small:
                one["chi2"] = self.unexplained(self.twin([one]))
            shown = all(one["chi2"] > DETECTABLE for one in small)
            return found if shown and (len(small) < 2 or not self.alike(*small)) else None
        wanted = {"double": 2, "triple": 3}.get(self.kind, 1)
        texts = kinds.catalogue(draw, has)
        if self.kind == "off-catalogue" or (self.kind == "rough" and draw.random() < 0.3):
            texts = kinds.formulas(draw, has, duration)
        times = TIMES_ROUGH if self.kind == "rough" else TIMES
        found = []
        for text in texts[:12]:
            try:
                one = self.sized(text, draw, times)
            except Refused:
                continue  # this robot cannot have it
            if one and not any(self.alike(one, other) for other in found):
                found.append(one)
            if len(found) == wanted:
                return found
        return None

    def make(self):
        listed = self.program.json("effects")["effects"]
        self.catalogue = {one["name"].partition(" (")[0]: one for one in listed}
        self.channels = {one["name"]: one["channel"] for one in listed}
        for attempt in range(20):
            seed = FIRST_SEED + self.number + 1000 * attempt
            draw = random.Random(seed)
            arguments, has = kinds.world(draw, self.turn)
            self.arguments = arguments + ["--tours", str(has["tours"] + 1), "--seed", str(seed)]
            plain = self.scratch / "plain"
            duration = self.simulate(plain, [])
            self.model = (plain / "model.toml").read_text()
            stops = sorted({float(one["t"]) for one in read_csv(plain / "sightings.csv")
                            if not one.get("range") and not one.get("bearing")})
            self.until = stops[len(stops) * has["tours"] // (has["tours"] + 1)]
            effects = self.effects(draw, has, duration * has["tours"] / (has["tours"] + 1))
            if effects is not None:
                rough = draw.choice(kinds.rough(has)) if "rough" in self.kind else ""
                self.write(seed, has, effects, rough)
                return seed
        raise Refused(f"riddle {self.number}: no world of 20 shows what it is to hide")

    def write(self, seed, has, effects, rough):
        name = f"{self.number:03d}"
        held_out = self.out / "heldout" / name
        for folder in (held_out, self.out / "riddles" / name):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
        self.simulate(held_out / "noisy", effects, *(["--rough", rough] if rough else []))
        self.simulate(held_out / "clean", effects, "--noise-free")
        cut(held_out / "noisy", self.out / "riddles" / name, self.until)
        truth = {"riddle": name, "kind": self.kind, "classes": classes_of(self.kind, rough), "seed": seed,
                 "until_s": self.until, "robot": has, "rough": rough, "effects": effects,
                 "simulate": self.arguments}
        (self.out / "truth").mkdir(exist_ok=True)
        (self.out / "truth" / f"{name}.json").write_text(json.dumps(truth, indent=1) + "\n")


def make(path, number, out):
    with tempfile.TemporaryDirectory() as scratch:
        return number, Riddle(Program(path), number, out, scratch).make()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--command", default=COMMAND)
    parser.add_argument("--only", choices=list(kinds.KINDS), help="riddles of this kind alone")
    parser.add_argument("--seeds", default="1..200", help="numbers of the riddles, like 1..20")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    numbers = [n for n in numbers_of(options.seeds)
               if not options.only or kind_of_numbers()[n][0] == options.only]
    options.out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for number, seed in pool.map(lambda n: make(options.command, n, options.out), numbers):
            print(f"{number:03d}: seed {seed}", file=sys.stderr)


if __name__ == "__main__":
    main()
