// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Loops over the columns of a front, on the widest vectors that a processor has; for the sources
// that compile a version of their functions per instruction set.
#pragma once

#include "linalg/front_kernels.hpp"

#include <cstddef>
#include <cstring>

// One version per instruction set, chosen when the program starts; too early for ThreadSanitizer.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define TRUSSMAP_VERSIONS __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define TRUSSMAP_VERSIONS
#endif
#define TRUSSMAP_INLINE __attribute__((always_inline)) inline

namespace trussmap::linalg {

inline constexpr int kBlock = 4;  // columns at a time

/// Where a call to BLAS pays, by trial.
inline bool is_large(int rows, int width) {
  return width >= 32 && rows >= 96;
}

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

}  // namespace trussmap::linalg
