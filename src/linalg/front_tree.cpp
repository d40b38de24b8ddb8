// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/front_tree.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace trussmap::linalg {
namespace {

/// Children in ascending order, by first child and next sibling.
struct Forest {
  explicit Forest(const std::vector<int>& parent)
      : child(parent.size(), -1), sibling(parent.size(), -1) {
    for (int k = static_cast<int>(parent.size()) - 1; k >= 0; --k) {
      int& slot = parent[idx(k)] < 0 ? root : child[idx(parent[idx(k)])];
      sibling[idx(k)] = slot;
      slot = k;
    }
  }

  [[nodiscard]] std::vector<int> postorder() const {
    std::vector<int> order;
    order.reserve(child.size());
    std::vector<int> next = child;
    std::vector<int> path;
    for (int start = root; start >= 0; start = sibling[idx(start)]) {
      path.push_back(start);
      while (!path.empty()) {
        int& down = next[idx(path.back())];
        if (down >= 0) {
          path.push_back(std::exchange(down, sibling[idx(down)]));
        } else {
          order.push_back(path.back());
          path.pop_back();
        }
      }
    }
    return order;
  }

  std::vector<int> child;
  std::vector<int> sibling;
  int root = -1;
};

/// Parent of each place in the elimination tree: the first later place that its column of the
/// factor reaches. Rows are climbed with shortcuts (Liu, "The role of elimination trees in sparse
/// factorization", 1990).
std::vector<int> elimination_tree(const BlockPattern& pattern) {
  const std::size_t n = idx(pattern.nodes());
  std::vector<int> begin(n + 1, 0);
  for (const int row : pattern.later) ++begin[idx(row) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> earlier(pattern.later.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int k = 0; k < pattern.nodes(); ++k) {
    for (int q = pattern.begin[idx(k)]; q < pattern.begin[idx(k) + 1]; ++q) {
      earlier[idx(next[idx(pattern.later[idx(q)])]++)] = k;
    }
  }
  std::vector<int> parent(n, -1);
  std::vector<int> shortcut(n, -1);
  for (int row = 0; row < pattern.nodes(); ++row) {
    for (int q = begin[idx(row)]; q < begin[idx(row) + 1]; ++q) {
      for (int k = earlier[idx(q)]; k >= 0 && k != row;) {
        const int up = std::exchange(shortcut[idx(k)], row);
        if (up < 0) parent[idx(k)] = row;
        k = up;
      }
    }
  }
  return parent;
}

/// A front in the making; places count along the postorder.
struct Draft {
  std::vector<int> nodes;
  std::vector<int> rows;
  int parent = -1;
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::int64_t zeros = 0;  ///< entries stored for nothing
  bool absorbed = false;
};

std::int64_t entries(std::int64_t width, std::int64_t height) {
  return width * (width + 1) / 2 + width * height;
}

/// Small fronts may be mostly zeros, large ones hardly: found by trial, see bench/README.md.
bool worth_storing(std::int64_t zeros, std::int64_t width, std::int64_t height) {
  const double share = static_cast<double>(zeros) / static_cast<double>(entries(width, height));
  if (width <= 8) return true;
  if (width <= 16) return share < 0.5;
  if (width <= 48) return share < 0.12;
  return share < 0.04;
}

class Planner {
 public:
  Planner(const BlockPattern& pattern, const std::vector<int>& sizes)
      : pattern_(pattern), sizes_(sizes) {}

  FrontTree plan() {
    const std::vector<int> parent = elimination_tree(pattern_);
    order_ = Forest(parent).postorder();
    place_.resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) place_[idx(order_[k])] = static_cast<int>(k);
    draft(parent);
    amalgamate();
    return finished();
  }

 private:
  [[nodiscard]] int size(int place) const { return sizes_[idx(order_[idx(place)])]; }

  /// The largest runs of nodes, each the only child of the next, that share their rows.
  void draft(const std::vector<int>& parent_before) {
    const int n = static_cast<int>(order_.size());
    std::vector<int> parent(idx(n), -1);
    for (int k = 0; k < n; ++k) {
      const int up = parent_before[idx(order_[idx(k)])];
      if (up >= 0) parent[idx(k)] = place_[idx(up)];
    }
    const Forest tree(parent);
    std::vector<int> front_of(idx(n), -1);
    std::vector<int> mark(idx(n), -1);  // the front that has the place among its rows
    for (int k = 0; k < n; ++k) {
      const int old = order_[idx(k)];
      const auto own_begin = pattern_.later.begin() + pattern_.begin[idx(old)];
      const auto own_end = pattern_.later.begin() + pattern_.begin[idx(old) + 1];
      const int child = tree.child[idx(k)];
      const bool only_child = child >= 0 && tree.sibling[idx(child)] < 0;
      // An only child comes just before in postorder, and its front is the last one made.
      if (only_child && std::all_of(own_begin, own_end, [&](int row) {
            return mark[idx(place_[idx(row)])] == front_of[idx(child)];
          })) {
        front_of[idx(k)] = front_of[idx(child)];
        drafts_.back().nodes.push_back(k);
        continue;
      }
      const int number = static_cast<int>(drafts_.size());
      Draft front;
      front.nodes.push_back(k);
      const auto add = [&](int row) {
        if (row == k || mark[idx(row)] == number) return;
        mark[idx(row)] = number;
        front.rows.push_back(row);
      };
      for (int c = child; c >= 0; c = tree.sibling[idx(c)]) {
        Draft& below = drafts_[idx(front_of[idx(c)])];
        below.parent = number;
        for (const int row : below.rows) {
          if (row > c) add(row);
        }
      }
      for (auto row = own_begin; row != own_end; ++row) add(place_[idx(*row)]);
      front_of[idx(k)] = number;
      drafts_.push_back(std::move(front));
    }
    for (Draft& front : drafts_) {
      const int last = front.nodes.back();
      std::erase_if(front.rows, [last](int row) { return row <= last; });
      for (const int node : front.nodes) front.width += size(node);
      for (const int row : front.rows) front.height += size(row);
    }
  }

  void amalgamate() {
    std::vector<std::vector<int>> children(drafts_.size());
    for (std::size_t f = 0; f < drafts_.size(); ++f) {
      Draft& front = drafts_[f];
      for (const int c : children[f]) absorb(front, drafts_[idx(c)]);
      if (front.parent >= 0) children[idx(front.parent)].push_back(static_cast<int>(f));
    }
    for (std::size_t f = drafts_.size(); f-- > 0;) {  // whose parent was absorbed hangs higher
      int& parent = drafts_[f].parent;
      if (parent >= 0 && drafts_[idx(parent)].absorbed) parent = drafts_[idx(parent)].parent;
    }
  }

  static void absorb(Draft& front, Draft& child) {
    const std::int64_t zeros =
        front.zeros + child.zeros + child.width * (front.width + front.height - child.height);
    if (!worth_storing(zeros, front.width + child.width, front.height)) return;
    front.zeros = zeros;
    front.width += child.width;
    child.nodes.insert(child.nodes.end(), front.nodes.begin(), front.nodes.end());
    front.nodes = std::move(child.nodes);
    child.absorbed = true;
  }

  [[nodiscard]] FrontTree finished() const {
    std::vector<int> number(drafts_.size(), -1);
    std::vector<int> kept;
    std::vector<int> parents;
    for (std::size_t f = 0; f < drafts_.size(); ++f) {
      if (drafts_[f].absorbed) continue;
      number[f] = static_cast<int>(kept.size());
      kept.push_back(static_cast<int>(f));
    }
    for (const int f : kept) {
      const int parent = drafts_[idx(f)].parent;
      parents.push_back(parent < 0 ? -1 : number[idx(parent)]);
    }
    const std::vector<int> visits = Forest(parents).postorder();
    std::vector<int> visited(visits.size());
    for (std::size_t k = 0; k < visits.size(); ++k) visited[idx(visits[k])] = static_cast<int>(k);

    FrontTree tree;
    tree.order.reserve(order_.size());
    std::vector<int> renumbered(order_.size());
    for (const int visit : visits) {
      const Draft& draft = drafts_[idx(kept[idx(visit)])];
      Front front;
      front.first = static_cast<int>(tree.order.size());
      for (const int node : draft.nodes) {
        renumbered[idx(node)] = static_cast<int>(tree.order.size());
        tree.order.push_back(order_[idx(node)]);
      }
      front.last = static_cast<int>(tree.order.size());
      front.width = static_cast<int>(draft.width);
      front.height = static_cast<int>(draft.height);
      front.parent = parents[idx(visit)] < 0 ? -1 : visited[idx(parents[idx(visit)])];
      tree.fronts.push_back(front);
    }
    for (std::size_t k = 0; k < visits.size(); ++k) {
      Front& front = tree.fronts[k];
      front.rows_begin = static_cast<int>(tree.rows.size());
      for (const int row : drafts_[idx(kept[idx(visits[k])])].rows) {
        tree.rows.push_back(renumbered[idx(row)]);
      }
      front.rows_end = static_cast<int>(tree.rows.size());
      std::sort(tree.rows.begin() + front.rows_begin, tree.rows.end());
    }
    return tree;
  }

  const BlockPattern& pattern_;
  const std::vector<int>& sizes_;
  std::vector<int> order_;  ///< postorder: place along it -> place in the pattern
  std::vector<int> place_;  ///< the other way round
  std::vector<Draft> drafts_;
};

}  // namespace

