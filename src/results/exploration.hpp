// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What explore writes.
#pragma once

#include "results/common.hpp"
#include "trussmap/monitor.hpp"
#include "trussmap/survey_comparison.hpp"

#include <vector>

namespace trussmap::results {

/// Errors of an explorer's map, each time the robot has driven as far as all routes are long, and
/// at the end.
struct ExploredTour {
  int number = 0;
  double way = 0.0;  ///< m
  int landmarks = 0;
  MapErrors errors;  ///< as the map lies, without a compass aligned
  MapErrors aligned;
};
template <auto kMember>
inline constexpr auto kLies = through(&ExploredTour::errors, kMember);
template <auto kErrors>
[[nodiscard]] double position_of(const ExploredTour& one) {
  return (one.*kErrors).position.value_or(0.0);
}
template <>
inline constexpr auto kDescribed<ExploredTour> =
    described(field("tour", &ExploredTour::number, "its number").at_least(1.0),
              field("way_m", &ExploredTour::way, "driven so far"),
              field("landmarks", &ExploredTour::landmarks, "of the map then").at_least(0.0),
              field("stretch_error", kLies<&MapErrors::stretch>,
                    "sigma: mean of |s - s_true|/s_true over the routes"),
              field("orientation_error_rad", kLies<&MapErrors::orientation>,
                    "rho: mean of |theta - theta_true| over the routes"),
              field("position_error_m", position_of<&ExploredTour::errors>,
                    "mean distance of the landmarks from the truth"),
              field("aligned_error_m", position_of<&ExploredTour::aligned>,
                    "the same after the best rotation and translation"));

/// An alarm on the way, after so many legs.
struct ExploreAlarm {
  long leg = 0;
  FoundEffect found;
};
template <>
inline constexpr auto kDescribed<ExploreAlarm> = described(
    field("leg", &ExploreAlarm::leg, "after which it found that").at_least(1.0),
    field("since_leg", through(&ExploreAlarm::found, &FoundEffect::leg), "the first leg with it")
        .at_least(1.0),
    keys_of("sized", [](const ExploreAlarm& one) {
      return ConstantEffect{&one.found.effect, one.found.sd};
    }));

/// What explore says.
struct ExploreReport {
  int legs = 0;
  double way = 0.0;  ///< m
  int landmarks = 0;
  int found = 0;
  int routes = 0;
  bool aligned = false;
  std::vector<ExploreAlarm> alarms;
  std::vector<ExploredTour> tours;
};
template <>
inline constexpr auto kDescribed<ExploreReport> = described(
    field("legs", &ExploreReport::legs, "driven").at_least(0.0),
    field("way_m", &ExploreReport::way, "driven"),
    field("landmarks", &ExploreReport::landmarks, "of the world").at_least(0.0),
    field("found", &ExploreReport::found, "landmarks of the map").at_least(0.0),
    field("routes", &ExploreReport::routes, "of the map").at_least(0.0),
    field("aligned", &ExploreReport::aligned, "errors are after the best rotation and translation"),
    field("alarms", &ExploreReport::alarms,
          "where the robot found that the model of its wheels had ceased to hold"),
    field("tours", &ExploreReport::tours,
          "errors each time the way was as long as all routes together"));

}  // namespace trussmap::results
