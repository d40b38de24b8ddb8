// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/umbmark.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace trussmap {

SquareRound analyse_round(SquareRuns runs, const SquareSetup& setup,
                          const GeometryErrors& in_force) {
  SquareRound round;
  round.runs = std::move(runs);
  round.setup = setup;
  round.in_force = in_force;
  round.clusters = square_clusters(round.runs);
  round.angles = square_angles(round.clusters, setup.side);
  round.exact = solve_square(round.clusters, setup);
  round.formulas = umbmark(round.clusters, setup);
  round.consistency = square_consistency(round.clusters, setup);
  round.doubts = square_doubts(round.clusters, setup);
  for (std::string& doubt : square_outliers(round.runs)) round.doubts.push_back(std::move(doubt));
  return round;
}

SquareCorrections corrections_after(const SquareRound& round, SquareMethod method) {
  const SquareSolution& found = method == SquareMethod::exact ? round.exact : round.formulas;
  SquareCorrections result;
  result.errors = combined(round.in_force, found.errors());
  const double e_d = result.errors.diameter_ratio;
  // c_L = 2/(E_d + 1) of the product; its relative error is that of the ratio found.
  const double factor_se = 2.0 / std::pow(e_d + 1.0, 2) * round.in_force.diameter_ratio *
                           found.diameter_ratio.standard_error;
  result.wheelbase = found.wheelbase;
  result.left_factor = {result.errors.left_factor(), factor_se, found.diameter_ratio.dof};
  result.right_factor = {result.errors.right_factor(), factor_se, found.diameter_ratio.dof};
  return result;
}

std::vector<SquareRound> square_rounds(std::size_t count, double side, double wheelbase,
                                       const GeometryErrors& in_force, SquareMethod method,
                                       const DriveRound& drive) {
  std::vector<SquareRound> rounds;
  GeometryErrors errors = in_force;
  for (std::size_t k = 0; k < count; ++k) {
    const SquareSetup setup{side, wheelbase * errors.wheelbase_ratio};
    rounds.push_back(analyse_round(drive(k, setup, errors), setup, errors));
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
