// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which landmarks are nearest to a point: a spatial index that follows a map's landmarks about.
//
// Landmarks that move by little keep their places in the index, which is asked for as many more as
// might have come nearer. A refinement moves fifty landmarks by centimetres.
//
// The index only saves time: where it cannot follow a change (for want of memory) it is dropped,
// and built anew when it is next asked. So insert and move never fail.
#pragma once

#include "trussmap/planar.hpp"

#include <memory>
#include <vector>

namespace trussmap::map {

class NearestLandmarks {
 public:
  NearestLandmarks();
  ~NearestLandmarks();

  void insert(int landmark, const Vector2& position) noexcept;
  void move(int landmark, const Vector2& to) noexcept;

  /// Most landmarks have moved: build the index anew when it is next asked.
  void drop() noexcept;

  /// The `count` landmarks nearest to a point, of those at `positions` (which were followed), in
  /// ascending order of their numbers; of those equally far the ones with the lowest numbers.
  [[nodiscard]] std::vector<int> nearest(const std::vector<Vector2>& positions, const Vector2& to,
                                         int count) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace trussmap::map
