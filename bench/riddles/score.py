#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Scores answers to the riddles. README.md has the format of answers and what counts as right.

Usage: score.py OUT answers.csv [--command build/trussmap] [--probabilities FILE] [--models DIR] [--seeds 1..200]
                [--csv table.csv] [--each each.csv] [--jobs 1]

Prints the table as Markdown. --csv writes it as CSV, --each a row per riddle, --models has a model NNN.toml for
each riddle whose held-out error is not that of the answer's own effects.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import sys
import tempfile

import held_out
from kinds import KINDS
from matching import Matcher
from program import COMMAND, Program, Refused, effect_of, model_text, numbers_of, read_csv

CLASSES = ["effect", "gross constant", "noise", "nothing", "cannot tell"]
LIKELY = 0.05  # effects that are called less likely are left out of the calibration
COLUMNS = ["riddle", "class", "effect", "coefficients", "alternatives"]


class BadAnswer(Exception):
    pass


def read_answers(file):
    """Rows by riddle: class, and effects with coefficients and alternatives."""
    with open(file, newline="") as stream:
        reader = csv.DictReader(stream)
        lacks = [one for one in COLUMNS[:3] if one not in (reader.fieldnames or [])]
        if lacks:
            raise BadAnswer(f"{file}:1: no column {lacks[0]}, expected {', '.join(COLUMNS)}")
        answers = {}
        for row in reader:
            at = f"{file}:{reader.line_num}"
            said = (row["class"] or "").strip()
            if said not in CLASSES:
                raise BadAnswer(f'{at}: class "{said}", expected one of {", ".join(CLASSES)}')
            try:
                name = f"{int(row['riddle']):03d}"
                coefficients = [float(one) for one in (row.get("coefficients") or "").split()]
            except (ValueError, TypeError):
                raise BadAnswer(f"{at}: riddle and coefficients are numbers, with spaces between") from None
            others = [one.strip() for one in (row.get("alternatives") or "").split(" | ") if one.strip()]
            answers.setdefault(name, []).append(
                {"class": said, "effect": (row["effect"] or "").strip(), "coefficients": coefficients,
                 "alternatives": others})
    return answers


def class_of(rows):
    said = [one["class"] for one in rows]
    for one in CLASSES:
        if one in said:
            return one
    return "no answer"


def held_out_error(program, out, truth, named, model, scratch):
    """Shares of what noise alone leaves: without any effect, and by the answer."""
    folder = out / "heldout" / truth["riddle"]
    base = (out / "riddles" / truth["riddle"] / "model.toml").read_text()
    texts = [model_text(truth["effects"], base), base, model or model_text(named, base)]
    try:
        return held_out.errors(program, folder, truth, texts, scratch)
    except Refused as refused:
        print(f"{truth['riddle']}: held out: {refused}", file=sys.stderr)
        return None, None


def found_of(matcher, truth, named, answered):
    """What the effects that are named show of the hidden ones."""
    pairs = matcher.pairs([one["effect"] for one in named])
    hits = [k for k, one in enumerate(pairs) if one is not None]
    whole = bool(truth["effects"]) and len(hits) == len(truth["effects"])
    hit = lambda k: named[pairs[k]]
    found = {"all found": whole, "false": len(named) - len(hits),
             "form right": whole and all(matcher.same_channel(k, hit(k)["effect"]) for k in hits),
             "size right": whole and all(matcher.right_size(k, hit(k)["effect"], hit(k)["coefficients"]) for k in hits)}
    if truth["kind"] == "gross" and not whole and 0 < len(named) <= len(truth["effects"]) and \
            matcher.together([one["effect"] for one in named]):
        sized = len(answered) == len(named) and matcher.together_sized(answered)
        found |= {"all found": True, "false": 0, "size right": sized}
    return found


def score_one(program, out, truth, rows, models):
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        said = class_of(rows)
        named = [one for one in rows if one["effect"] and one["class"] in ("effect", "gross constant")]
        answered = [effect_of(one["effect"], one["coefficients"]) for one in named if one["coefficients"]]
        matcher = Matcher(program, out, truth, scratch)
        score = {"riddle": truth["riddle"], "kind": truth["kind"], "said": said,
                 "class right": said in truth["classes"], **found_of(matcher, truth, named, answered)}
        listed = [text for one in rows for text in [one["effect"], *one["alternatives"]] if text]
        score["listed"] = score["all found"] or (bool(listed) and bool(truth["effects"]) and all(
            any(matcher.shows(k, text) for text in listed) for k in range(len(truth["effects"]))))
        model = models / f"{truth['riddle']}.toml" if models else None
        score["before"], score["left"] = held_out_error(
            program, out, truth, answered, model.read_text() if model and model.is_file() else "", scratch)
        return score


