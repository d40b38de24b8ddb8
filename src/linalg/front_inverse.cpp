// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The inverse of one front.
#include "linalg/front_kernels.hpp"
#include "linalg/front_loops.hpp"

#include <algorithm>

extern "C" {
void dtrtri_(const char* uplo, const char* diag, const int* n, double* a, const int* lda,
             int* info);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
}

namespace trussmap::linalg {
namespace {

constexpr int kInverseBlock = 16;     // columns whose triangle is inverted, by trial
constexpr int kInverseColumns = 192;  // multiplied with the rest at once, by trial

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

}  // namespace

void invert_front(double* panel, int rows, int width, double* inverse, double* space) {
  if (is_large(rows, width)) {
    invert_large(panel, rows, width, inverse, space);
  } else {
    invert_small(panel, rows, width, inverse, space);
  }
}

}  // namespace trussmap::linalg
