// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/loose_nodes.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace trussmap::linalg {
namespace {

constexpr double kSafeCondition = 1e-13;  // no doubt above

/// Factorises; false where A is not safely definite, after a little more on its diagonal.
bool is_safely_definite(BlockSystem& A) {
  try {
    A.factorise();
    return A.reciprocal_condition() > kSafeCondition;
  } catch (const NotPositiveDefinite&) {
    const Eigen::VectorXd diagonal = A.diagonal();
    const double floor = 1e-30 * diagonal.maxCoeff();
    A.set_diagonal((1.0 + 1e-13) * diagonal + Eigen::VectorXd::Constant(diagonal.size(), floor));
    A.factorise();
    A.set_diagonal(diagonal);
    return false;
  }
}

/// Four rounds of inverse iteration, from a start that is always the same.
Eigen::VectorXd softest_mode(BlockSystem& A, const Eigen::VectorXd& stiffness) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd mode(A.unknowns());
  for (double& entry : mode) entry = uniform(random);
  for (int round = 0; round < 4; ++round) {
    mode = stiffness.cwiseProduct(mode);
    A.solve_in_place(mode);
    mode /= std::sqrt(mode.cwiseAbs2().dot(stiffness));
  }
  return mode;
}

}  // namespace

std::vector<int> find_loose_nodes(BlockSystem& A,
                                  const std::function<double(const Eigen::VectorXd&)>& strain,
                                  const LooseLimits& limits) {
  constexpr double kShare = 1e-3;  // of the largest motion, to be worth naming
  if (A.unknowns() == 0 || is_safely_definite(A)) return {};
  const Eigen::VectorXd diagonal = A.diagonal();
  const Eigen::VectorXd stiffness = diagonal.cwiseMax(limits.stiffness * diagonal.maxCoeff());
  const Eigen::VectorXd mode = softest_mode(A, stiffness);
  if (strain(mode) > limits.strain) return {};

  std::vector<double> moves(idx(A.nodes()), 0.0);
  for (int node = 0; node < A.nodes(); ++node) {
    for (int k = 0; k < A.size(node); ++k) {
      const int at = A.offset(node) + k;
      moves[idx(node)] = std::max(moves[idx(node)], std::abs(mode[at]) * std::sqrt(stiffness[at]));
    }
  }
  const double largest = *std::max_element(moves.begin(), moves.end());
  std::vector<int> loose;
  for (int node = 0; node < A.nodes(); ++node) {
    if (moves[idx(node)] > kShare * largest) loose.push_back(node);
  }
  std::stable_sort(loose.begin(), loose.end(),
                   [&moves](int a, int b) { return moves[idx(a)] > moves[idx(b)]; });
  return loose;
}

}  // namespace trussmap::linalg
