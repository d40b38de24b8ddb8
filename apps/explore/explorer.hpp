// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot that explores: unknown ways first, then where a drive takes most uncertainty out of the
// map per metre, and home by the surest way. What it needs of the library is MapBuilder, and paths
// along a LandmarkGraph.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/map_builder.hpp"
#include "world.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace trussmap::explore {

class Explorer {
 public:
  Explorer(World& world, const MapBuilderOptions& options);

  /// Drives until no way is unknown and, if that took less, about `way` metres; then home.
  /// `arrived` is called after each arrival.
  void explore(double way, const std::function<void(const Arrival&)>& arrived);

  /// One leg, by a way out of the landmark it stands on.
  Arrival drive(int way);

  [[nodiscard]] const MapBuilder& map() const { return map_; }

 private:
  static constexpr int kUnknown = -1;
  using Way = std::vector<int>;  // landmarks, from where it stands on

  void stand_here();
  void note(const std::string& landmark);
  void follow(const Way& landmarks);
  [[nodiscard]] Way to_nearest_unknown() const;
  [[nodiscard]] Way most_worth_driving() const;
  void add_ways_on(const Way& so_far, std::vector<Way>& ways) const;
  [[nodiscard]] double length(const Way& way) const;

  World& world_;
  MapBuilder map_;
  int here_ = -1;         ///< where the robot stands
  LandmarkGraph driven_;  ///< landmarks as in the map; routes that were driven, not only seen
  std::map<int, std::vector<int>> ways_out_;  ///< per landmark, where its ways out lead
  std::function<void(const Arrival&)> arrived_;
  double way_ = 0.0;  ///< m, by its wheels
};

}  // namespace trussmap::explore
