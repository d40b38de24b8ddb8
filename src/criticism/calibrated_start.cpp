// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/calibrated_start.hpp"

#include "calibration/constant_values.hpp"
#include "calibration/gross_starts.hpp"
#include "calibration/sensor_places.hpp"
#include "calibration/sought_constants.hpp"
#include "calibration/wheel_calibration.hpp"
#include "criticism/refits.hpp"
#include "effects/steering.hpp"
#include "fit/fit_state.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr double kFarPlace = 0.3;   // m off: no handbreadth
constexpr double kFarYaw = 0.2;     // rad
constexpr double kFarWheel = 0.1;   // m
constexpr double kFarAngle = 0.05;  // rad, of steering
constexpr double kHalf = 0.5;       // of the difference between two axles

/// g of travel, of turning and of the wheels' difference, as effects that add to each other have
/// them; a calibration's act one after the other.
struct DriveFactors {
  double travel = 0.0, turn = 0.0, difference = 0.0;
  double drift = 0.0;  ///< rad/s
};

DriveFactors factors_of(const Model& calibrated) {
  DriveFactors result;
  double radii = 0.0;
  int wheels = 0;
  const std::vector<calibration::SoughtConstant> constants =
      calibration::sought_constants(calibrated.robot);
  const std::vector<double> values = calibration::in_force(calibrated);
  auto value = values.begin();
  for (const calibration::SoughtConstant& one : constants) {
    const double g = *value++;
    if (one.channel == Channel::turn) result.turn += g;
    if (one.channel == Channel::difference) result.difference += g;
    if (one.channel == Channel::wheels || one.channel == Channel::travel) result.travel += g;
    if (one.channel == Channel::drift) result.drift += g;
    if (wheel_of(one.channel)) {
      radii += g;
      ++wheels;
    }
  }
  if (wheels > 0) result.travel += radii / wheels;
  // A turn that is said for itself is not the wheels'.
  const double with = calibration::says_its_turns(calibrated.robot) ? 1.0 : 1.0 + result.travel;
  const double turn = (1.0 + result.turn) * with;
  result.turn = turn - 1.0;
  result.difference *= turn;
  return result;
}

/// How far sensors are from where they are stated to sit, by the channel that says so.
std::map<Channel, double> places_off(const WheelCalibration& found, const Robot& stated) {
  std::map<Channel, double> result;
  const auto add = [&](const std::optional<Calibrated>& value, double was, Channel channel,
                       double sign = 1.0) {
    if (value) result[channel] = sign * (value->value - was);
  };
  for (const CalibratedMounting& one : found.mountings) {
    const Mounting was = calibration::stated_place(stated.mounted, one.of);
    if (one.of == "antenna") {
      add(one.x, was.x, Channel::antenna);
      add(one.y, was.y, Channel::antenna_left);
    } else if (one.of == "scanner") {
      add(one.x, was.x, Channel::scanner);
      add(one.y, was.y, Channel::scanner_left);
      add(one.yaw, was.yaw, Channel::scanner_yaw);
    } else {
      const bool sensor = one.of == "sensor";
      add(one.x, was.x, Channel::lever);
      add(one.y, was.y, Channel::lever_left);
      add(one.yaw, was.yaw, sensor ? Channel::bearing : Channel::truth_heading,
          sensor ? -1.0 : 1.0);
    }
  }
  return result;
}

/// Whether the sensors of this channel were surely found further left or right than stated.
bool is_moved_aside(const WheelCalibration& found, const Robot& stated, Channel channel) {
  constexpr double kSure = 4.0;  // standard errors
  const std::map<Channel, double> off = places_off(found, stated);
  const auto at = off.find(channel);
  if (at == off.end()) return false;
  return std::ranges::any_of(found.mountings, [&](const CalibratedMounting& one) {
    const Channel its = one.of == "antenna"   ? Channel::antenna_left
                        : one.of == "scanner" ? Channel::scanner_left
                                              : Channel::lever_left;
    return its == channel && one.y && std::abs(at->second) > kSure * one.y->sd;
  });
}

/// Without those that few robots have and this one has not. Beside a wheel to the left, without
/// sensors to the left but those that were found there: which of them is in the middle no motion
/// tells.
void keep_likely(const std::optional<WheelCalibration>& found, const Robot& stated,
                 std::vector<Effect>& constants) {
  const auto has = [&found](Channel one) {
    return found && std::ranges::count(found->channels, one) > 0;
  };
  std::vector<Channel> unlikely = calibration::seldom_constants(stated);
  std::erase_if(unlikely, has);
  if (has(Channel::wheel_left) || has(Channel::steer_left)) {
    for (const Channel one : {Channel::lever_left, Channel::antenna_left, Channel::scanner_left}) {
      if (!is_moved_aside(*found, stated, one)) unlikely.push_back(one);
    }
  }
  std::erase_if(constants, [&unlikely](const Effect& one) {
    return std::ranges::count(unlikely, one.channel) > 0;
  });
}

