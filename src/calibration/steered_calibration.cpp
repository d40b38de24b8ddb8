// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Calibration of a robot that steers: where it may start from, and which of the constants that few
// robots have (a measured or a steered wheel beside the middle, travel of the other axle) there
// are.
//
// Any point of the rear axle goes straight ahead: wheels and sensors are told from each other to
// the left, and not from the middle. Of the wheel whose travel and the wheel whose angle is read
// that one stands aside that leaves sensors nearer to where they are stated.
#include "calibration/sensor_places.hpp"
#include "calibration/sought_constants.hpp"
#include "calibration/wheel_calibration.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

namespace trussmap::calibration {
namespace {

constexpr double kPossible = 10.0;  // chi^2/dof

/// Whether a start from this gain may be believed: it led somewhere, and not far away. One that is
/// not as stated has to be determined.
bool led_nearby(const WheelCalibration& found, double start, bool stated) {
  constexpr double kFar = 1.7;  // starts within it of the gain that is found lead there
  if (!found.settled) return false;
  for (const DriveConstant& one : found.constants) {
    if (one.channel != Channel::steer_gain) continue;
    const double ratio = (1.0 + one.g.value) / (1.0 + start);
    return ratio < kFar && ratio > 1.0 / kFar;
  }
  return stated;
}

/// The best of several starts.
class Starts {
 public:
  Starts(const std::vector<DrivenRecording>& recordings, const Model& model,
         const WheelCalibrationOptions& options)
      : recordings_(recordings), model_(model), options_(options) {}

  /// From these constants; whether it led nearby.
  bool try_from(const std::vector<double>& g, bool stated) {
    const std::size_t gain = *place_of_gain(model_.robot);
    try {
      WheelCalibration found = calibrated_from(g, recordings_, model_, options_);
      const bool nearby = led_nearby(found, g[gain], g[gain] == in_force(model_)[gain]);
      if (nearby && (!best_ || scatter_of(found) < scatter_of(*best_))) {
        best_ = std::move(found);
      } else if (stated && !nearby) {
        stated_ = std::move(found);
      }
      return nearby;
    } catch (const SolveError&) {
      if (!why_) why_ = std::current_exception();
    } catch (const std::invalid_argument&) {  // effects that are given leave a wheel no way ahead
      if (!why_) why_ = std::current_exception();
    }
    return false;
  }

  [[nodiscard]] bool is_below(double scatter) const {
    if (!best_ || scatter_of(*best_) >= scatter) return false;
    return !is_geared();
  }

  /// Whether it may be the steering that turns many times as far, where its gain is not told.
  [[nodiscard]] bool is_geared() const {
    constexpr double kMuch = 2.5;
    if (!best_) return false;
    for (const DriveConstant& one : best_->constants) {
      if (one.channel != Channel::turn) continue;
      const double factor = 1.0 + one.g.value;
      return factor > kMuch || factor < 1.0 / kMuch;
    }
    return false;
  }

  /// Throws what the first start led to, where none led anywhere.
  [[nodiscard]] WheelCalibration best() {
    if (best_) return std::move(*best_);
    if (stated_) return std::move(*stated_);
    std::rethrow_exception(why_);
  }