def calibration(program, out, truths, file):
    """How often effects are true of those that were called so likely, by tenths."""
    tenths = [[0, 0.0, 0] for _ in range(10)]
    rows = {}
    for one in read_csv(file):
        rows.setdefault(one["riddle"], []).append(one)
    for truth in truths:
        with tempfile.TemporaryDirectory() as scratch:
            matcher = Matcher(program, out, truth, pathlib.Path(scratch))
            for one in rows.get(truth["riddle"], []):
                said = float(one["probability"])
                if said < LIKELY:
                    continue
                alike = [text for text in one["alternatives"].split(" | ") if text]
                right = any(matcher.any_shows(k, one["effect"], alike) for k in range(len(truth["effects"])))
                tenth = tenths[min(9, max(0, int(10.0 * said)))]
                tenth[0] += 1
                tenth[1] += said
                tenth[2] += right
    return [(n, said / n, right) for n, said, right in tenths if n]


def quantile(values, share):
    values = sorted(values)
    return values[round(share * (len(values) - 1))] if values else None


def table(scores):
    """A row per kind, then all: counts, and held-out errors where there is an effect that moves the robot."""
    rows = []
    for kind in [*KINDS, "all"]:
        those = [one for one in scores if kind in (one["kind"], "all")]
        if not those:
            continue
        moved = [one for one in those if one["left"] is not None and one["before"] > held_out.MOVES]
        count = lambda key: sum(bool(one[key]) for one in those)
        rows.append({
            "kind": kind, "riddles": len(those), "class right": count("class right"),
            "all found": count("all found"), "form right": count("form right"), "size right": count("size right"),
            "one too many": count("false"), "all listed": count("listed"),
            "cannot tell": sum(one["said"] == "cannot tell" for one in those),
            "of these listed": sum(one["said"] == "cannot tell" and one["listed"] for one in those),
            "without": quantile([one["before"] for one in moved], 0.5),
            "left, median": quantile([one["left"] for one in moved], 0.5),
            "left, 90 %": quantile([one["left"] for one in moved], 0.9)})
    return rows


def shown(value):
    return "" if value is None else f"{value:.2f}" if isinstance(value, float) else str(value)


def markdown(rows):
    head = list(rows[0])
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(shown(one[key]) for key in head) + " |" for one in rows])


def write_csv(file, rows):
    with open(file, "w", newline="") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("answers", type=pathlib.Path)
    parser.add_argument("--command", default=COMMAND)
    parser.add_argument("--probabilities", type=pathlib.Path)
    parser.add_argument("--models", type=pathlib.Path)
    parser.add_argument("--seeds", default="1..200", help="numbers of the riddles, like 1..20")
    parser.add_argument("--csv", type=pathlib.Path)
    parser.add_argument("--each", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    program = Program(options.command)
    files = [options.out / "truth" / f"{n:03d}.json" for n in numbers_of(options.seeds)]
    truths = [json.loads(one.read_text()) for one in files if one.is_file()]
    try:
        if not truths:
            raise BadAnswer(f"{options.out}: no riddle of {options.seeds} is there, expected what make_riddles.py makes")
        answers = read_answers(options.answers)
    except (BadAnswer, OSError) as wrong:
        print(wrong, file=sys.stderr)
        return 2
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        scores = list(pool.map(lambda truth: score_one(program, options.out, truth,
                                                       answers.get(truth["riddle"], []), options.models), truths))
    rows = table(scores)
    print(markdown(rows))
    if options.csv:
        write_csv(options.csv, rows)
    if options.each:
        write_csv(options.each, scores)
    if options.probabilities:
        print("\n| called so likely, on average | effects | true |\n|---|---|---|")
        for n, said, right in calibration(program, options.out, truths, options.probabilities):
            print(f"| {100 * said:.0f} % | {n} | {right} ({100 * right / n:.0f} %) |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
