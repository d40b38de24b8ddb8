// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/square_ends.hpp"
#include "calibration/welch.hpp"
#include "trussmap/error.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

namespace trussmap {
namespace {

using Eigen::Vector2d;

struct Residual {
  Eigen::Vector4d left = Eigen::Vector4d::Zero();  // cw x, y, ccw x, y
  Eigen::Matrix<double, 4, 2> jacobian;
};

Residual residual_of(const SquareClusters& clusters, const SquareSetup& setup) {
  const SquareEnds ends = square_ends(setup, solve_square(clusters, setup).errors());
  return {ends.left_of(clusters), ends.jacobian()};
}

/// Smaller of the p-values of the two contrasts that no E_d and E_b can change, times two.
double contradiction_p(const Residual& residual, const SquareClusters& clusters) {
  const Eigen::HouseholderQR<Eigen::Matrix<double, 4, 2>> qr(residual.jacobian);
  const Eigen::Matrix4d q = qr.householderQ();
  double smallest = 1.0;
  for (int k = 2; k < 4; ++k) {
    const Eigen::Vector4d contrast = q.col(k);
    const double p = two_sided_p(welch_estimate(contrast.dot(residual.left), contrast.head<2>(),
                                                clusters.cw, contrast.tail<2>(), clusters.ccw));
    if (std::isnan(p)) return p;
    smallest = std::min(smallest, p);
  }
  return std::min(1.0, 2.0 * smallest);
}

SquareClusters exchanged(const SquareClusters& clusters) {
  SquareClusters result = clusters;
  std::swap(result.cw, result.ccw);
  return result;
}

double end_error(const GeometryErrors& errors, double wheelbase, const TestPath& path) {
  return path_error(path, wheelbase, errors).error.head<2>().norm();
}

}  // namespace

SquareConsistency square_consistency(const SquareClusters& clusters, const SquareSetup& setup) {
  const Residual given = residual_of(clusters, setup);
  SquareConsistency result;
  result.residual = given.left.norm() / 2.0;
  try {
    result.residual_exchanged = residual_of(exchanged(clusters), setup).left.norm() / 2.0;
  } catch (const SolveError&) {
    result.residual_exchanged = std::numeric_limits<double>::infinity();
  }
  result.p_value = contradiction_p(given, clusters);
  return result;
}

std::vector<std::string> square_doubts(const SquareClusters& clusters, const SquareSetup& setup) {
  constexpr double kSureContradiction = 1e-3;
  constexpr double kClearlyBetter = 0.3;  // residual after / before exchanging the labels
  constexpr double kSuspectShare = 0.25;  // of the side: no wheeled robot is that far off
  constexpr double kRoomSize = 100.0;     // m
  std::vector<std::string> doubts;
  const double largest = clusters.largest_offset.value;
  if (!(clusters.sem > 0.0)) {
    doubts.push_back(
        "all runs of each direction are equal, so that no standard errors can be "
        "stated; expected separate drives, each measured anew");
  }
  if (setup.side > kRoomSize) {
    doubts.push_back(fmt::format("a side of {:g} m is unusual; --side is in metres", setup.side));
  }
  if (setup.wheelbase >= setup.side) {
    doubts.push_back(
        fmt::format("a wheelbase of {:g} m is not less than the side of {:g} m; both "
                    "are in metres",
                    setup.wheelbase, setup.side));
  }
  if (largest > kSuspectShare * setup.side) {
    doubts.push_back(
        fmt::format("a centre of gravity is {:.3g} m off after a square of {:g} m; x "
                    "and y are in metres, absolute - calculated",
                    largest, setup.side));
  }
  const SquareConsistency consistency = square_consistency(clusters, setup);
  const bool contradicts = std::isnan(consistency.p_value)
                               ? consistency.residual > 0.1 * largest
                               : consistency.p_value < kSureContradiction;
  if (!contradicts) return doubts;
  if (consistency.residual_exchanged < kClearlyBetter * consistency.residual) {
    doubts.push_back(fmt::format(
        "x and y contradict each other (the fit misses the centres by {:.2g} m), and would not "
        "({:.2g} m) if the labels cw and ccw were exchanged, or y had the other sign; expected ccw "
        "= turning left, and y to the left of the first leg",
        consistency.residual, consistency.residual_exchanged));
  } else if (consistency.residual > 0.1 * largest) {
    doubts.push_back(fmt::format(
        "E_d and E_b alone do not explain the runs: the fit misses the centres by {:.2g} m; check "
        "the start heading, the side and how the end positions were measured",
        consistency.residual));
  }
  return doubts;
}

std::vector<std::string> square_outliers(const SquareRuns& runs) {
  constexpr std::size_t kLeast = 4;
  constexpr double kFar = 10.0;  // standard deviations: 0.3 % false alarms in 5 + 5 runs
  std::vector<std::string> doubts;
  for (const auto& [name, sample] : {std::pair("cw", &runs.cw), std::pair("ccw", &runs.ccw)}) {
    if (sample->size() < kLeast) continue;
    for (std::size_t k = 0; k < sample->size(); ++k) {
      std::vector<Eigen::Vector2d> others = *sample;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const SampleMean rest = sample_mean(others);
      const double scatter = std::sqrt(0.5 * rest.covariance.trace() * rest.count);
      const double distance = ((*sample)[k] - rest.mean).norm();
      if (scatter <= 0.0 || distance <= kFar * scatter) continue;
      doubts.push_back(fmt::format(
          "run {} of direction {} ends {:.2g} m from the others, which scatter by {:.2g} m; is its "
          "label right, did a wheel slip, was it measured well?",
          k + 1, name, distance, scatter));
    }
  }
  return doubts;
}

PathTuning tune_by_path(const GeometryErrors& errors, const SquareSetup& setup,
                        const TestPath& path) {
  constexpr double kReach = 0.3;  // of the ratio that makes every turn a quarter turn
  constexpr int kBits = 40;
  const auto error_of = [&](double ratio, const TestPath& driven) {
    // The robot calculates with the tuned wheelbase; its geometry is off by what that leaves.
    return end_error({errors.diameter_ratio, errors.wheelbase_ratio / ratio, errors.scale},
                     setup.wheelbase * ratio, driven);
  };
  const double middle = errors.wheelbase_ratio / errors.scale;
  PathTuning result;
  result.wheelbase_ratio =
      boost::math::tools::brent_find_minima([&](double at) { return error_of(at, path); },
                                            middle * (1.0 - kReach), middle * (1.0 + kReach), kBits)
          .first;
  result.error_before = error_of(1.0, path);
  result.error_after = error_of(result.wheelbase_ratio, path);
  result.square_cw = error_of(result.wheelbase_ratio, square_path(setup.side, Direction::cw));
  result.square_ccw = error_of(result.wheelbase_ratio, square_path(setup.side, Direction::ccw));
  return result;
}

OneWayTuning tune_one_way(const GeometryErrors& errors, const SquareSetup& setup,
                          Direction driven) {
  const PathTuning tuned = tune_by_path(errors, setup, square_path(setup.side, driven));
  OneWayTuning result;
  result.wheelbase_ratio = tuned.wheelbase_ratio;
  result.error_before = tuned.error_before;
  result.error_same_way = driven == Direction::cw ? tuned.square_cw : tuned.square_ccw;
  result.error_other_way = driven == Direction::cw ? tuned.square_ccw : tuned.square_cw;
  return result;
}

}  // namespace trussmap