BlockPattern pattern_of(const std::vector<NodePair>& pairs, const std::vector<int>& place,
                        int places) {
  const auto earlier = [&](const NodePair& pair) {
    return std::min(place[idx(pair[0])], place[idx(pair[1])]);
  };
  const auto is_coupling = [&](const NodePair& pair) {
    return place[idx(pair[0])] >= 0 && place[idx(pair[1])] >= 0 && pair[0] != pair[1];
  };
  std::vector<int> begin(idx(places) + 1, 0);
  for (const NodePair& pair : pairs) {
    if (is_coupling(pair)) ++begin[idx(earlier(pair)) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  std::vector<int> later(idx(begin.back()));
  for (const NodePair& pair : pairs) {
    if (!is_coupling(pair)) continue;
    const int later_place = std::max(place[idx(pair[0])], place[idx(pair[1])]);
    later[idx(next[idx(earlier(pair))]++)] = later_place;
  }
  BlockPattern result;
  result.begin.reserve(begin.size());
  result.later.reserve(later.size());
  for (std::size_t k = 0; k < idx(places); ++k) {
    const auto first = later.begin() + begin[k];
    const auto last = later.begin() + begin[k + 1];
    std::sort(first, last);
    result.later.insert(result.later.end(), first, std::unique(first, last));
    result.begin.push_back(static_cast<int>(result.later.size()));
  }
  return result;
}

FrontTree plan_fronts(const BlockPattern& pattern, const std::vector<int>& sizes) {
  return Planner(pattern, sizes).plan();
}

}  // namespace trussmap::linalg
