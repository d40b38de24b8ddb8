// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/large_array.hpp"

#include <limits>
#include <new>

#include <gtest/gtest.h>

namespace trussmap::large_array_test {
using namespace linalg;
namespace {

TEST(LargeArray, HoldsAsManyNumbersAsAsked) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{1} << 19U, (std::size_t{1} << 20U) + 1}) {
    const LargeArray numbers = large_array(count);
    ASSERT_NE(numbers.get(), nullptr);
    for (std::size_t k = 0; k < count; ++k) numbers[k] = static_cast<double>(k);
    for (std::size_t k = 0; k < count; ++k) ASSERT_EQ(numbers[k], static_cast<double>(k));
  }
}

TEST(LargeArray, ThrowsWhereThereIsNotEnoughMemory) {
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  EXPECT_THROW(static_cast<void>(large_array(kMost)), std::bad_alloc);
  EXPECT_THROW(static_cast<void>(large_array(kMost / 64)), std::bad_alloc);
}

}  // namespace
}  // namespace trussmap::large_array_test
