// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// g and S of fleet rows (trussmap/fleet.hpp) by one list of columns, and what is left of them when
// some columns are taken as present:
//
//   g_k <- g_k - S_kp g_p/S_pp     S_kl <- S_kl - S_kp S_pl/S_pp     chi^2 <- chi^2 - g_p^2/S_pp
//
// one column p after the other (sweeps). Columns of which nothing is left are passed over. A column
// that a row does not have is 0 there: that row says nothing of it.
#pragma once

#include "trussmap/fleet.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace trussmap::fleet {

/// An effect's columns.
struct FleetBlock {
  bool of_model = false;
  std::string effect;
  std::string channel;
  std::vector<std::string> shape;
  std::vector<Eigen::Index> columns;
};

struct ColumnSums {
  Eigen::VectorXd g;
  Eigen::MatrixXd S;
  Eigen::VectorXd whole;
  double chi2 = 0.0;
  int dof = 0;

  /// max(1, chi^2/dof).
  [[nodiscard]] double dispersion() const;
  void sweep(const std::vector<Eigen::Index>& columns);
};

/// All rows by one list of columns, the model's first.
struct FleetSums {
  std::vector<FleetBlock> blocks;
  std::vector<double> reference;
  std::vector<double> prior_sd;
  std::vector<double> largest;  ///< of all rows
  std::vector<ColumnSums> rows;
  ColumnSums all;

  /// Whether the data tell of a column, and more than was known before: as ScoreTest has it.
  [[nodiscard]] bool is_seen(const ColumnSums& sums, Eigen::Index column, double phi) const;
};

/// Throws InputError where rows are of different models, or there are none.
[[nodiscard]] FleetSums fleet_sums(const std::vector<FleetRow>& rows);

/// Of one effect; `sums`: what is present is swept, `phi` the dispersion that its prior goes by.
[[nodiscard]] PooledTest pooled_test(const FleetSums& fleet, const ColumnSums& sums,
                                     const FleetBlock& block, double phi);

/// Of every candidate by itself.
[[nodiscard]] std::vector<PooledTest> pooled_tests(const FleetSums& fleet);

}  // namespace trussmap::fleet
