// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot that explores: unknown ways first, then where a drive takes most uncertainty out of the
// map per metre, and home by the surest way. What it needs of the library is MapBuilder.
#pragma once

#include "trussmap/map_builder.hpp"
#include "world.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::explore {

class Explorer {
 public:
  Explorer(World& world, const MapBuilderOptions& options);

  /// Drives until no way is unknown and, if that took less, about `way` metres; then home.
  /// `arrived` is called after each arrival.
  void explore(double way, const std::function<void(const Arrival&)>& arrived);

  [[nodiscard]] const MapBuilder& map() const { return map_; }

 private:
  /// Where a way out of a landmark leads, once it was driven.
  using WaysOut = std::vector<std::optional<std::string>>;

  void drive(int way);
  void stand_here();
  void follow(const std::vector<int>& landmarks);
  [[nodiscard]] LandmarkGraph driven() const;
  [[nodiscard]] std::optional<int> unknown_way() const;
  [[nodiscard]] std::vector<int> to_nearest_unknown() const;
  [[nodiscard]] std::vector<int> to_most_worth_driving() const;
  [[nodiscard]] double length(const std::vector<int>& path) const;

  World& world_;
  MapBuilder map_;
  std::map<std::string, WaysOut> ways_;  // of the landmarks it has stood on
  std::function<void(const Arrival&)> arrived_;
  double way_ = 0.0;    // m, by its wheels
  int came_from_ = -1;  // landmark
};

}  // namespace trussmap::explore
