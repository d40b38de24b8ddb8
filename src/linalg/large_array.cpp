// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/large_array.hpp"

#include <limits>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace trussmap::linalg {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21U;

}  // namespace

LargeArray large_array(std::size_t count) {
  if (count > std::numeric_limits<std::size_t>::max() / sizeof(double) - kLargePage) {
    throw std::bad_alloc();
  }
  const std::size_t bytes = count * sizeof(double);
  const bool large = bytes >= kLargePage;
  // Whole pages: aligned_alloc wants a multiple of what it aligns to.
  const std::size_t rounded = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  void* memory = large ? std::aligned_alloc(kLargePage, rounded)
                       : std::malloc(bytes > 0 ? bytes : sizeof(double));
  if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
  if (large) static_cast<void>(madvise(memory, bytes / kLargePage * kLargePage, MADV_HUGEPAGE));
#endif
  return LargeArray(static_cast<double*>(memory));
}

}  // namespace trussmap::linalg
