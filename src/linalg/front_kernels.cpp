// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/front_kernels.hpp"

#include "parallel/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

// Debian's BLAS and LAPACK, whichever is installed; Fortran's calling convention.
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dtrtri_(const char* uplo, const char* diag, const int* n, double* a, const int* lda, int* info);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b,
            const int* ldb);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* beta, double* c, const int* ldc);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
}

// One version per instruction set, chosen when the program starts; too early for ThreadSanitizer.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define TRUSSMAP_VERSIONS __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define TRUSSMAP_VERSIONS
#endif
#define TRUSSMAP_INLINE __attribute__((always_inline)) inline

namespace trussmap {
namespace {

constexpr int kBlock = 4;  // columns at a time
constexpr int kTile = 256;
constexpr int kInverseBlock = 16;
constexpr int kInverseColumns = 192;

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

/// As many rows of C -= A B as a vector has numbers.
template <typename Rows, int N>
TRUSSMAP_INLINE void subtract_rows(double* c, int ldc, const double* a, int lda, const double* b,
                                   std::ptrdiff_t step, std::ptrdiff_t across, int k) {
  Rows sum[N] = {};
  for (int q = 0; q < k; ++q) {
    Rows from;
    std::memcpy(&from, a + at(0, q, lda), sizeof from);
    for (int n = 0; n < N; ++n) sum[n] += from * b[q * step + n * across];
  }
  for (int n = 0; n < N; ++n) {
    double* to = c + at(0, n, ldc);
    for (std::size_t r = 0; r < sizeof(Rows) / sizeof(double); ++r) to[r] -= sum[n][r];
  }
}

/// C (m x N) -= A (m x k) B (k x N), with B[q, c] at b[q * step + c * across].
template <int N>
TRUSSMAP_INLINE void subtract_product(double* c, int ldc, const double* a, int lda, const double* b,
                                      std::ptrdiff_t step, std::ptrdiff_t across, int m, int k) {
  int i = 0;
  for (; i + 8 <= m; i += 8) {
    Four low[N] = {};
    Four high[N] = {};
    for (int q = 0; q < k; ++q) {
      Four a0;
      Four a1;
      std::memcpy(&a0, a + at(i, q, lda), sizeof a0);
      std::memcpy(&a1, a + at(i + 4, q, lda), sizeof a1);
      for (int n = 0; n < N; ++n) {
        const double factor = b[q * step + n * across];
        low[n] += a0 * factor;
        high[n] += a1 * factor;
      }
    }
    for (int n = 0; n < N; ++n) {
      double* to = c + at(i, n, ldc);
      for (int r = 0; r < 4; ++r) to[r] -= low[n][r];
      for (int r = 0; r < 4; ++r) to[4 + r] -= high[n][r];
    }
  }
  if (i + 4 <= m) {
    subtract_rows<Four, N>(c + i, ldc, a + i, lda, b, step, across, k);
    i += 4;
  }
  if (i + 2 <= m) {
    subtract_rows<Two, N>(c + i, ldc, a + i, lda, b, step, across, k);
    i += 2;
  }
  for (; i < m; ++i) {
    for (int n = 0; n < N; ++n) {
      double sum = 0.0;
      for (int q = 0; q < k; ++q) sum += a[at(i, q, lda)] * b[q * step + n * across];
      c[at(i, n, ldc)] -= sum;
    }
  }
}

TRUSSMAP_INLINE void subtract_product(double* c, int ldc, const double* a, int lda, const double* b,
                                      std::ptrdiff_t step, std::ptrdiff_t across, int m, int n,
                                      int k) {
  switch (n) {
    case 4:
      return subtract_product<4>(c, ldc, a, lda, b, step, across, m, k);
    case 3:
      return subtract_product<3>(c, ldc, a, lda, b, step, across, m, k);
    case 2:
      return subtract_product<2>(c, ldc, a, lda, b, step, across, m, k);
    default:
      return subtract_product<1>(c, ldc, a, lda, b, step, across, m, k);
  }
}

TRUSSMAP_INLINE double dot(const double* a, const double* b, int m) {
  Four sums[2] = {};
  int i = 0;
  for (; i + 8 <= m; i += 8) {
    for (std::ptrdiff_t h = 0; h < 2; ++h) {
      Four x;
      Four y;
      std::memcpy(&x, a + i + 4 * h, sizeof x);
      std::memcpy(&y, b + i + 4 * h, sizeof y);
      sums[h] += x * y;
    }
  }
  const Four both = sums[0] + sums[1];
  double sum = (both[0] + both[1]) + (both[2] + both[3]);
  for (; i < m; ++i) sum += a[i] * b[i];
  return sum;
}

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
    parallel_for(tiles, [&](std::size_t tile) {
      const int m = length(tile);
      dtrsm_("R", "L", "T", "N", &m, &n, &one, square, &rows, first(tile), &rows);
    });
    parallel_for(tiles * (tiles + 1) / 2, [&](std::size_t pair) {
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

/// What stands below the square in these columns, down to `bottom`, goes to the right of it, too.
TRUSSMAP_INLINE void mirror(double* matrix, int rows, int begin, int end, int bottom) {
  for (int first = begin; first < end; first += kBlock) {
    const int n = std::min(kBlock, end - first);
    const double* from = matrix + at(0, first, rows);
    for (int i = end; i < bottom; ++i) {
      double* to = matrix + at(first, i, rows);
      for (int c = 0; c < n; ++c) to[c] = from[at(i, c, rows)];
    }
  }
}

/// By blocks of columns from the right. With G = L21 L11^-1 and Z the inverse:
///   Z_21 = -Z_22 G,   Z_11 = L11^-T L11^-1 - G' Z_21
TRUSSMAP_VERSIONS void invert_small(double* panel, int rows, int width, double* inverse,
                                    double* space) {
  int end = width;
  while (end > 0) {
    const int n = (end - 1) % kBlock + 1;
    const int j = end - n;
    const int m = rows - end;
    double scale[kBlock];
    for (int c = 0; c < n; ++c) scale[c] = 1.0 / panel[at(j + c, j + c, rows)];
    double* g = panel + at(end, j, rows);  // L21 of these columns becomes G
    for (int c = n - 1; c >= 0; --c) {
      double* column = g + at(0, c, rows);
      for (int q = c + 1; q < n; ++q) {
        const double factor = panel[at(j + q, j + c, rows)];
        const double* right = g + at(0, q, rows);
        for (int i = 0; i < m; ++i) column[i] -= right[i] * factor;
      }
      for (int i = 0; i < m; ++i) column[i] *= scale[c];
    }
    double* z21 = inverse + at(end, j, rows);
    for (int c = 0; c < n; ++c) std::fill_n(z21 + at(0, c, rows), m, 0.0);
    subtract_product(z21, rows, inverse + at(end, end, rows), rows, g, 1, rows, m, n, m);
    double* z11 = inverse + at(j, j, rows);
    double* t = space;  // L11^-1
    for (int c = 0; c < n; ++c) {
      for (int i = 0; i < c; ++i) t[at(i, c, n)] = 0.0;
      for (int i = c; i < n; ++i) {
        double sum = i == c ? 1.0 : 0.0;
        for (int q = c; q < i; ++q) sum -= panel[at(j + i, j + q, rows)] * t[at(q, c, n)];
        t[at(i, c, n)] = sum * scale[i];
      }
    }
    for (int c = 0; c < n; ++c) {
      for (int r = c; r < n; ++r) {
        double sum = 0.0;
        for (int q = r; q < n; ++q) sum += t[at(q, r, n)] * t[at(q, c, n)];
        sum -= dot(g + at(0, r, rows), z21 + at(0, c, rows), m);
        z11[at(r, c, rows)] = sum;
        z11[at(c, r, rows)] = sum;
      }
    }
    mirror(inverse, rows, j, end, rows);
    end = j;
  }
}

void product(const char* first, const char* second, int m, int n, int k, double factor,
             const double* a, int lda, const double* b, int ldb, double keep, double* c, int ldc) {
  dgemm_(first, second, &m, &n, &k, &factor, a, &lda, b, &ldb, &keep, c, &ldc);
}

/// Z_11 = L11^-T L11^-1 of columns `begin` to `end`, as if nothing stood below them. The blocks on
/// the diagonal of L11 become their inverses.
void invert_square(double* panel, int rows, int begin, int end, double* inverse, double* space) {
  for (int below = end; below > begin;) {
    const int n = std::min(kInverseBlock, below - begin);
    const int j = below - n;
    const int m = end - below;
    double* t = panel + at(j, j, rows);
    int info = 0;
    dtrtri_("L", "N", &n, t, &rows, &info);
    for (int c = 1; c < n; ++c) std::fill_n(t + at(0, c, rows), c, 0.0);
    double* z11 = inverse + at(j, j, rows);
    product("T", "N", n, n, n, 1.0, t, rows, t, rows, 0.0, z11, rows);
    if (m > 0) {
      double* z21 = inverse + at(below, j, rows);
      product("N", "N", m, n, n, 1.0, panel + at(below, j, rows), rows, t, rows, 0.0, space, m);
      product("N", "N", m, n, m, -1.0, inverse + at(below, below, rows), rows, space, m, 0.0, z21,
              rows);
      product("T", "N", n, n, m, -1.0, space, m, z21, rows, 1.0, z11, rows);
      mirror(inverse, rows, j, below, end);
    }
    below = j;
  }
}

/// The same by products of matrices, of which BLAS is quick; its triangular solves and inverses run
/// at half the speed or less.
void invert_large(double* panel, int rows, int width, double* inverse, double* space) {
  for (int end = width; end > 0;) {
    const int begin = std::max(0, end - kInverseColumns);
    const int m = rows - end;
    invert_square(panel, rows, begin, end, inverse, space);
    if (m > 0) {
      const auto g = [&](int column) { return space + at(0, column - begin, m); };
      for (int below = end; below > begin;) {
        const int n = std::min(kInverseBlock, below - begin);
        const int j = below - n;
        double* l21 = panel + at(end, j, rows);
        if (below < end) {
          product("N", "N", m, n, end - below, -1.0, g(below), m, panel + at(below, j, rows), rows,
                  1.0, l21, rows);
        }
        product("N", "N", m, n, n, 1.0, l21, rows, panel + at(j, j, rows), rows, 0.0, g(j), m);
        below = j;
      }
      double* z21 = inverse + at(end, begin, rows);
      product("N", "N", m, end - begin, m, -1.0, inverse + at(end, end, rows), rows, space, m, 0.0,
              z21, rows);
      for (int j = begin; j < end; j += kInverseBlock) {
        product("T", "N", end - j, std::min(kInverseBlock, end - j), m, -1.0, g(j), m,
                z21 + at(0, j - begin, rows), rows, 1.0, inverse + at(j, j, rows), rows);
      }
      mirror(inverse, rows, begin, end, rows);
    }
    for (int c = begin; c < end; ++c) {
      for (int r = begin; r < c; ++r) inverse[at(r, c, rows)] = inverse[at(c, r, rows)];
    }
    end = begin;
  }
}

/// Where a call to BLAS pays, by trial.
bool is_large(int rows, int width) {
  return width >= 32 && rows >= 96;
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

void invert_front(double* panel, int rows, int width, double* inverse, double* space) {
  if (is_large(rows, width)) {
    invert_large(panel, rows, width, inverse, space);
  } else {
    invert_small(panel, rows, width, inverse, space);
  }
}

}  // namespace trussmap
