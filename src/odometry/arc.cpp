// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/arc.hpp"

#include "drive/body_motion.hpp"

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
  const BodyMotion motion = drive::body_motion(travel, wheelbase);
  return arc_displacement(motion.forward, motion.turn);
}

Pose arc_displacement(double path, double turn) {
  const double chord = path * sinc(0.5 * turn);
  return {chord * std::cos(0.5 * turn), chord * std::sin(0.5 * turn), turn};
}

ArcNoise wheel_arc_noise(const WheelTravel& travel, double wheelbase, const WheelNoise& noise) {
  if (!(wheelbase > 0.0)) throw std::invalid_argument("the wheelbase must be positive");
  const double from_left = noise.left * noise.left * std::abs(travel.left);
  const double from_right = noise.right * noise.right * std::abs(travel.right);
  const double c2 = from_right + from_left;
  const double d = from_right - from_left;
  return {c2 / 4.0, c2 / (wheelbase * wheelbase), d / (2.0 * wheelbase)};
}

Matrix3 arc_covariance(double path, double turn, const ArcNoise& noise) {
  // A unit of noise where u of the arc remains moves the end by e (along) and b (heading), in the
  // frame of the final heading: e = (cos ua, -sin ua, 0), b = (D (1 - cos ua)/a, D sin(ua)/a, 1).
  // Below: the integrals over u from 0 to 1 of e e', b b' and e b' + b e'.
  const double D = path;
  const double a = turn;
  const double h = 0.5 * sinc(0.5 * a) * sinc(0.5 * a);
  const double s2 = sinc(a) * sinc(a);
  const double g1_a = g1(a);
  const double g1_2a = g1(2.0 * a);
  Matrix3 along = Matrix3::Zero();
  along(0, 0) = 1.0 - 2.0 * a * a * g1_2a;
  along(1, 1) = 2.0 * a * a * g1_2a;
  along(0, 1) = -0.5 * a * s2;
  Matrix3 heading;
  heading(0, 0) = D * D * 2.0 * a * a * (4.0 * g2(2.0 * a) - g2(a));
  heading(1, 1) = D * D * 2.0 * g1_2a;
  heading(0, 1) = D * D * 0.5 * a * h * h;
  heading(0, 2) = D * a * g1_a;
  heading(1, 2) = D * h;
  heading(2, 2) = 1.0;
  Matrix3 shared = Matrix3::Zero();
  shared(0, 0) = 2.0 * D * a * (2.0 * g1_2a - g1_a);
  shared(1, 1) = -4.0 * D * a * g1_2a;
  shared(0, 1) = 0.5 * D * (s2 - a * a * h * h);
  shared(0, 2) = sinc(a);
  shared(1, 2) = -a * h;

  Matrix3 Q = noise.along * along + noise.heading * heading + noise.shared * shared;
  Q.triangularView<Eigen::StrictlyLower>() = Q.transpose();
  const Matrix3 T = pose_rotation(a);
  return symmetrised(T * Q * T.transpose());
}

Pose slanting_displacement(const Vector2& way, double turn) {
  const Vector2 chord = sinc(0.5 * turn) * (rotation(0.5 * turn) * way);
  return {chord.x(), chord.y(), turn};
}

Matrix3 slanting_covariance(const Vector2& way, double turn, const ArcNoise& noise) {
  const bool lateral =
      noise.lateral != 0.0 || noise.along_lateral != 0.0 || noise.heading_lateral != 0.0;
  if (way.y() == 0.0 && !lateral) return arc_covariance(way.x(), turn, noise);
  // In axes turned so that the body moves ahead: D its way, and noise along and across it.
  const double D = way.norm();
  const double direction = D > 0.0 ? std::atan2(way.y(), way.x()) : 0.0;
  const Matrix2 R = rotation(direction);
  Matrix2 moved;
  moved << noise.along, noise.along_lateral, noise.along_lateral, noise.lateral;
  moved = (R.transpose() * moved * R).eval();
  const Vector2 with_heading = R.transpose() * Vector2(noise.shared, noise.heading_lateral);
  const Matrix3 ahead = arc_covariance(D, turn, {moved(0, 0), noise.heading, with_heading.x()});
  // A unit of noise across, where u of the arc remains: c = (sin ua, cos ua, 0). With e and b of
  // the covariance above, the integrals over u of c c', e c' + c e' and c b' + b c'.
  const double a = turn;
  const double h = 0.5 * sinc(0.5 * a) * sinc(0.5 * a);
  const double s2 = sinc(a) * sinc(a);
  const double g1_a = g1(a);
  const double g1_2a = g1(2.0 * a);
  Matrix3 across = Matrix3::Zero();
  across(0, 0) = 2.0 * a * a * g1_2a;
  across(1, 1) = 1.0 - 2.0 * a * a * g1_2a;
  across(0, 1) = 0.5 * a * s2;
  Matrix3 along_across = Matrix3::Zero();
  along_across(0, 0) = a * s2;
  along_across(1, 1) = -a * s2;
  along_across(0, 1) = sinc(2.0 * a);
  Matrix3 heading_across = Matrix3::Zero();
  heading_across(0, 0) = D * (2.0 * h - s2);
  heading_across(1, 1) = D * s2;
  heading_across(0, 1) = D * a * (4.0 * g1_2a - g1_a);
  heading_across(0, 2) = a * h;
  heading_across(1, 2) = sinc(a);

  Matrix3 Q = moved(1, 1) * across + moved(0, 1) * along_across + with_heading.y() * heading_across;
  Q.triangularView<Eigen::StrictlyLower>() = Q.transpose();
  const Matrix3 T = pose_rotation(a);
  const Matrix3 back = pose_rotation(direction);
  return symmetrised(back * (ahead + T * Q * T.transpose()) * back.transpose());
}

Matrix3 arc_covariance(const WheelTravel& travel, double wheelbase, const WheelNoise& noise) {
  const BodyMotion motion = drive::body_motion(travel, wheelbase);
  return arc_covariance(motion.forward, motion.turn, wheel_arc_noise(travel, wheelbase, noise));
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

LandmarkOffset seen_at(double range, double bearing, double sd_range, double sd_bearing) {
  const bool finite = std::isfinite(range) && std::isfinite(bearing) && std::isfinite(sd_range) &&
                      std::isfinite(sd_bearing);
  if (!finite || !(range > 0.0) || !(sd_range > 0.0) || !(sd_bearing >= 0.0)) {
    throw std::invalid_argument(
        "a sighting needs a finite range and bearing with their standard deviations, the range's "
        "above 0");
  }
  const Matrix2 R = rotation(bearing);
  const Vector2 variances(sd_range * sd_range, range * range * sd_bearing * sd_bearing);
  return {R.col(0) * range, R * variances.asDiagonal() * R.transpose()};
}

}  // namespace trussmap
