// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/front_kernels.hpp"

#include "linalg/front_loops.hpp"
#include "parallel/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

// Debian's BLAS and LAPACK, whichever is installed; Fortran's calling convention.
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b,
            const int* ldb);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* beta, double* c, const int* ldc);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
}

namespace trussmap::linalg {
namespace {

constexpr int kTile = 256;

/// Columns j ... j + n of the panel, to the left of which all is done.
TRUSSMAP_INLINE int factor_columns(double* panel, int rows, int j, int n) {
  subtract_product(panel + at(j, j, rows), rows, panel + j, rows, panel + j, rows, 1, rows - j, n,
                   j);
  for (int c = j; c < j + n; ++c) {
    double* column = panel + at(0, c, rows);
    for (int q = j; q < c; ++q) {
      const double factor = panel[at(c, q, rows)];
      const double* left = panel + at(0, q, rows);
      for (int i = c; i < rows; ++i) column[i] -= left[i] * factor;
    }
    if (!(column[c] > 0.0)) return c;
    const double root = std::sqrt(column[c]);
    const double scale = 1.0 / root;
    column[c] = root;
    for (int i = c + 1; i < rows; ++i) column[i] *= scale;
  }
  return -1;
}

TRUSSMAP_VERSIONS int eliminate_small(double* panel, int rows, int width, double* update) {
  for (int j = 0; j < width; j += kBlock) {
    const int failed = factor_columns(panel, rows, j, std::min(kBlock, width - j));
    if (failed >= 0) return failed;
  }
  const int height = rows - width;
  const double* below = panel + width;
  for (int j = 0; j < height; j += kBlock) {
    subtract_product(update + at(j, j, height), height, below + j, rows, below + j, rows, 1,
                     height - j, std::min(kBlock, height - j), width);
  }
  return -1;
}

/// Tiles of the rest of a front: rows and columns from `begin` on, none across `width`.
std::vector<int> tile_edges(int begin, int width, int rows) {
  std::vector<int> edges;
  for (int k = begin; k < width; k += kTile) edges.push_back(k);
  for (int k = width; k < rows; k += kTile) edges.push_back(k);
  edges.push_back(rows);
  return edges;
}

/// By tiles, so that several threads may work on a front, from the same tiles for any number of
/// them.
int eliminate_large(double* panel, int rows, int width, double* update) {
  const double one = 1.0;
  const double minus = -1.0;
  const int height = rows - width;
  for (int j = 0; j < width; j += kTile) {
    const int n = std::min(kTile, width - j);
    double* square = panel + at(j, j, rows);
    int info = 0;
    dpotrf_("L", &n, square, &rows, &info);
    if (info > 0) return j + info - 1;
    const std::vector<int> edges = tile_edges(j + n, width, rows);
    const std::size_t tiles = edges.size() - 1;
    const auto first = [&](std::size_t tile) { return panel + at(edges[tile], j, rows); };
    const auto length = [&](std::size_t tile) { return edges[tile + 1] - edges[tile]; };
    parallel::parallel_for(tiles, [&](std::size_t tile) {
      const int m = length(tile);
      dtrsm_("R", "L", "T", "N", &m, &n, &one, square, &rows, first(tile), &rows);
    });
    parallel::parallel_for(tiles * (tiles + 1) / 2, [&](std::size_t pair) {
      std::size_t row = 0;  // the pair's tiles, column <= row
      while ((row + 1) * (row + 2) / 2 <= pair) ++row;
      const std::size_t column = pair - row * (row + 1) / 2;
      const bool in_panel = edges[column] < width;
      const int leading = in_panel ? rows : height;
      double* to = in_panel ? panel + at(edges[row], edges[column], rows)
                            : update + at(edges[row] - width, edges[column] - width, height);
      const int m = length(row);
      const int k = length(column);
      if (row == column) {
        dsyrk_("L", "N", &m, &n, &minus, first(row), &rows, &one, to, &leading);
      } else {
        dgemm_("N", "T", &m, &k, &n, &minus, first(row), &rows, first(column), &rows, &one, to,
               &leading);
      }
    });
  }
  return -1;
}

}  // namespace

int eliminate(double* panel, int rows, int width, double* update) {
  return is_large(rows, width) ? eliminate_large(panel, rows, width, update)
                               : eliminate_small(panel, rows, width, update);
}

TRUSSMAP_VERSIONS void solve_forward(const double* panel, int rows, int width, double* x) {
  for (int c = 0; c < width; ++c) {
    const double* column = panel + at(0, c, rows);
    const double value = x[c] / column[c];
    x[c] = value;
    for (int i = c + 1; i < rows; ++i) x[i] -= column[i] * value;
  }
}

TRUSSMAP_VERSIONS void solve_backward(const double* panel, int rows, int width, double* x) {
  for (int c = width - 1; c >= 0; --c) {
    const double* column = panel + at(0, c, rows);
    x[c] = (x[c] - dot(column + c + 1, x + c + 1, rows - c - 1)) / column[c];
  }
}

// The right sides, row by row, are columns to BLAS: `count` high.
TRUSSMAP_VERSIONS void forward_small(const double* panel, int rows, int width, double* x,
                                     int count) {
  for (int j = 0; j < width; j += kBlock) {
    const int n = std::min(kBlock, width - j);
    subtract_product(x + at(0, j, count), count, x, count, panel + j, rows, 1, count, n, j);
    for (int c = j; c < j + n; ++c) {
      double* own = x + at(0, c, count);
      for (int q = j; q < c; ++q) {
        const double factor = panel[at(c, q, rows)];
        const double* before = x + at(0, q, count);
        for (int i = 0; i < count; ++i) own[i] -= before[i] * factor;
      }
      const double scale = 1.0 / panel[at(c, c, rows)];
      for (int i = 0; i < count; ++i) own[i] *= scale;
    }
  }
  for (int j = width; j < rows; j += kBlock) {
    subtract_product(x + at(0, j, count), count, x, count, panel + j, rows, 1, count,
                     std::min(kBlock, rows - j), width);
  }
}

TRUSSMAP_VERSIONS void backward_small(const double* panel, int rows, int width, double* x,
                                      int count) {
  int end = width;
  while (end > 0) {
    const int n = (end - 1) % kBlock + 1;
    const int j = end - n;
    subtract_product(x + at(0, j, count), count, x + at(0, end, count), count,
                     panel + at(end, j, rows), 1, rows, count, n, rows - end);
    for (int c = end - 1; c >= j; --c) {
      double* own = x + at(0, c, count);
      for (int q = c + 1; q < end; ++q) {
        const double factor = panel[at(q, c, rows)];
        const double* after = x + at(0, q, count);
        for (int i = 0; i < count; ++i) own[i] -= after[i] * factor;
      }
      const double scale = 1.0 / panel[at(c, c, rows)];
      for (int i = 0; i < count; ++i) own[i] *= scale;
    }
    end = j;
  }
}

void solve_forward_many(const double* panel, int rows, int width, double* x, int count) {
  if (!is_large(rows, width)) return forward_small(panel, rows, width, x, count);
  const double one = 1.0;
  const double minus = -1.0;
  const int height = rows - width;
  dtrsm_("R", "L", "T", "N", &count, &width, &one, panel, &rows, x, &count);
  if (height == 0) return;
  dgemm_("N", "T", &count, &height, &width, &minus, x, &count, panel + width, &rows, &one,
         x + at(0, width, count), &count);
}

void solve_backward_many(const double* panel, int rows, int width, double* x, int count) {
  if (!is_large(rows, width)) return backward_small(panel, rows, width, x, count);
  const double one = 1.0;
  const double minus = -1.0;
  const int height = rows - width;
  if (height > 0) {
    dgemm_("N", "N", &count, &width, &height, &minus, x + at(0, width, count), &count,
           panel + width, &rows, &one, x, &count);
  }
  dtrsm_("R", "L", "N", "N", &count, &width, &one, panel, &rows, x, &count);
}

}  // namespace trussmap::linalg
