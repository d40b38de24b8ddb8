#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Answers the riddles by `trussmap diagnose`, and sizes what it names by `trussmap fit`.

Usage: answer_trussmap.py OUT answers.csv [--command build/trussmap] [--seeds 1..200] [--jobs 1] [--keep DIR]

Beside answers.csv it writes answers.probabilities.csv: how likely diagnose calls each effect, for the score's
calibration. --keep has a folder for what diagnose printed and wrote, and for models.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import sys
import tempfile
import time

from program import COMMAND, Program, Refused, model_text, numbers_of, text_of

ANSWERS = ["riddle", "class", "effect", "coefficients", "alternatives", "seconds"]
PROBABILITIES = ["riddle", "effect", "alternatives", "probability"]
NAMED = ("missing", "negligible")  # a negligible one is there, and moves the robot by less than noise
GROSS = 0.03  # a constant that is off by more
LISTED = 0.05  # effects of other explanations are alternatives from this probability on


def written(one):
    return text_of(one["channel"], one["shape"])


def is_gross(constant):
    old, new = constant["old"], constant["new"]
    return old is not None and new is not None and abs(new - old) > GROSS * abs(old)


def alternatives_of(found, diagnosis):
    """What looks the same as a finding; with several explanations what stands in the others, too."""
    listed = [written(one) for one in found["indistinguishable_from"]]
    named = {written(one) for one in diagnosis["candidates"] if one["status"] in NAMED}
    for explanation in diagnosis["explanations"]:
        if explanation["probability"] >= LISTED and not explanation["named"]:
            listed += [written(one) for one in explanation["effects"]]
    return [one for one in dict.fromkeys(listed) if one not in named]


def fitted(program, folder, found, scratch):
    """Coefficients of all findings beside each other, from those that diagnose gives; these where a fit of all fails."""
    model, base = pathlib.Path(scratch) / "found.toml", (folder / "model.toml").read_text()
    model.write_text(model_text([{"name": one["effect"], **{key: one[key] for key in ("channel", "shape", "coefficients")}}
                                 for one in found], base))
    try:
        told = program.json("fit", folder, "--model", model)["effects"]
        return [one["coefficients"] for one in told]
    except Refused:
        return [one["coefficients"] for one in found]


def answer(program, out, number, keep):
    name = f"{number:03d}"
    folder = out / "riddles" / name
    with tempfile.TemporaryDirectory() as scratch:
        kept = keep or pathlib.Path(scratch)
        file = kept / f"{name}.json"
        begun = time.monotonic()
        try:
            (kept / f"{name}.txt").write_text(
                program.run("diagnose", folder, "--model", folder / "model.toml", "--json", file))
        except Refused as refused:
            print(f"{name}: {refused}", file=sys.stderr)
            return [[name, "cannot tell", "", "", "", f"{time.monotonic() - begun:.1f}"]], []
        seconds = f"{time.monotonic() - begun:.1f}"
        diagnosis = json.loads(file.read_text())
        found = [one for one in diagnosis["candidates"] if one["status"] in NAMED]
        if diagnosis["verdict"] != "missing" or not found:
            said = "noise" if diagnosis["noise_estimated"]["changed"] else "nothing"
            if diagnosis["verdict"] == "unexplained misfit":
                said = "cannot tell"
            return [[name, said, "", "", "", seconds]], []
        said = "gross constant" if any(map(is_gross, diagnosis["constants"])) else "effect"
        sizes = fitted(program, folder, found, scratch)
        rows = [[name, said, written(one), " ".join(f"{c:.6g}" for c in size),
                 " | ".join(alternatives_of(one, diagnosis)), seconds] for one, size in zip(found, sizes)]
        return rows, likelihoods(name, diagnosis)


def likelihoods(name, diagnosis):
    shapes = {one["effect"]: written(one) for one in diagnosis["candidates"]}
    rows = []
    for one in diagnosis["effect_probabilities"]:
        others = [shapes[other] for other in one["otherwise"] if other in shapes]
        rows.append([name, written(one), " | ".join(others), f"{one['probability']:.4f}"])
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("answers", type=pathlib.Path)
    parser.add_argument("--command", default=COMMAND)
    parser.add_argument("--seeds", default="1..200", help="numbers of the riddles, like 1..20")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path)
    options = parser.parse_args()
    if options.keep:
        options.keep.mkdir(parents=True, exist_ok=True)
    program = Program(options.command)
    numbers = [n for n in numbers_of(options.seeds) if (options.out / "riddles" / f"{n:03d}").is_dir()]
    likely = options.answers.with_suffix(".probabilities.csv")
    with open(options.answers, "w", newline="") as answers, open(likely, "w", newline="") as probable, \
            concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        write, write_likely = csv.writer(answers), csv.writer(probable)
        write.writerow(ANSWERS)
        write_likely.writerow(PROBABILITIES)
        for rows, probabilities in pool.map(lambda n: answer(program, options.out, n, options.keep), numbers):
            write.writerows(rows)
            write_likely.writerows(probabilities)
            answers.flush()
            probable.flush()


if __name__ == "__main__":
    main()
