// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/misfit.hpp"

#include "check/findings.hpp"
#include "check/still_limits.hpp"
#include "geometry/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <optional>

#include <Eigen/Dense>

namespace trussmap::check {
namespace {

constexpr double kSampleTurn = 0.5;         // rad, of a sample
constexpr double kWay = 0.5;                // m, of a sample
constexpr double kLongestSample = 10.0;     // s
constexpr std::size_t kFewestSamples = 10;  // samples

/// Mean of what is at most 1; nothing of too few.
class MeanMisfit {
 public:
  void add(double difference, double size) {
    sum_ += size > 0.0 ? std::min(difference / size, 1.0) : 0.0;
    ++count_;
  }
  [[nodiscard]] std::optional<double> value() const {
    if (count_ < kFewestSamples) return std::nullopt;
    return sum_ / static_cast<double>(count_);
  }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Turns of the columns and of something else, summed up to half a radian of either.
class TurnMisfit {
 public:
  void add(double by_columns, double by_other) {
    told_ = told_ && std::abs(by_columns) < kUntold;
    columns_ += by_columns;
    other_ += by_other;
    const double size = std::max(std::abs(columns_), std::abs(other_));
    if (size < kSampleTurn && told_) return;
    mean_.add(told_ ? std::abs(columns_ - other_) : size, size);
    columns_ = other_ = 0.0;
    told_ = true;
  }
  [[nodiscard]] std::optional<double> value() const { return mean_.value(); }

 private:
  MeanMisfit mean_;
  double columns_ = 0.0;
  double other_ = 0.0;
  bool told_ = true;
};

/// A sensor's unit and sign, rad per unit.
constexpr std::array<double, 4> kUnits{1.0, -1.0, geometry::kDegree, -geometry::kDegree};

struct Window {
  const DrivenRecording& recording;
  const MotionRows& drive;
  const Track& track;
  MisfitFrame frame;

