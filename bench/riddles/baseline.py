# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""What both baselines share: the command line, least squares over effects, and answers from those chosen."""
import argparse
import csv
import pathlib
import time

import numpy as np

from legs import Riddle, library, refined
from program import numbers_of

GROSS = 0.03  # a constant that is off by more


def sum_of_squares(X, y):
    """What least squares leaves, and how many columns of X are independent."""
    if X.shape[1] == 0:
        return float(y @ y), 0
    c, _, rank, _ = np.linalg.lstsq(X / np.linalg.norm(X, axis=0), y, rcond=1e-8)
    left = y - X / np.linalg.norm(X, axis=0) @ c
    return float(left @ left), int(rank)


def stacked(effects, chosen, rows):
    return np.column_stack([np.zeros((rows, 0)), *[effects[k][1] for k in chosen]])


def rows_of(name, riddle, effects, chosen):
    """Answers: a row per effect, sizes by least squares beside each other."""
    if not chosen:
        return [[name, "nothing", "", "", ""]]
    terms = [term for k in chosen for term in effects[k][0]]
    sizes, rows = list(refined(riddle, terms)), []
    for k in chosen:
        own = effects[k][0]
        mine, sizes = sizes[:len(own)], sizes[len(own):]
        gross = own[0].shape == "1" and abs(mine[0]) > GROSS and own[0].channel not in ("compass", "steer", "lever")
        rows.append([name, "gross constant" if gross else "effect",
                     f"{own[0].channel} x {'; '.join(one.shape for one in own)}",
                     " ".join(f"{c:.6g}" for c in mine), ""])
    return rows


def main(choose, doc):
    """`choose(effects, y)` gives the numbers of the effects that explain the errors y."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("answers", type=pathlib.Path)
    parser.add_argument("--seeds", default="1..200", help="numbers of the riddles, like 1..20")
    options = parser.parse_args()
    with open(options.answers, "w", newline="") as stream:
        write = csv.writer(stream)
        write.writerow(["riddle", "class", "effect", "coefficients", "alternatives", "seconds"])
        for number in numbers_of(options.seeds):
            name = f"{number:03d}"
            folder = options.out / "riddles" / name
            if not folder.is_dir():
                continue
            begun = time.monotonic()
            riddle = Riddle(folder)
            rows = [[name, "cannot tell", "", "", ""]]  # without a survey
            if len(riddle.legs) > 10:
                effects = library(riddle)
                rows = rows_of(name, riddle, effects, choose(effects, -riddle.residuals([], [])))
            write.writerows([*row, f"{time.monotonic() - begun:.1f}"] for row in rows)
            stream.flush()
