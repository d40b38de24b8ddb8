#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Answers the riddles by sparse regression on a library of effects (needs python3-sklearn).

The lasso (R. Tibshirani, J. Royal Statistical Society B 58, 1996) whose penalty five-fold cross-validation chooses, the
largest within one standard error of the best; then sequentially thresholded least squares (S. Brunton, J. Proctor &
N. Kutz, PNAS 113, 2016) on what it kept: the least significant effect is dropped until all stand at 5 % over the
whole library.

Usage: baseline_sparse.py OUT answers.csv [--seeds 1..200]
"""
import warnings

import numpy as np
from sklearn.linear_model import Lasso, LassoCV

from baseline import main, stacked, sum_of_squares
from baseline_stepwise import LEVEL, p_value

FOLDS = 5
TWINS = 0.99  # cosine


def kept_by_lasso(X, y):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = LassoCV(cv=FOLDS, fit_intercept=False, n_alphas=30, eps=0.03, max_iter=2000, tol=1e-3).fit(X, y)
        errors = path.mse_path_.mean(axis=1)
        spread = path.mse_path_.std(axis=1) / np.sqrt(FOLDS)
        best = int(np.argmin(errors))
        alpha = max(path.alphas_[errors <= errors[best] + spread[best]])
        return Lasso(alpha=alpha, fit_intercept=False, max_iter=2000, tol=1e-3).fit(X, y).coef_


def without_twins(X):
    """Columns that no earlier one is the same as, but for its sign."""
    cosines = np.abs(np.triu(X.T @ X / len(X), 1))
    kept = []
    for k in range(X.shape[1]):
        if not kept or cosines[kept, k].max() < TWINS:
            kept.append(k)
    return np.array(kept)


def choose(effects, y):
    used = y != 0.0
    X = np.column_stack([one[1] for one in effects])[used]
    X = X / np.linalg.norm(X, axis=0) * np.sqrt(len(X))
    owner = np.repeat(np.arange(len(effects)), [one[1].shape[1] for one in effects])
    apart = without_twins(X)
    coefficients = kept_by_lasso(X[:, apart], y[used])
    chosen = [int(k) for k in np.unique(owner[apart][np.abs(coefficients) > 0.0])]
    n = int(np.count_nonzero(used))
    while chosen:
        squares, rank = sum_of_squares(stacked(effects, chosen, len(y)), y)
        doubts = []
        for k in chosen:
            without, less = sum_of_squares(stacked(effects, [one for one in chosen if one != k], len(y)), y)
            doubts.append((p_value(without, less, squares, rank, n), k))
        worst, at = max(doubts)
        if len(effects) * worst <= LEVEL:
            break
        chosen.remove(at)
    return chosen


if __name__ == "__main__":
    main(choose, __doc__)
