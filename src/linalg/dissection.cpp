// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/dissection.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>

namespace trussmap::linalg {
namespace {

constexpr std::ptrdiff_t kSmallest = 6;  // nodes: smaller parts are one dense front anyway

class Dissector {
 public:
  Dissector(const std::vector<Vector2>& positions, const std::vector<NodePair>& pairs)
      : positions_(positions), side_(positions.size(), kNone), order_(positions.size()) {
    const std::size_t n = positions.size();
    begin_.assign(n + 1, 0);
    for (const NodePair& pair : pairs) {
      for (const int node : pair) {
        if (node < 0 || idx(node) >= n) throw std::invalid_argument("a pair of unknown nodes");
        ++begin_[idx(node) + 1];
      }
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    neighbours_.resize(2 * pairs.size());
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (const NodePair& pair : pairs) {
      neighbours_[idx(next[idx(pair[0])]++)] = pair[1];
      neighbours_[idx(next[idx(pair[1])]++)] = pair[0];
    }
    std::iota(order_.begin(), order_.end(), 0);
  }

  std::vector<int> run() {
    dissect(order_.begin(), order_.end());
    return std::move(order_);
  }

 private:
  using Place = std::vector<int>::iterator;
  enum Side : std::uint8_t { kNone, kLow, kHigh };

  void dissect(Place first, Place last) {
    while (last - first > kSmallest) {
      const int axis = longer_axis(first, last);
      const Place middle = halve(first, last, axis);
      for (Place k = first; k != middle; ++k) side_[idx(*k)] = kLow;
      for (Place k = middle; k != last; ++k) side_[idx(*k)] = kHigh;
      const bool cut_high = touching(middle, last, kLow) < touching(first, middle, kHigh);
      const Place cut = cut_high ? separate(middle, last, kLow) : separate(first, middle, kHigh);
      // Along the cut, so that what touches a stretch of it finds its rows together.
      std::sort(cut, cut_high ? last : middle,
                [&](int a, int b) { return before(a, b, 1 - axis); });
      for (Place k = first; k != last; ++k) side_[idx(*k)] = kNone;
      // What was cut off comes last: low part, high part, separator.
      if (cut_high) {
        dissect(first, middle);
        last = cut;
        first = middle;
      } else {
        const Place high = std::rotate(cut, middle, last);
        dissect(first, cut);
        first = cut;
        last = high;
      }
    }
  }

  [[nodiscard]] int longer_axis(Place first, Place last) const {
    Vector2 low = positions_[idx(*first)];
    Vector2 high = low;
    for (Place k = first; k != last; ++k) {
      low = low.cwiseMin(positions_[idx(*k)]);
      high = high.cwiseMax(positions_[idx(*k)]);
    }
    const Vector2 extent = high - low;
    return extent.x() >= extent.y() ? 0 : 1;
  }

  [[nodiscard]] bool before(int a, int b, int axis) const {
    const Vector2& p = positions_[idx(a)];
    const Vector2& q = positions_[idx(b)];
    if (p[axis] != q[axis]) return p[axis] < q[axis];
    return p[1 - axis] != q[1 - axis] ? p[1 - axis] < q[1 - axis] : a < b;
  }

  [[nodiscard]] Place halve(Place first, Place last, int axis) const {
    const Place middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [&](int a, int b) { return before(a, b, axis); });
    return middle;
  }

  [[nodiscard]] bool touches(int node, Side other) const {
    for (int k = begin_[idx(node)]; k < begin_[idx(node) + 1]; ++k) {
      if (side_[idx(neighbours_[idx(k)])] == other) return true;
    }
    return false;
  }

  [[nodiscard]] std::ptrdiff_t touching(Place first, Place last, Side other) const {
    return std::count_if(first, last, [&](int node) { return touches(node, other); });
  }

  Place separate(Place first, Place last, Side other) const {
    return std::stable_partition(first, last, [&](int node) { return !touches(node, other); });
  }

  const std::vector<Vector2>& positions_;
  std::vector<int> begin_;
  std::vector<int> neighbours_;
  std::vector<Side> side_;
  std::vector<int> order_;
};

}  // namespace

std::vector<int> dissection_order(const std::vector<Vector2>& positions,
                                  const std::vector<NodePair>& pairs) {
  return Dissector(positions, pairs).run();
}

}  // namespace trussmap::linalg
