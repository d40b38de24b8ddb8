#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Answers the riddles by stepwise least squares over a library of effects (needs python3-numpy).

Efroymson's forward selection with elimination (M. A. Efroymson, Multiple regression analysis, 1960): the effect that
takes most of the sum of squares is added while an F test says so at 5 % over the whole library (Bonferroni) and
Schwarz's BIC falls; what the others make superfluous is dropped again.

Usage: baseline_stepwise.py OUT answers.csv [--seeds 1..200]
"""
import math

import numpy as np

from baseline import main, stacked, sum_of_squares

LEVEL = 0.05
MOST = 8


def tail_of_f(f, a, b):
    """P(F > f) with a and b degrees of freedom, by Paulson's normal approximation."""
    if f <= 0.0:
        return 1.0
    root = f ** (1 / 3)
    z = ((1 - 2 / (9 * b)) * root - (1 - 2 / (9 * a))) / math.sqrt(2 / (9 * b) * root ** 2 + 2 / (9 * a))
    return 0.5 * math.erfc(z / math.sqrt(2))


def p_value(before, rank_before, after, rank, n):
    if rank <= rank_before:
        return 1.0
    return tail_of_f((before - after) / (rank - rank_before) / (after / (n - rank)), rank - rank_before, n - rank)


def choose(effects, y):
    n = int(np.count_nonzero(y))
    bic = lambda squares, rank: n * math.log(squares / n) + rank * math.log(n)
    chosen, (squares, rank) = [], sum_of_squares(np.zeros((len(y), 0)), y)
    while len(chosen) < MOST:
        trials = [(*sum_of_squares(stacked(effects, [*chosen, k], len(y)), y), k)
                  for k in range(len(effects)) if k not in chosen]
        # The least BIC, so that two columns have to earn the second.
        after, more, best = min(trials, key=lambda one: bic(one[0], one[1]))
        if len(effects) * p_value(squares, rank, after, more, n) > LEVEL or bic(after, more) >= bic(squares, rank):
            break
        chosen, squares, rank = [*chosen, best], after, more
        for k in chosen[:-1]:
            rest = [one for one in chosen if one != k]
            without, less = sum_of_squares(stacked(effects, rest, len(y)), y)
            if len(effects) * p_value(without, less, squares, rank, n) > LEVEL:
                chosen, squares, rank = rest, without, less
    return chosen


if __name__ == "__main__":
    main(choose, __doc__)
