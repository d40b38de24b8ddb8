// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/end_moments.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace trussmap::calibration {
namespace {

using Complex = std::complex<double>;
constexpr Complex kI{0.0, 1.0};

/// lag: E z less the noise-free z; zw = E zw; about their means: zu = E zu, zcu = E z conj(u),
/// z2 = E z^2, zcz = E |z|^2. All are as small as the noise, so that nothing cancels.
enum Moment { lag, zw, zu, zcu, z2, zcz, moments };
using State = Eigen::Array<Complex, moments, 1>;

/// A segment of the path, per unit of its parameter from 0 to 1.
struct Segment {
  double distance;         // m
  double turn;             // rad
  double travel_variance;  // of xi, m^2
  double turn_variance;    // of omega, rad^2
  double covariance;       // of both, m rad
};

Segment segment_of(const PathSegment& path, double wheelbase, const Vector2& squared) {
  const double half = 0.5 * wheelbase * path.turn;
  const double left = squared[0] * std::abs(path.distance - half);
  const double right = squared[1] * std::abs(path.distance + half);
  return {path.distance, path.turn, 0.25 * (left + right), (left + right) / (wheelbase * wheelbase),
          0.5 * (right - left) / wheelbase};
}

/// `heading` and `variance` of its error, so far: they give the moments of u in closed form.
State slope(const State& at, const Segment& segment, double heading, double variance) {
  const Complex ahead = std::polar(1.0, heading);  // noise-free u
  const Complex mean_u = ahead * std::exp(-0.5 * variance);
  const Complex mean_u2 = ahead * ahead * std::exp(-2.0 * variance);
  const double variance_u = -std::expm1(-variance);                  // E |u|^2
  const Complex pseudo_u = mean_u * mean_u * std::expm1(-variance);  // E u^2, about means
  const Complex turning = kI * segment.turn - 0.5 * segment.turn_variance;
  const Complex along = segment.distance + 0.5 * kI * segment.covariance;
  State rate;
  rate[lag] = segment.distance * ahead * std::expm1(-0.5 * variance) +
              0.5 * kI * segment.covariance * mean_u;
  rate[zw] = along * kI * variance * mean_u + segment.covariance * mean_u;
  rate[zu] = turning * at[zu] + along * pseudo_u + kI * segment.covariance * mean_u2;
  rate[zcu] = std::conj(turning) * at[zcu] + along * variance_u - kI * segment.covariance;
  rate[z2] = 2.0 * along * at[zu] + segment.travel_variance * mean_u2;
  rate[zcz] = 2.0 * (std::conj(along) * at[zcu]).real() + segment.travel_variance;
  return rate;
}

void drive(State& state, const Segment& segment, double heading, double variance) {
  constexpr double kLongestStep = 0.02;  // rad
  const int steps = 16 + static_cast<int>(std::ceil(std::abs(segment.turn) / kLongestStep));
  const double h = 1.0 / steps;
  const auto rate = [&](const State& at, double part) {
    return slope(at, segment, heading + part * segment.turn,
                 variance + part * segment.turn_variance);
  };
  for (int k = 0; k < steps; ++k) {
    const double part = k * h;
    const State a = rate(state, part);
    const State b = rate(state + 0.5 * h * a, part + 0.5 * h);
    const State c = rate(state + 0.5 * h * b, part + 0.5 * h);
    const State d = rate(state + h * c, part + h);
    state += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
}

}  // namespace

EndMoments end_moments(const TestPath& path, double wheelbase, const Vector2& squared) {
  if (!(wheelbase > 0.0)) throw std::invalid_argument("the wheelbase must be above 0");
  State state = State::Zero();
  double heading = 0.0;
  double variance = 0.0;
  for (const PathSegment& part : path) {
    const Segment segment = segment_of(part, wheelbase, squared);
    drive(state, segment, heading, variance);
    heading += segment.turn;
    variance += segment.turn_variance;
  }
  EndMoments result;
  result.mean = {state[lag].real(), state[lag].imag(), 0.0};
  const double power = state[zcz].real();
  const double xx = 0.5 * (power + state[z2].real());
  const double yy = 0.5 * (power - state[z2].real());
  const double xy = 0.5 * state[z2].imag();
  result.covariance << xx, xy, state[zw].real(),  //
      xy, yy, state[zw].imag(),                   //
      state[zw].real(), state[zw].imag(), variance;
  return result;
}

}  // namespace trussmap::calibration
