// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The tour that answers all questions soonest.
//
//   value   of a question min(1, lambda/lambda wanted); of a tour the least, and the mean of roots
//   greedy  leg by leg: of all routes from here, and all manoeuvres on them changed one by one as
//           long as that helps, what raises the value most per second
//   then    what a tour can do without is taken out of it, and legs are driven otherwise where that
//           is shorter
//
// A value is exact: the tour is simulated, its rows and those of the recordings are taken together
// (drive_information.hpp). Only while a leg is chosen, what it adds is taken from itself and the
// leg before alone, where nothing that is asked goes with the time or the distance since the start.
// Cost: some ten values per leg that a tour has, and hundreds while it is made shorter.
#pragma once

#include "planning/manoeuvres.hpp"
#include "planning/separation.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace trussmap::planning {

struct SearchTask {
  const PlanWorld& world;
  DriveInformation known;       ///< of the recordings and the survey
  std::vector<Effect> effects;  ///< whose columns follow the landmarks
  std::vector<Effect> own;      ///< fitted beside in each drive anew
  std::vector<Question> questions;
  std::vector<Eigen::Index> beside;  ///< columns
  double phi = 1.0;
  double most_time = std::numeric_limits<double>::infinity();    ///< s
  double most_length = std::numeric_limits<double>::infinity();  ///< m
  bool goes_on = true;  ///< something asked goes with the time or the distance since the start
};

struct TourValue {
  std::vector<double> lambdas;  ///< per question
  double least = 0.0;           ///< share of what is wanted, at most 1
  double score = 0.0;           ///< what the search follows
  double time = 0.0;            ///< s
  double length = 0.0;          ///< m
};

/// Columns' Gram matrix of the recordings, and of them with a plan.
[[nodiscard]] Eigen::MatrixXd gram_before(const SearchTask& task);
[[nodiscard]] Eigen::MatrixXd gram_with(const SearchTask& task, const PlanWorld& world,
                                        const DrivePlan& plan);
[[nodiscard]] std::vector<double> lambdas_of(const SearchTask& task, const Eigen::MatrixXd& gram);

/// What is told by a tour alone; nothing where the robot cannot drive it.
[[nodiscard]] std::optional<DriveInformation> told_by(const SearchTask& task,
                                                      const PlannedTour& tour);

struct FoundTour {
  PlannedTour tour;
  TourValue value;
  DriveInformation told;  ///< by the tour alone
};

inline constexpr std::size_t kMostLegs = 60;
inline constexpr std::size_t kMostLegsAlong = 24;  ///< where each value is of the whole tour

[[nodiscard]] FoundTour search_tour(const SearchTask& task);

/// Every route near the start both ways, in all manners: what no such drive tells, none does.
[[nodiscard]] PlannedTour thorough_tour(const PlanWorld& world);

}  // namespace trussmap::planning
