// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What tour and merge write.
#pragma once

#include "results/described.hpp"
#include "trussmap/tour_experiment.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

template <auto kMember>
[[nodiscard]] std::optional<double> of_position(const TourMetrics& one) {
  return one.position_error ? std::optional((*one.position_error).*kMember) : std::nullopt;
}
inline constexpr const char* kOverSeeds = "standard error of that mean over the seeds";

template <>
inline constexpr auto kDescribed<TourMetrics> =
    described(
        field("stretch_error", through(&TourMetrics::stretch_error, &SeedMean::mean),
              "mean of |s - s_true|/s_true over the routes"),
        field("stretch_error_se", through(&TourMetrics::stretch_error, &SeedMean::standard_error),
              kOverSeeds),
        field("orientation_error_rad", through(&TourMetrics::orientation_error, &SeedMean::mean),
              "mean of |theta - theta_true|"),
        field("orientation_error_rad_se",
              through(&TourMetrics::orientation_error, &SeedMean::standard_error), kOverSeeds),
        field("position_error_m", of_position<&SeedMean::mean>,
              "mean distance of the landmarks from the truth; absent where a method gives "
              "no positions")
            .if_any(),
        field("position_error_m_se", of_position<&SeedMean::standard_error>, kOverSeeds).if_any())
        .named("tour_errors");

/// A tour's errors.
struct NumberedTour {
  std::size_t tour = 0;
  const MethodMetrics* methods = nullptr;
};
template <>
inline constexpr auto kDescribed<NumberedTour> = described(
    field("tour", &NumberedTour::tour, "its number").at_least(1.0),
    field(
        "methods", [](const NumberedTour& one) -> const MethodMetrics& { return *one.methods; },
        "by name: raw (single measurements), dead_reckoning, weighted_average, elastic_printed, "
        "elastic, gauss_markov, adjustment"));

/// What tour says.
struct TourReport {
  const TourResult* result = nullptr;
  bool aligned = false;
};
[[nodiscard]] inline std::vector<NumberedTour> numbered(const TourReport& report) {
  std::vector<NumberedTour> tours;
  for (const MethodMetrics& one : report.result->tours) tours.push_back({tours.size() + 1, &one});
  return tours;
}
template <>
inline constexpr auto kDescribed<TourReport> = described(
    field("aligned", &TourReport::aligned,
          "errors of positions are after the best rotation and translation"),
    field("tours", numbered),
    field("first_sight",
          described(field("before", through(&TourReport::result, &TourResult::first_sight_before)),
                    field("after", through(&TourReport::result, &TourResult::first_sight_after))),
          "the first loop's correction"));

}  // namespace trussmap::results
