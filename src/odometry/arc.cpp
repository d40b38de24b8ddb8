// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/odometry/arc.hpp"

#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

double sinc(double x) {
  if (std::abs(x) > 1e-4) return std::sin(x) / x;
  return 1.0 - x * x / 6.0;
}

// (1 - sinc x)/x^2 = sum (-1)^n x^2n / (2n + 3)!; below 0.7 the definition cancels.
double g1(double x) {
  if (std::abs(x) >= 0.7) return (1.0 - sinc(x)) / (x * x);
  double term = 1.0 / 6.0;
  double sum = term;
  for (int n = 1; n < 12; ++n) {
    term *= -x * x / ((2.0 * n + 2.0) * (2.0 * n + 3.0));
    sum += term;
  }
  return sum;
}

// (1/6 - g1(x))/x^2 = sum (-1)^n x^2n / (2n + 5)!
double g2(double x) {
  if (std::abs(x) >= 1.5) return (1.0 / 6.0 - g1(x)) / (x * x);
  double term = 1.0 / 120.0;
  double sum = term;
  for (int n = 1; n < 14; ++n) {
    term *= -x * x / ((2.0 * n + 4.0) * (2.0 * n + 5.0));
    sum += term;
  }
  return sum;
}

}  // namespace

Pose arc_displacement(const WheelTravel& travel, double wheelbase) {
  const double path = 0.5 * (travel.left + travel.right);
  const double turn = (travel.right - travel.left) / wheelbase;
  const double chord = path * sinc(0.5 * turn);
  return {chord * std::cos(0.5 * turn), chord * std::sin(0.5 * turn), turn};
}

Matrix3 arc_covariance(const WheelTravel& travel, double wheelbase, const WheelNoise& noise) {
  if (!(wheelbase > 0.0)) throw std::invalid_argument("the wheelbase must be positive");
  const double B = wheelbase;
  const double D = 0.5 * (travel.left + travel.right);
  const double a = (travel.right - travel.left) / B;
  const double from_left = noise.left * noise.left * std::abs(travel.left);
  const double from_right = noise.right * noise.right * std::abs(travel.right);
  const double c2 = from_right + from_left;
  const double d = from_right - from_left;

  const double h = 0.5 * sinc(0.5 * a) * sinc(0.5 * a);
  const double r = D / B;
  // In the frame of the final heading.
  const double q11 = c2 * ((1.0 - 2.0 * a * a * g1(2.0 * a)) / 4.0 +
                           r * r * 2.0 * a * a * (4.0 * g2(2.0 * a) - g2(a))) +
                     d * r * a * (2.0 * g1(2.0 * a) - g1(a));
  const double q22 =
      c2 * (a * a * g1(2.0 * a) / 2.0 + r * r * 2.0 * g1(2.0 * a)) - d * r * 2.0 * a * g1(2.0 * a);
  const double q12 = c2 * (-a * sinc(a) * sinc(a) / 8.0 + r * r * a * h * h / 2.0) +
                     d * r / 2.0 * (sinc(a) * sinc(a) / 2.0 - a * a * h * h / 2.0);
  const double q13 = c2 * D * a * g1(a) / (B * B) + d * sinc(a) / (2.0 * B);
  const double q23 = c2 * D * h / (B * B) - d * a * h / (2.0 * B);
  const double q33 = c2 / (B * B);

  const Matrix3 Q = (Matrix3() << q11, q12, q13, q12, q22, q23, q13, q23, q33).finished();
  const Matrix3 T = pose_rotation(a);
  return symmetrised(T * Q * T.transpose());
}

Motion arc_motion(const WheelTravel& travel, double wheelbase, const WheelNoise& noise) {
  return {arc_displacement(travel, wheelbase), arc_covariance(travel, wheelbase, noise)};
}

Motion then(const Motion& first, const Motion& second) {
  const Matrix3 T = pose_rotation(first.displacement.heading);
  const Vector2 step = T.topLeftCorner<2, 2>() * second.displacement.position();
  Matrix3 F = Matrix3::Identity();
  F.topRightCorner<2, 1>() = quarter_turn(step);
  return {
      compose(first.displacement, second.displacement),
      symmetrised(F * first.covariance * F.transpose() + T * second.covariance * T.transpose())};
}

}  // namespace trussmap
