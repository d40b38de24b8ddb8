// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_search.hpp"

#include "fit/fit_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap::fitting {
namespace {

Eigen::VectorXd slopes(const NoiseLoss& loss, const LikeliestNoise& at) {
  Eigen::VectorXd result(at.x.size());
  for (Eigen::Index k = 0; k < at.x.size(); ++k) {
    Eigen::VectorXd moved = at.x;
    moved[k] += kSlopeStep;
    result[k] = (loss(moved) - at.loss) / kSlopeStep;
  }
  return result;
}

/// What a logarithm tells, roughly: 4 for each value that its source is checked by.
double rough_curvature(const NoiseLoss& loss, const LikeliestNoise& at, Eigen::Index k) {
  Eigen::VectorXd up = at.x;
  Eigen::VectorXd down = at.x;
  up[k] += 4.0 * kWideStep;
  down[k] -= 4.0 * kWideStep;
  return (loss(up) + loss(down) - 2.0 * at.loss) / std::pow(4.0 * kWideStep, 2);
}

Eigen::MatrixXd rough_inverse(const NoiseLoss& loss, const LikeliestNoise& at) {
  const Eigen::Index n = at.x.size();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    inverse(k, k) = 1.0 / std::max(rough_curvature(loss, at, k), 1.0);
  }
  return inverse;
}

/// The first of ever shorter steps that pays; else the last, which does not.
LikeliestNoise step_along(const NoiseSearch& search, const LikeliestNoise& from,
                          Eigen::VectorXd way) {
  LikeliestNoise next = from;
  for (int k = 0; k < kMostShorter; ++k, way *= kShorter) {
    next.x = search.bounded(from.x + way);
    next.loss = search.loss(next.x);
    if (next.loss < from.loss) break;
  }
  return next;
}

/// s: what was moved by, y: how the slope changed.
void update(Eigen::MatrixXd& inverse, const Eigen::VectorXd& s, const Eigen::VectorXd& y) {
  constexpr double kCurved = 1e-10;  // else it would not stay positive definite
  const double sy = s.dot(y);
  if (sy <= kCurved) return;
  const Eigen::Index n = s.size();
  const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n) - s * y.transpose() / sy;
  inverse = (left * inverse * left.transpose() + s * s.transpose() / sy).eval();
}

}  // namespace

LikeliestNoise likeliest_noise(const NoiseSearch& search, const Eigen::VectorXd& start) {
  LikeliestNoise at{search.bounded(start)};
  at.loss = search.loss(at.x);
  Eigen::VectorXd slope = slopes(search.loss, at);
  Eigen::MatrixXd inverse = rough_inverse(search.loss, at);
  for (int step = 0; step < search.most_steps; ++step) {
    constexpr double kStill = 1e-12;  // lest a step of nothing be divided by
    Eigen::VectorXd way = -(inverse * slope);
    way *= std::min(1.0, kFarthest / std::max(way.cwiseAbs().maxCoeff(), kStill));
    if (-slope.dot(way) < search.least_gain) break;
    LikeliestNoise next = step_along(search, at, std::move(way));
    if (!(next.loss < at.loss)) break;
    if (at.loss - next.loss < search.least_gain) return next;
    const Eigen::VectorXd after = slopes(search.loss, next);
    update(inverse, next.x - at.x, after - slope);
    at = std::move(next);
    slope = after;
  }
  return at;
}

Eigen::MatrixXd curvatures(const NoiseLoss& loss, const Eigen::VectorXd& x) {
  constexpr double h = kWideStep;
  const Eigen::Index n = x.size();
  const double middle = loss(x);
  Eigen::VectorXd up(n);
  Eigen::MatrixXd H(n, n);
  const auto at = [&](Eigen::Index a, double by_a, Eigen::Index b, double by_b) {
    Eigen::VectorXd moved = x;
    moved[a] += by_a;
    moved[b] += by_b;
    return loss(moved);
  };
  for (Eigen::Index a = 0; a < n; ++a) {
    up[a] = at(a, h, a, 0.0);
    H(a, a) = (up[a] + at(a, -h, a, 0.0) - 2.0 * middle) / (h * h);
    for (Eigen::Index b = 0; b < a; ++b) {
      H(a, b) = H(b, a) = (at(a, h, b, h) - up[a] - up[b] + middle) / (h * h);
    }
  }
  return H;
}

}  // namespace trussmap::fitting
