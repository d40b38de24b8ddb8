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
using namespace calibration;

namespace {

using Eigen::Vector2d;

constexpr double kUnseen = 1e-6;  // m: less no tape measures, and rounding may be

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

bool centres_contradict(const SquareConsistency& consistency, const SquareClusters& clusters) {
  constexpr double kSureContradiction = 1e-3;
  constexpr double kShare = 0.1;  // of the error, where there is no scatter to judge by
  if (consistency.residual < kUnseen) return false;
  return std::isnan(consistency.p_value)
             ? consistency.residual > kShare * clusters.largest_offset.value
             : consistency.p_value < kSureContradiction;
}

constexpr Estimate SquareSolution::*kFigures[] = {
    &SquareSolution::alpha,           &SquareSolution::beta,        &SquareSolution::diameter_ratio,
    &SquareSolution::wheelbase_ratio, &SquareSolution::left_factor, &SquareSolution::right_factor,
    &SquareSolution::wheelbase};

/// Each figure's error, and `by`'s beside it.
void widen(SquareSolution& solution, const SquareSolution& by) {
  for (const auto figure : kFigures) {
    const Estimate& other = by.*figure;
    solution.*figure = also_by(solution.*figure, 1.0, {0.0, other.standard_error, other.dof});
  }
}

/// Centres as uncertain as what two unknowns leave of their four coordinates says, E_s certain.
SquareClusters as_left(const SquareClusters& clusters, double residual) {
  SquareClusters result = clusters;
  // The residual is a mean over four coordinates, of which two are free to contradict.
  const double variance = 2.0 * residual * residual;
  for (SampleMean* one : {&result.cw, &result.ccw}) {
    one->covariance = variance * Eigen::Matrix2d::Identity();
    one->count = 2;
  }
  return result;
}

/// Two figures for one thing that are apart by d: each is off by d / sqrt(2), as far as these tell.
SquareSolution as_headings_differ(const SquareSolution& exact, const SquareHeadings& headings,
                                  const SquareSetup& setup) {
  const auto apart = [](double d) { return Estimate{0.0, std::abs(d) / std::sqrt(2.0), 1.0}; };
  const auto times = [](double factor, Estimate one) {
    one.standard_error *= factor;
    return one;
  };
  SquareSolution by;
  by.alpha = apart(headings.alpha_excess.value);
  by.beta = apart(headings.beta_excess.value);
  by.diameter_ratio = apart(headings.diameter_ratio.value - exact.diameter_ratio.value);
  by.wheelbase_ratio = apart(headings.wheelbase_ratio.value - exact.wheelbase_ratio.value);
  const double per_ratio =
      2.0 * exact.scale / std::pow(exact.diameter_ratio.value + 1.0, 2);  // of c_L and c_R
  by.left_factor = by.right_factor = times(per_ratio, by.diameter_ratio);
  by.wheelbase = times(setup.wheelbase, by.wheelbase_ratio);
  return by;
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

}  // namespace trussmap

namespace trussmap::calibration {

void widen_errors(SquareRound& round) {
  SquareSetup certain = round.setup;
  certain.scale = {round.setup.scale.value, 0.0, 0.0};
  if (centres_contradict(round.consistency, round.clusters)) {
    const SquareClusters left = as_left(round.clusters, round.consistency.residual);
    widen(round.exact, solve_square(left, certain));
    widen(round.formulas, umbmark(left, certain));
  }
  if (round.headings && !heading_doubts(*round.headings).empty()) {
    const SquareSolution by = as_headings_differ(round.exact, *round.headings, round.setup);
    widen(round.exact, by);
    widen(round.formulas, by);
  }
}

}  // namespace trussmap::calibration

namespace trussmap {

std::vector<std::string> square_doubts(const SquareClusters& clusters, const SquareSetup& setup) {
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
    doubts.push_back(fmt::format(
        "a centre of gravity is {:.3g} m off after a square of {:g} m; x "
        "and y are in metres (these could be centimetres, 100 times too long), absolute - "
        "calculated",
        largest, setup.side));
  }
  const SquareConsistency consistency = square_consistency(clusters, setup);
  if (!centres_contradict(consistency, clusters)) return doubts;
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
      if (scatter <= 0.0 || distance <= std::max(kFar * scatter, kUnseen)) continue;
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
