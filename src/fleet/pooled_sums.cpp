// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fleet/pooled_sums.hpp"

#include "fit/effect_columns.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

namespace trussmap {
using namespace fleet;

namespace {

/// The model's first, each effect's in order.
struct ModelFirst {
  bool operator()(const FleetColumn& a, const FleetColumn& b) const {
    if (a.of_model != b.of_model) return a.of_model;
    if (a.effect != b.effect) return a.effect < b.effect;
    if (a.channel != b.channel) return a.channel < b.channel;
    if (a.place != b.place) return a.place < b.place;
    return a.shape < b.shape;
  }
};

using Places = std::map<FleetColumn, Eigen::Index, ModelFirst>;

Places places_of(const std::vector<FleetRow>& rows) {
  Places places;
  for (const FleetRow& row : rows) {
    for (const FleetColumn& column : row.columns) places.emplace(column, 0);
  }
  Eigen::Index next = 0;
  for (auto& [column, place] : places) place = next++;
  return places;
}

std::vector<FleetBlock> blocks_of(const Places& places) {
  std::vector<FleetBlock> blocks;
  for (const auto& [column, place] : places) {
    const bool same = !blocks.empty() && blocks.back().of_model == column.of_model &&
                      blocks.back().effect == column.effect &&
                      blocks.back().channel == column.channel && column.place > 0;
    if (!same) blocks.push_back({column.of_model, column.effect, column.channel, {}, {}});
    blocks.back().shape.push_back(column.shape);
    blocks.back().columns.push_back(place);
  }
  return blocks;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::fleet {

double ColumnSums::dispersion() const {
  return dof > 0 ? std::max(1.0, chi2 / dof) : 1.0;
}

void ColumnSums::sweep(const std::vector<Eigen::Index>& columns) {
  for (const Eigen::Index p : columns) {
    const double pivot = S(p, p);
    if (!(pivot > fitting::kLeastShare * whole[p])) continue;
    const Eigen::VectorXd column = S.col(p) / pivot;
    const double g_p = g[p];
    g -= column * g_p;
    S -= (pivot * column) * column.transpose();
    S.row(p).setZero();
    S.col(p).setZero();
    g[p] = 0.0;
    chi2 -= g_p * g_p / pivot;
    --dof;
  }
}

bool FleetSums::is_seen(const ColumnSums& sums, Eigen::Index column, double phi) const {
  const auto k = static_cast<std::size_t>(column);
  const double square = sums.S(column, column);
  const double uncertainty = largest[k] * std::sqrt(phi / std::max(square, 1e-300));
  return largest[k] > 0.0 && square > fitting::kLeastShare * sums.whole[column] &&
         uncertainty < fitting::kLargestUncertainty * prior_sd[k];
}

FleetSums fleet_sums(const std::vector<FleetRow>& rows) {
  if (rows.empty()) throw InputError("fleet", 0, "has no rows, expected one at least");
  for (const FleetRow& row : rows) {
    if (row.model == rows.front().model) continue;
    throw InputError("fleet", 0,
                     fmt::format("robot {} on {} and robot {} on {} are of different models, which "
                                 "do not pool, expected one model for all",
                                 rows.front().robot, rows.front().date, row.robot, row.date));
  }
  const Places places = places_of(rows);
  const auto count = static_cast<Eigen::Index>(places.size());
  FleetSums sums;
  sums.blocks = blocks_of(places);
  sums.reference.assign(places.size(), 0.0);
  sums.prior_sd.assign(places.size(), 0.0);
  sums.largest.assign(places.size(), 0.0);
  const ColumnSums empty{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count),
                         Eigen::VectorXd::Zero(count)};
  sums.all = empty;
  for (const FleetRow& row : rows) {
    ColumnSums one = empty;
    std::vector<Eigen::Index> to;
    for (std::size_t k = 0; k < row.columns.size(); ++k) {
      to.push_back(places.at(row.columns[k]));
      const auto place = static_cast<std::size_t>(to.back());
      sums.reference[place] = row.reference[k];
      sums.prior_sd[place] = row.prior_sd[k];
      sums.largest[place] = std::max(sums.largest[place], row.largest[k]);
      one.whole[to.back()] = row.whole[k];
      one.g[to.back()] = row.g[static_cast<Eigen::Index>(k)];
    }
    for (std::size_t a = 0; a < to.size(); ++a) {
      for (std::size_t b = 0; b < to.size(); ++b) {
        one.S(to[a], to[b]) = row.S(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      }
    }
    one.chi2 = row.chi2;
    one.dof = row.dof;
    sums.all.g += one.g;
    sums.all.S += one.S;
    sums.all.whole += one.whole;
    sums.all.chi2 += one.chi2;
    sums.all.dof += one.dof;
    sums.rows.push_back(std::move(one));
  }
  return sums;
}

PooledTest pooled_test(const FleetSums& fleet, const ColumnSums& sums, const FleetBlock& block,
                       double phi) {
  const std::size_t count = block.columns.size();
  PooledTest test;
  test.of_model = block.of_model;
  test.effect = block.effect;
  test.channel = block.channel;
  test.shape = block.shape;
  test.coefficients.assign(count, 0.0);
  test.sd.assign(count, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> seen;
  for (std::size_t k = 0; k < count; ++k) {
    test.coefficients[k] = fleet.reference[static_cast<std::size_t>(block.columns[k])];
    if (fleet.is_seen(sums, block.columns[k], phi)) seen.push_back(k);
  }
  const auto dof = static_cast<Eigen::Index>(seen.size());
  if (dof == 0) return test;
  Eigen::VectorXd g(dof);
  Eigen::MatrixXd S(dof, dof);
  Eigen::MatrixXd with_prior(dof, dof);
  for (Eigen::Index a = 0; a < dof; ++a) {
    const Eigen::Index at = block.columns[seen[static_cast<std::size_t>(a)]];
    g[a] = sums.g[at];
    for (Eigen::Index b = 0; b < dof; ++b) {
      S(a, b) = sums.S(at, block.columns[seen[static_cast<std::size_t>(b)]]);
    }
  }
  with_prior = S;
  for (Eigen::Index a = 0; a < dof && !block.of_model; ++a) {
    const auto at = static_cast<std::size_t>(block.columns[seen[static_cast<std::size_t>(a)]]);
    const double ratio = fleet.largest[at] / fleet.prior_sd[at];
    with_prior(a, a) += phi * ratio * ratio;
  }
  const linalg::DenseLdlt factor(with_prior);
  const Eigen::VectorXd estimate = -factor.solve(g);
  const Eigen::MatrixXd covariance = factor.inverse();
  test.score = std::max(0.0, -g.dot(estimate));
  const Eigen::VectorXd scale = with_prior.diagonal().cwiseSqrt().cwiseInverse();
  const linalg::SymmetricModes modes =
      linalg::symmetric_modes(scale.asDiagonal() * S * scale.asDiagonal());
  for (Eigen::Index k = 0; k < dof; ++k) test.dof += modes.eigenvalues[k] > 1e-6 ? 1 : 0;
  test.p_value = statistics::chi2_p_value(test.score, test.dof);
  for (Eigen::Index k = 0; k < dof; ++k) {
    const std::size_t place = seen[static_cast<std::size_t>(k)];
    test.coefficients[place] += estimate[k];
    test.sd[place] = std::sqrt(std::max(0.0, covariance(k, k)));
  }
  return test;
}

}  // namespace trussmap::fleet

namespace trussmap {

std::vector<PooledTest> pooled_tests(const std::vector<FleetRow>& rows) {
  return pooled_tests(fleet_sums(rows));
}

}  // namespace trussmap

namespace trussmap::fleet {

std::vector<PooledTest> pooled_tests(const FleetSums& fleet) {
  ColumnSums left = fleet.all;
  for (const FleetBlock& block : fleet.blocks) {
    if (block.of_model) left.sweep(block.columns);
  }
  const double phi = left.dispersion();
  std::vector<PooledTest> tests;
  for (const FleetBlock& block : fleet.blocks) {
    if (!block.of_model) tests.push_back(pooled_test(fleet, left, block, phi));
  }
  return tests;
}

}  // namespace trussmap::fleet
