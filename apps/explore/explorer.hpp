// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot that explores: unknown ways first, then where a drive takes most uncertainty out of the
// map per metre, and home by the surest way. On its way it watches its own odometry: where the
// model of its wheels ceases to hold, it makes the map anew with the effect that was found, from
// the leg on with which that began. What it needs of the library is MapBuilder, Monitor, and paths
// along a LandmarkGraph.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/monitor.hpp"
#include "world.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::explore {

/// What the monitor found, and when.
struct Alarm {
  long legs = 0;  ///< driven until then
  FoundEffect found;
};

class Explorer {
 public:
  /// `watches`: whether its monitor does.
  Explorer(World& world, const MapBuilderOptions& options, bool watches = true);

  /// Drives until no way is unknown and, if that took less, about `way` metres; then home.
  /// `arrived` is called after each arrival.
  void explore(double way, const std::function<void(const Arrival&)>& arrived);

  /// One leg, by a way out of the landmark it stands on.
  Arrival drive(int way);

  [[nodiscard]] const MapBuilder& map() const { return map_; }
  /// Each was taken into account when it came.
  [[nodiscard]] const std::vector<Alarm>& alarms() const { return alarms_; }

 private:
  /// What it reads and sees where it stands.
  struct Stand {
    std::string landmark;
    std::size_t ways_out = 0;
    std::optional<double> compass;  ///< rad
    std::vector<Seen> seen;
  };
  struct DrivenLeg {
    int way = 0;  ///< out of where it stood
    Driven driven;
    Stand end;
  };

  [[nodiscard]] Stand look();
  [[nodiscard]] static MeasuredEnd measured_at(const Stand& stand);
  void begin();
  [[nodiscard]] bool sees_failure(const DrivenLeg& leg);
  [[nodiscard]] bool model_fails();
  [[nodiscard]] Monitor fresh_monitor() const;
  [[nodiscard]] Motion motion_of(std::size_t leg) const;
  Arrival take(std::size_t leg);
  static constexpr int kUnknown = -1;
  using Way = std::vector<int>;  // landmarks, from where it stands on

  void stand_at(const Stand& stand);
  void note(const std::string& landmark);
  void follow(const Way& landmarks);
  [[nodiscard]] Way to_nearest_unknown() const;
  [[nodiscard]] Way most_worth_driving() const;
  void add_ways_on(const Way& so_far, std::vector<Way>& ways) const;
  [[nodiscard]] double length(const Way& way) const;

  World& world_;
  MapBuilderOptions options_;
  bool watches_;
  Model model_;  ///< of its odometry, as it was at first
  std::vector<Alarm> alarms_;
  int unclear_ = 0;  ///< legs since an alarm that is not named clearly yet
  Stand start_;
  Monitor monitor_;
  std::vector<DrivenLeg> legs_;  ///< all of them, to make the map anew
  MapBuilder map_;
  int here_ = -1;         ///< where the robot stands
  LandmarkGraph driven_;  ///< landmarks as in the map; routes that were driven, not only seen
  std::map<int, std::vector<int>> ways_out_;  ///< per landmark, where its ways out lead
  std::function<void(const Arrival&)> arrived_;
  double way_ = 0.0;  ///< m, by its wheels
};

}  // namespace trussmap::explore
