// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/run_ratio.hpp"
#include "calibration/square_ends.hpp"
#include "calibration/welch.hpp"
#include "trussmap/umbmark.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace calibration;

namespace {

/// The squares say how straight the robot drives, and that depends a little on the scale: each time
/// its error falls by a factor of a thousand or so.
Estimate scale_of(const std::vector<StraightRun>& straight, const SquareRuns& runs,
                  SquareSetup setup) {
  constexpr int kTimes = 3;
  const SquareClusters clusters = square_clusters(runs);
  setup.scale = wheel_scale(straight);
  for (int time = 0; time < kTimes; ++time) {
    const double beta = solve_square(clusters, setup).beta.value;
    setup.scale = wheel_scale(straight, beta / setup.side);
  }
  return setup.scale;
}

}  // namespace

SquareRound analyse_round(SquareRuns runs, const SquareSetup& setup,
                          const GeometryErrors& in_force) {
  SquareRound round;
  round.runs = std::move(runs);
  round.setup = setup;
  round.in_force = in_force;
  round.clusters = square_clusters(round.runs);
  round.angles = square_angles(round.clusters, setup.scale.value * setup.side);
  round.exact = solve_square(round.clusters, setup);
  round.formulas = umbmark(round.clusters, setup);
  round.consistency = square_consistency(round.clusters, setup);
  round.doubts = square_doubts(round.clusters, setup);
  for (std::string& doubt : square_outliers(round.runs)) round.doubts.push_back(std::move(doubt));
  round.headings = square_headings(round.runs, setup, round.exact);
  if (round.headings) {
    for (std::string& doubt : heading_doubts(*round.headings)) {
      round.doubts.push_back(std::move(doubt));
    }
  }
  widen_errors(round);
  return round;
}

SquareCorrections corrections_after(const SquareRound& round, SquareMethod method) {
  const SquareSolution& found = method == SquareMethod::exact ? round.exact : round.formulas;
  SquareCorrections result;
  result.errors = combined(round.in_force, found.errors());
  const double e_d = result.errors.diameter_ratio;
  // c_L = 2 E_s/(E_d + 1) of the product; its relative error is that of the ratio found.
  const double factor_se = result.errors.scale * 2.0 / std::pow(e_d + 1.0, 2) *
                           round.in_force.diameter_ratio * found.diameter_ratio.standard_error;
  const auto factor = [&](double value) {
    return also_by({value, factor_se, found.diameter_ratio.dof}, value / round.setup.scale.value,
                   round.setup.scale);
  };
  result.wheelbase = found.wheelbase;
  result.left_factor = factor(result.errors.left_factor());
  result.right_factor = factor(result.errors.right_factor());
  return result;
}

Estimate wheel_scale(const std::vector<StraightRun>& runs, double turn_per_metre) {
  if (runs.empty()) throw std::invalid_argument("no straight run, expected one or more");
  const auto chord = [&](double reported) {
    const double half = 0.5 * turn_per_metre * reported;
    return half == 0.0 ? reported : reported * std::sin(half) / half;
  };
  std::vector<RunOfRatio> rows;
  for (const StraightRun& run : runs) {
    if (!(run.measured > 0.0) || !(run.reported > 0.0)) {
      throw std::invalid_argument("the lengths of a straight run must be above 0");
    }
    if (std::abs(turn_per_metre * run.reported) >= 2.0 * std::numbers::pi) {
      throw std::invalid_argument("a straight run must not turn by a whole circle");
    }
    rows.push_back({chord(run.reported), run.measured});
  }
  return ratio_of(rows, false).ratio;
}

std::vector<SquareRound> square_rounds(std::size_t count, double side, double wheelbase,
                                       const GeometryErrors& in_force, SquareMethod method,
                                       const DriveRound& drive,
                                       const std::vector<StraightRun>& straight) {
  std::vector<SquareRound> rounds;
  GeometryErrors errors = in_force;
  Estimate left;  // what is not known of E_s once it is corrected
  left.value = 1.0;
  for (std::size_t k = 0; k < count; ++k) {
    SquareSetup setup{side, wheelbase * errors.wheelbase_ratio};
    SquareRuns runs = drive(k, setup, errors);
    setup.scale = k == 0 && !straight.empty() ? scale_of(straight, runs, setup) : left;
    if (k == 0) left = {1.0, setup.scale.standard_error / setup.scale.value, setup.scale.dof};
    rounds.push_back(analyse_round(std::move(runs), setup, errors));
    errors = corrections_after(rounds.back(), method).errors;
  }
  return rounds;
}

std::vector<std::string> all_doubts(const std::vector<SquareRound>& rounds) {
  std::vector<std::string> doubts;
  for (std::size_t k = 0; k < rounds.size(); ++k) {
    for (const std::string& doubt : rounds[k].doubts) {
      doubts.push_back(rounds.size() == 1 ? doubt : fmt::format("round {}: {}", k + 1, doubt));
    }
  }
  return doubts;
}

}  // namespace trussmap