  [[nodiscard]] bool holds(double t) const { return t >= frame.from && t <= frame.to; }
};

std::optional<double> compass_misfit(const Window& in, double unit) {
  TurnMisfit misfit;
  double last = kAbsent;
  double turned = 0.0;
  const std::vector<double>& heading = in.recording.drive.heading;
  for (std::size_t row = 0; row < heading.size(); ++row) {
    if (!in.holds(in.drive.t[row])) continue;
    turned += in.drive.turn[row];
    if (std::isnan(heading[row])) continue;
    if (!std::isnan(last)) misfit.add(turned, wrap_angle(unit * (heading[row] - last)));
    last = heading[row];
    turned = 0.0;
  }
  return misfit.value();
}

std::optional<double> gyro_misfit(const Window& in, double unit) {
  TurnMisfit misfit;
  const std::vector<double>& rate = in.recording.drive.yaw_rate;
  for (std::size_t row = 0; row < rate.size(); ++row) {
    if (std::isnan(rate[row]) || !in.holds(in.drive.t[row])) continue;
    misfit.add(in.drive.turn[row], unit * rate[row] * in.drive.duration(row));
  }
  return misfit.value();
}

/// How a truth may have been written down.
struct TruthVariant {
  double heading = 1.0;  ///< rad per unit, negative: clockwise
  double y = 1.0;        ///< -1: mirrored
  bool free = false;     ///< of any unit, and turned against the robot
};

std::optional<double> truth_misfit(const Window& in, const TruthVariant& as) {
  TurnMisfit turns;
  using Complex = std::complex<double>;
  std::vector<std::pair<Complex, Complex>> ways;  // by columns, by the truth, robot's axes
  const TruthRow* before = nullptr;
  const TruthRow* start = nullptr;
  for (const TruthRow& row : in.recording.truth) {
    if (!in.holds(row.t) || row.t < in.drive.start() || row.t > in.drive.t.back()) continue;
    if (before != nullptr && row.t - before->t <= kLongestSample) {
      turns.add(in.track.at(row.t).heading - in.track.at(before->t).heading,
                wrap_angle(as.heading * (row.heading - before->heading)));
    }
    before = &row;
    if (start == nullptr || row.t - start->t > kLongestSample) {
      start = &row;
      continue;
    }
    const Pose way = relative(in.track.at(start->t), in.track.at(row.t));
    const Complex shown(way.x, way.y);
    const Complex true_way = Complex(row.x - start->x, as.y * (row.y - start->y)) *
                             std::polar(1.0, -as.heading * start->heading);
    if (std::max(std::abs(shown), std::abs(true_way)) < kWay) continue;
    ways.emplace_back(shown, true_way);
    start = &row;
  }
  Complex by = 1.0;
  if (as.free) {
    Complex sum = 0.0;
    double squares = 0.0;
    for (const auto& [shown, true_way] : ways) {
      sum += std::conj(shown) * true_way;
      squares += std::norm(shown);
    }
    if (squares > 0.0 && std::abs(sum) > 0.0) by = sum / squares;
  }
  MeanMisfit misfit;
  for (const auto& [shown, true_way] : ways) {
    misfit.add(std::abs(by * shown - true_way), std::max(std::abs(by * shown), std::abs(true_way)));
  }
  const std::optional<double> turn = turns.value();
  const std::optional<double> way = misfit.value();
  if (!turn && !way) return std::nullopt;
  return std::max(turn.value_or(0.0), way.value_or(0.0));
}

/// Corners between legs that follow each other, the first one along the x axis.
std::optional<double> corner_misfit(const Window& in, Witness witness, bool mirrored,
                                    bool any_unit) {
  std::vector<SurveyLeg> legs =
      witness == Witness::fixes
          ? legs_by_fixes(in.recording, in.track)
          : legs_by_way(in.recording, surveyed_places(in.recording), in.track);
  std::erase_if(legs, [&](const SurveyLeg& leg) { return !in.holds(leg.t); });
  double unit = 1.0;
  if (any_unit) {
    double measured = 0.0;
    double surveyed = 0.0;
    for (const SurveyLeg& leg : legs) {
      measured += leg.measured.norm();
      surveyed += leg.surveyed.norm();
    }
    if (surveyed > 0.0 && measured > 0.0) unit = measured / surveyed;
  }
  MeanMisfit misfit;
  for (std::size_t k = 1; k < legs.size(); ++k) {
    const auto corner = [&](const Vector2& a, const Vector2& b) {
      return std::polar(b.norm(), direction(b) - direction(a));
    };
    const double a = legs[k - 1].measured.norm();
    const double true_a = unit * legs[k - 1].surveyed.norm();
    const std::complex<double> b = corner(legs[k - 1].measured, legs[k].measured);
    std::complex<double> true_b = unit * corner(legs[k - 1].surveyed, legs[k].surveyed);
    if (mirrored) true_b = std::conj(true_b);
    misfit.add(std::abs(a - true_a) + std::abs(b - true_b),
               std::max(a, true_a) + std::max(std::abs(b), std::abs(true_b)));
  }
  return misfit.value();
}

/// What columns say beyond the body's motion, by what one negated column does.
std::optional<double> surplus(const Window& in) {
  constexpr double kOneNegated = 0.5;
  const auto columns = static_cast<Eigen::Index>(in.drive.wheels.size());
  if (columns < 3 || in.drive.wheels.back().steers) return std::nullopt;
  Eigen::MatrixXd motion(3, columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const auto& by = in.drive.wheels[static_cast<std::size_t>(k)].by_reading.front();
    motion.col(k) << by[0], by[1], by[2];
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse(motion);
  if (inverse.rank() == columns) return std::nullopt;
  const Eigen::MatrixXd beyond =
      Eigen::MatrixXd::Identity(columns, columns) - inverse.pseudoInverse() * motion;
  double sum = 0.0;
  double all = 0.0;
  Eigen::VectorXd reading(columns);
  for (std::size_t row = 0; row < in.drive.rows(); ++row) {
    if (!in.holds(in.drive.t[row])) continue;
    for (Eigen::Index k = 0; k < columns; ++k) {
      reading[k] = in.drive.wheels[static_cast<std::size_t>(k)].reading[row];
    }
    sum += (beyond * reading).norm();
    all += reading.norm();
  }
  if (!(all > kWay)) return std::nullopt;
  return std::min(sum / (kOneNegated * all), 1.0);
}

std::optional<double> views_in(const Window& in, double range, double bearing) {
  return views_misfit(in.recording, in.track, range, bearing, in.frame.from, in.frame.to);
}

using Variants = std::vector<std::function<std::optional<double>()>>;

Variants truth_variants(const Window& in) {
  Variants variants{[&in] { return truth_misfit(in, {}); }};
  for (const double unit : kUnits) {
    for (const double y : {1.0, -1.0}) {
      variants.emplace_back([&in, unit, y] { return truth_misfit(in, {unit, y, true}); });
    }
  }
  return variants;
}

Variants view_variants(const Window& in) {
  Variants variants;
  for (const double range : {1.0, 0.01, 0.001, 0.3048, 0.0254}) {
    for (const double sign : {1.0, -1.0}) {
      variants.emplace_back(
          [&in, range, sign] { return views_in(in, range, sign * in.frame.bearing_unit); });
    }
  }
  return variants;
}

/// The first is as recorded.
Variants variants_of(Witness witness, const Window& in) {
  Variants variants;
  switch (witness) {
    case Witness::other_wheels:
      return {[&in] { return surplus(in); }};
    case Witness::compass:
      for (const double unit : kUnits) {
        variants.emplace_back([&in, unit] { return compass_misfit(in, unit); });
      }
      return variants;
    case Witness::gyro:
      for (const double unit : kUnits) {
        variants.emplace_back([&in, unit] { return gyro_misfit(in, unit); });
      }
      return variants;
    case Witness::truth:
      return truth_variants(in);
    case Witness::views:
      return view_variants(in);
    case Witness::survey:
    case Witness::fixes:
      break;
  }
  for (const bool mirrored : {false, true}) {
    for (const bool any_unit : {false, true}) {
      variants.emplace_back([&in, witness, mirrored, any_unit] {
        return corner_misfit(in, witness, mirrored, any_unit);
      });
    }
  }
  return variants;
}

/// What costs least goes first.
constexpr Witness kWitnesses[] = {Witness::other_wheels, Witness::compass, Witness::gyro,
                                  Witness::truth,        Witness::survey,  Witness::fixes,
                                  Witness::views};

}  // namespace

std::string_view name_of(Witness witness) {
  static constexpr std::array<std::string_view, 7> kNames{
      "the other wheels",     "the compass", "the gyro", "the truth",
      "landmarks seen again", "the survey",  "the fixes"};
  return kNames.at(static_cast<std::size_t>(witness));
}

std::vector<Misfit> misfits(const DrivenRecording& recording, const MotionRows& drive,
                            const MisfitFrame& frame) {
  constexpr double kGood = 0.1;  // needs no excuse
  const Track track(drive);
  const Window in{recording, drive, track, frame};
  std::vector<Misfit> result;
  for (const Witness witness : kWitnesses) {
    const Variants variants = variants_of(witness, in);
    const std::optional<double> stated = variants.front()();
    if (!stated) continue;
    Misfit one{witness, *stated, *stated};
    for (std::size_t k = 1; k < variants.size() && one.best > kGood; ++k) {
      one.best = std::min(one.best, variants[k]().value_or(one.best));
    }
    result.push_back(one);
  }
  return result;
}

std::optional<std::vector<Misfit>> misfits_below(double limit, const DrivenRecording& recording,
                                                 const MotionRows& drive,
                                                 const MisfitFrame& frame) {
  const Track track(drive);
  const Window in{recording, drive, track, frame};
  std::vector<Misfit> result;
  for (const Witness witness : kWitnesses) {
    const std::optional<double> stated = variants_of(witness, in).front()();
    if (!stated) continue;
    if (*stated > limit) return std::nullopt;
    result.push_back({witness, *stated, *stated});
  }
  return result;
}

}  // namespace trussmap::check
