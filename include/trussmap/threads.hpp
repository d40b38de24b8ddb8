// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How many threads the library's calls work on. The figures are the same, to the last digit,
// whatever their number.
//
// A BLAS that starts threads of its own would compete with these; OpenBLAS is told by
// OPENBLAS_NUM_THREADS=1 or openblas_set_num_threads(1).
#pragma once

namespace trussmap {

/// For calls from now on; the caller's own counts. 1 until it is set. A call that comes while
/// another one has the library's threads works on its caller's alone. Throws
/// std::invalid_argument below 1.
void set_threads(int threads);

[[nodiscard]] int threads();

/// As many as the machine runs at once, 1 where that is not known.
[[nodiscard]] int available_threads();

}  // namespace trussmap
