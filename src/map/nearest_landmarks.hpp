// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which landmarks are nearest to a point: a spatial index that follows the landmarks about.
#pragma once

#include "trussmap/planar.hpp"

#include <memory>
#include <vector>

namespace trussmap {

class NearestLandmarks {
 public:
  NearestLandmarks();
  ~NearestLandmarks();

  void insert(int landmark, const Vector2& position);
  void move(int landmark, const Vector2& from, const Vector2& to);

  /// The `count` nearest, in ascending order of their numbers.
  [[nodiscard]] std::vector<int> nearest(const Vector2& to, int count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace trussmap
