// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Groups of landmarks, groups of groups, and so on: the scales at which a truss is relaxed.
//
//   level 0   o o o o   o o o o   o o o       groups of up to kSize landmarks
//             '-------' '-------' '-----'
//   level 1   '-----------------------'       groups of up to kSize of these
//
// Groups grow along the way: a new landmark joins the group of the one it was reached from, until
// that is full. The first landmark is in none: it is held.
#pragma once

#include "geometry/index.hpp"

#include <functional>
#include <vector>

namespace trussmap::map {

class ScaleGroups {
 public:
  static constexpr int kSize = 4;

  /// A landmark that was reached from another one, of a lower number; the next in number.
  void add(int landmark, int from);
  /// A route ties two landmarks that are there.
  void tie(int a, int b);
  void clear() { levels_.clear(); }

  [[nodiscard]] int levels() const { return static_cast<int>(levels_.size()); }
  [[nodiscard]] int groups(int level) const {
    return static_cast<int>(levels_[idx(level)].members.size());
  }
  /// Group of a landmark at a level, -1: in none.
  [[nodiscard]] int group_of(int level, int landmark) const;
  /// Group of a group at the next level, -1: in none.
  [[nodiscard]] int parent(int level, int group) const {
    const std::vector<int>& above = levels_[idx(level) + 1].group;
    return idx(group) < above.size() ? above[idx(group)] : -1;
  }
  /// Landmarks of a group.
  void members(int level, int group, std::vector<int>& landmarks) const;
  /// A landmark of the group: the first that came.
  [[nodiscard]] int seed(int level, int group) const {
    return levels_[idx(level)].seed[idx(group)];
  }

  /// About the `count` groups nearest to those of landmarks a and b, found along ties: `distance`
  /// tells how far a group's first landmark is.
  [[nodiscard]] std::vector<int> nearest(int level, int a, int b, int count,
                                         const std::function<double(int landmark)>& distance) const;

 private:
  struct Level {
    std::vector<int> group;                 ///< per member of the level below: its group, or -1
    std::vector<std::vector<int>> members;  ///< per group: of the level below
    std::vector<std::vector<int>> ties;     ///< per group: groups tied to it
    std::vector<int> seed;                  ///< per group: its first landmark
  };

  std::vector<Level> levels_;
};

}  // namespace trussmap::map
