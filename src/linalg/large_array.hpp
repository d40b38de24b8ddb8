// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Memory for many numbers, of large pages where the system has them: a small page (4 KB) costs a
// fault when it is first touched, and an entry of the processor's table of pages ever after.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace trussmap::linalg {

struct FreeLargeArray {
  void operator()(double* numbers) const { std::free(numbers); }
};
using LargeArray = std::unique_ptr<double[], FreeLargeArray>;

/// As many numbers, not initialised. Throws std::bad_alloc.
[[nodiscard]] LargeArray large_array(std::size_t count);

}  // namespace trussmap::linalg
