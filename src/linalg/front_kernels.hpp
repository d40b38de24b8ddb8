// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Dense algebra on one front: own loops where fronts are small, BLAS and LAPACK where they are
// large enough to be worth a call. All matrices are by columns.
#pragma once

#include <cstddef>

namespace trussmap::linalg {

/// Place of an entry in a matrix by columns.
inline std::ptrdiff_t at(int row, int column, int leading) {
  return row + static_cast<std::ptrdiff_t>(column) * leading;
}

/// Numbers in a matrix.
inline std::size_t area(int rows, int columns) {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

/// Partial Cholesky factorisation. `panel`: rows x width, of which the triangle on and below the
/// diagonal is read and becomes L. `update`, (rows - width) square: the lower triangle loses
/// L21 L21'. Returns the column that is not positive, -1 if all are.
int eliminate(double* panel, int rows, int width, double* update);

/// x := L11^-1 x for the first `width` of x, and the rest of x minus L21 times it; and transposed:
/// x_1 := L11^-T (x_1 - L21' x_2).
void solve_forward(const double* panel, int rows, int width, double* x);
void solve_backward(const double* panel, int rows, int width, double* x);

/// The same for `count` right sides at once, a multiple of 8: x holds them row by row, `count`
/// numbers each. A side's digits do not depend on what the others are.
void solve_forward_many(const double* panel, int rows, int width, double* x, int count);
void solve_backward_many(const double* panel, int rows, int width, double* x, int count);

/// `inverse`, rows square and symmetric, holds the inverse of the remaining rows at its lower
/// right; the rest of it is found from the panel (L, which is spoilt). `space`: rows x width.
void invert_front(double* panel, int rows, int width, double* inverse, double* space);

}  // namespace trussmap::linalg