/// Of steering, and of the wheels' places: as they are.
std::map<Channel, double> steering_of(const Model& calibrated) {
  std::map<Channel, double> result;
  for (const Effect& one : calibrated.effects) {
    if (effects::is_of_steered_drive(one.channel) && one.is_constant() &&
        !one.coefficients.empty()) {
      result[one.channel] += one.coefficients.front();
    }
  }
  return result;
}

/// Each with the way's scale where it tells it; else as it is, and as of wheels that are all so
/// much larger.
std::vector<std::vector<Effect>> likely_constants(const std::vector<DrivenRecording>& recordings,
                                                  const ModelFit& given,
                                                  const std::vector<Effect>& constants) {
  std::vector<std::vector<Effect>> result;
  const estimation::ProblemOptions used = fitting::fitter_options(given.options).problem;
  for (const calibration::GrossStart& start :
       calibration::gross_starts(recordings, given.model.robot, used)) {
    calibration::ChannelGains gains =
        calibration::side_by_side(given.model.robot, {{Channel::turn, start.turn},
                                                      {Channel::difference, start.difference},
                                                      {Channel::steer, start.steer}});
    const std::vector<double> ways =
        start.travel ? std::vector{*start.travel} : std::vector{0.0, start.turn};
    for (const double travel : ways) {
      gains[Channel::travel] = travel;
      result.push_back(constants);
      for (Effect& one : result.back()) {
        one.coefficients.assign(one.shape.size(), calibration::gain_of(gains, one.channel));
      }
    }
  }
  return result;
}

}  // namespace

bool is_gross(const Effect& constant) {
  using enum Channel;
  const Channel of = constant.channel;
  const bool factor = of == travel || of == turn || of == sideways || of == difference ||
                      of == wheels || of == left || of == right;
  const double g = constant.coefficients.front();
  return (factor && std::abs(g) >= kGross) || is_far_place(of, g);
}

bool is_far_place(Channel channel, double g) {
  using enum Channel;
  const bool turned = channel == scanner_yaw || channel == bearing || channel == truth_heading;
  const bool place = channel == lever || channel == lever_left || channel == antenna ||
                     channel == antenna_left || channel == scanner || channel == scanner_left;
  return (place && std::abs(g) >= kFarPlace) || (turned && std::abs(g) >= kFarYaw) ||
         (effects::is_wheels_place(channel) && std::abs(g) >= kFarWheel) ||
         (channel == steer && std::abs(g) >= kFarAngle) ||
         (channel == steer_gain && std::abs(g) >= kGross) ||
         (channel == other_axle && std::abs(g) >= kHalf);
}

CalibratedStart start_of_constants(const std::vector<DrivenRecording>& recordings,
                                   const ModelFit& given, std::vector<Effect> constants) {
  calibration::WheelCalibrationOptions options;
  options.problem = fitting::fitter_options(given.options).problem;
  options.noise = false;
  const auto found = if_possible<WheelCalibration>(
      [&] { return calibration::calibrate_wheels(recordings, given.model, options); });
  keep_likely(found, given.model.robot, constants);
  if (!found) return {constants, likely_constants(recordings, given, constants)};
  const DriveFactors factors = factors_of(found->model);
  const double most =
      std::max({std::abs(factors.travel), std::abs(factors.turn), std::abs(factors.difference)});
  CalibratedStart result{std::move(constants), {}, true, most >= kGross};
  std::map<Channel, double> places = places_off(*found, given.model.robot);
  for (const auto& [channel, g] : steering_of(found->model)) places[channel] = g;
  for (Effect& one : result.constants) {
    one.coefficients.assign(one.shape.size(), 0.0);
    if (one.channel == Channel::travel) one.coefficients = {factors.travel};
    if (one.channel == Channel::turn) one.coefficients = {factors.turn};
    if (one.channel == Channel::difference) one.coefficients = {factors.difference};
    if (one.channel == Channel::drift) one.coefficients = {factors.drift};
    if (const auto place = places.find(one.channel); place != places.end()) {
      one.coefficients = {place->second};
      result.far_places = result.far_places || is_far_place(one.channel, place->second);
    }
  }
  return result;
}

}  // namespace trussmap::criticism
