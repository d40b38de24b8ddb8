// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/hilbert.hpp"

#include <utility>

namespace trussmap::distributed {

std::uint64_t hilbert_place(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kLast = (std::uint32_t{1} << kHilbertBits) - 1;
  std::uint64_t place = 0;
  for (std::uint32_t side = std::uint32_t{1} << (kHilbertBits - 1); side > 0; side /= 2) {
    const std::uint64_t right = (x & side) != 0 ? 1 : 0;
    const std::uint64_t upper = (y & side) != 0 ? 1 : 0;
    place = 4 * place + ((3 * right) ^ upper);
    if (upper == 0) {  // the quarter's curve is the whole's, reflected
      if (right == 1) {
        x = kLast - x;
        y = kLast - y;
      }
      std::swap(x, y);
    }
  }
  return place;
}

}  // namespace trussmap::distributed