 private:
  const std::vector<DrivenRecording>& recordings_;
  const Model& model_;
  const WheelCalibrationOptions& options_;
  std::optional<WheelCalibration> best_;
  std::optional<WheelCalibration> stated_;  ///< not settled, or far from its gain
  std::exception_ptr why_;
};

/// Without the constants that few robots have.
WheelCalibration calibrated_as_usual(const std::vector<DrivenRecording>& recordings,
                                     const Model& model, const WheelCalibrationOptions& options) {
  constexpr double kGood = 2.0;  // chi^2/dof: no other start is asked then
  const std::vector<double> stated = in_force(model);
  Starts starts(recordings, model, options);
  const bool nearby = starts.try_from(stated, true);
  if (starts.is_below(kPossible)) return starts.best();
  for (const std::vector<double>& one : likely_starts(recordings, model, options)) {
    if (one != stated) static_cast<void>(starts.try_from(one, false));
    if (starts.is_below(kGood)) return starts.best();
  }
  if (nearby && !starts.is_geared()) return starts.best();
  // A steering whose encoder is geared may turn many times as far as is believed: least squares
  // find that only from near by.
  const std::size_t gain = *place_of_gain(model.robot);
  for (const double factor : {2.0, 0.5, 4.0, 0.25, 8.0, 0.125}) {
    std::vector<double> start = stated;
    start[gain] = factor * (1.0 + stated[gain]) - 1.0;
    static_cast<void>(starts.try_from(start, false));
  }
  return starts.best();
}

/// How far sensors moved to the left from where they are stated to sit, as chi^2: each counts for
/// so much at most.
double moved_aside(const WheelCalibration& found, const Mountings& stated) {
  constexpr double kMost = 9.0;
  double sum = 0.0;
  for (const CalibratedMounting& one : found.mountings) {
    if (!one.y || !(one.y->sd > 0.0)) continue;
    const Mounting was = stated_place(stated, one.of);
    sum += std::min(kMost, std::pow((one.y->value - was.y) / one.y->sd, 2));
  }
  return sum;
}

const DriveConstant* constant_of(const WheelCalibration& found, Channel channel) {
  const auto at =
      std::find_if(found.constants.begin(), found.constants.end(),
                   [channel](const DriveConstant& one) { return one.channel == channel; });
  return at == found.constants.end() ? nullptr : &*at;
}

/// What is asked of a calibration with one constant more, beside one without, where there is one.
struct Asked {
  const std::vector<DrivenRecording>& recordings;
  const Model& model;
  const std::optional<WheelCalibration>& without;
};

/// A wheel is of one axle or the other, and nothing between.
bool is_likely(const DriveConstant& one) {
  constexpr double kNear = 0.25;
  constexpr double kSure = 4.0;  // standard errors
  return one.channel != Channel::other_axle ||
         std::abs(one.g.value - 1.0) < std::max(kNear, kSure * one.g.sd);
}

/// Nothing where that constant is not surely there.
std::optional<WheelCalibration> with_constant(const Asked& asked, Channel channel,
                                              const WheelCalibrationOptions& options) {
  constexpr double kSure = 4.0;    // standard errors
  constexpr double kWorth = 16.0;  // chi^2
  constexpr double kFair = 1.5;    // chi^2/dof
  std::vector<std::vector<double>> starts;
  if (asked.without) starts.push_back(in_force(asked.without->model));
  // What a fit without it made of the others need lead nowhere.
  if (!asked.without || scatter_of(*asked.without) > kFair) {
    starts.push_back(in_force(asked.model));
  }
  std::optional<WheelCalibration> best;
  for (const std::vector<double>& start : starts) {
    try {
      WheelCalibration found = calibrated_from(start, asked.recordings, asked.model, options);
      const DriveConstant* one = constant_of(found, channel);
      const double scatter = std::max(1.0, scatter_of(found));
      const bool sure =
          one != nullptr && std::abs(one->g.value) > kSure * one->g.sd * std::sqrt(scatter);
      const bool worth = !asked.without || asked.without->chi2 - found.chi2 > kWorth * scatter;
      if (!found.settled || !sure || !worth || !is_likely(*one)) continue;
      if (!best || found.chi2 < best->chi2) best = std::move(found);
    } catch (const SolveError&) {
      continue;
    }
  }
  return best;
}

/// With the one of them that explains most; it is in `options` then.
std::optional<WheelCalibration> with_one_more(const Asked& asked,
                                              WheelCalibrationOptions& options) {
  std::optional<WheelCalibration> best;
  Channel which{};
  double least = 0.0;
  for (const Channel channel : seldom_constants(asked.model.robot)) {
    if (std::ranges::count(options.seldom, channel) > 0) continue;
    WheelCalibrationOptions more = options;
    more.seldom.push_back(channel);
    std::optional<WheelCalibration> found = with_constant(asked, channel, more);
    if (!found) continue;
    const double cost = found->chi2 / std::max(1.0, scatter_of(*found)) +
                        moved_aside(*found, asked.model.robot.mounted);
    // One that leaves much is no better for that its errors are large.
    const bool fits = scatter_of(*found) < kPossible;
    const bool best_fits = best && scatter_of(*best) < kPossible;
    const bool better = !best || (fits != best_fits ? fits
                                  : fits            ? cost < least
                                                    : found->chi2 < best->chi2);
    if (!better) continue;
    least = cost;
    which = channel;
    best = std::move(found);
  }
  if (best) options.seldom.push_back(which);
  return best;
}

}  // namespace

WheelCalibration calibrate_steered(const std::vector<DrivenRecording>& recordings,
                                   const Model& model, const WheelCalibrationOptions& given) {
  constexpr double kFits = 0.05;  // p
  constexpr int kMostSeldom = 2;
  WheelCalibrationOptions options = given;
  // What the model has already is sought on.
  const std::vector<double> stated = in_force(model);
  const std::vector<SoughtConstant> constants = sought_constants(model.robot);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k].seldom && stated[k] != 0.0) options.seldom.push_back(constants[k].channel);
  }
  std::optional<WheelCalibration> found;
  std::exception_ptr why;
  try {
    found = calibrated_as_usual(recordings, model, options);
  } catch (const SolveError&) {
    why = std::current_exception();
  }
  for (int round = 0; round < kMostSeldom; ++round) {
    if (found && (found->dof <= 0 || statistics::chi2_p_value(found->chi2, found->dof) > kFits))
      break;
    std::optional<WheelCalibration> more = with_one_more({recordings, model, found}, options);
    if (!more) break;
    found = std::move(more);
  }
  if (!found) std::rethrow_exception(why);
  return *std::move(found);
}

}  // namespace trussmap::calibration
