// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/constant_values.hpp"
#include "calibration/one_wheel.hpp"
#include "calibration/sensor_places.hpp"
#include "calibration/sought_constants.hpp"
#include "calibration/stack_values.hpp"
#include "estimation/effect_parameters.hpp"
#include "fit/fit_state.hpp"
#include "geometry/index.hpp"
#include "trussmap/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace calibration;

namespace {

/// What is known of constants: coefficients of channels, and what becomes of them.
struct KnownGains {
  std::vector<Channel> channels;  ///< of the coefficients
  Eigen::VectorXd g;
  Eigen::MatrixXd covariance;
  std::set<Channel> asked;    ///< of all that was sought
  std::set<Channel> unknown;  ///< that was not determined
  std::function<std::vector<ConstantValue>(const Eigen::VectorXd& g)> values;
};

/// Whether a constant of a robot's software is made of it.
bool has_constant(const Effect& effect, const Robot& robot) {
  if (!effect.is_constant() || effect.per_session) return false;
  for (const ConstantValue& one : constant_values(robot, {})) {
    if (std::find(one.of.begin(), one.of.end(), effect.channel) != one.of.end()) return true;
  }
  return false;
}

ChannelGains gains_of(const Model& model) {
  ChannelGains gains;
  for (const Effect& one : model.effects) {
    if (!one.coefficients.empty() && has_constant(one, model.robot)) {
      gains[one.channel] += one.coefficients.front();
    }
  }
  return gains;
}

bool has_any(const std::set<Channel>& these, const std::vector<Channel>& of) {
  return std::any_of(of.begin(), of.end(), [&](Channel one) { return these.contains(one); });
}

/// Of a wheel what it has for itself; else all.
std::vector<Channel> own_channels(const ConstantValue& one) {
  std::vector<Channel> own = one.of;
  std::erase_if(own, [&one](Channel channel) {
    return channel == Channel::travel ||
           (one.kind == ConstantKind::wheel && channel == Channel::wheels);
  });
  return own;
}

/// Whether it was determined, and what is to be said if only in part.
void judge(const ConstantValue& value, const KnownGains& known, RobotConstant& result) {
  const std::vector<Channel> own = own_channels(value);
  const bool own_asked = has_any(known.asked, own);
  const bool mean_unknown =
      known.unknown.contains(Channel::travel) || known.unknown.contains(Channel::wheels);
  result.determined = own_asked ? !has_any(known.unknown, own) : !has_any(known.unknown, value.of);
  const bool is_size = value.kind != ConstantKind::other;
  if (!result.determined) {
    result.note = "these data do not show it";
  } else if (!std::isfinite(value.value) || (is_size && !(value.value > 0.0))) {
    result.determined = false;
    result.note = value.value < 0.0 ? "it would be negative: are left and right exchanged?"
                                    : "it would not be positive, which no robot has";
  } else if (value.kind == ConstantKind::wheel && mean_unknown) {
    result.note += "; their mean was not determined";
  }
}

Eigen::MatrixXd value_slopes(const KnownGains& known, std::size_t values) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd result(static_cast<Eigen::Index>(values), known.g.size());
  for (Eigen::Index k = 0; k < known.g.size(); ++k) {
    Eigen::VectorXd more = known.g;
    Eigen::VectorXd less = known.g;
    more[k] += kStep;
    less[k] -= kStep;
    const std::vector<ConstantValue> above = known.values(more);
    const std::vector<ConstantValue> below = known.values(less);
    for (std::size_t j = 0; j < values; ++j) {
      result(static_cast<Eigen::Index>(j), k) = (above[j].value - below[j].value) / (2.0 * kStep);
    }
  }
  return result;
}

/// Whether the wheels' mean size was asked for, and found.
bool shows_mean(const KnownGains& known) {
  if (has_any(known.unknown, {Channel::wheels, Channel::travel})) return false;
  return std::any_of(known.asked.begin(), known.asked.end(), [](Channel one) {
    return one == Channel::wheels || one == Channel::travel || one == Channel::left ||
           one == Channel::right || wheel_of(one);
  });
}

ChannelGains in_turn(const std::vector<Channel>& channels, const Eigen::VectorXd& g) {
  ChannelGains gains;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    gains[channels[k]] = g[static_cast<Eigen::Index>(k)];
  }
  return gains;
}

/// The list, what stacks call it, and whether one wheel is all.
RobotConstants told(const Model& before, const KnownGains& known) {
  RobotConstants result;
  const std::vector<ConstantValue> old = constant_values(before.robot, gains_of(before));
  const std::vector<ConstantValue> now = known.values(known.g);
  const Eigen::MatrixXd slope = value_slopes(known, now.size());
  const Eigen::MatrixXd covariance = slope * known.covariance * slope.transpose();
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (!has_any(known.asked, now[k].of)) continue;
    const auto at = static_cast<Eigen::Index>(k);
    RobotConstant one{.name = now[k].name,
                      .unit = now[k].unit,
                      .before = old[k].value,
                      .after = now[k].value,
                      .sd = std::sqrt(std::max(0.0, covariance(at, at))),
                      .note = now[k].note};
    judge(now[k], known, one);
    if (one.determined && one.sd == 0.0 && one.before == one.after) continue;  // held
    result.list.push_back(std::move(one));
  }
  if (known.unknown.empty()) result.one_wheel = one_wheel(before.robot, now, covariance);
  result.stacks = stack_values(before.robot, result.list, now, shows_mean(known));
  return result;
}

void add_noise(const Noise& before, const Noise& after, const Robot& robot,
               std::vector<RobotConstant>& list) {
  const auto add = [&list](const char* name, const char* unit, double old, double now,
                           const char* note) {
    if (old == now) return;
    list.push_back(
        {.name = name, .unit = unit, .before = old, .after = now, .sd = 0.0, .note = note});
  };
  const bool two = robot.drive == DriveKind::differential;
  constexpr const char* kPerMetre = "sd of its travel per root of a metre";
  add(two ? "left wheel noise" : "wheel noise", "m^1/2", before.left, after.left, kPerMetre);
  if (two) add("right wheel noise", "m^1/2", before.right, after.right, kPerMetre);
  add("gyro noise", "rad/s^1/2", before.gyro, after.gyro, "angle random walk");
}

/// Noise per metre as the wheels count it once their sizes are pasted: of wheels that were far off
/// another metre.
Noise as_pasted(Noise noise, const std::vector<RobotConstant>& list) {
  constexpr double kFar = 0.1;
  for (const auto& [name, size] :
       {std::pair("left wheel", &Noise::left), std::pair("right wheel", &Noise::right)}) {
    const auto wheel = std::ranges::find(list, name, &RobotConstant::name);
    if (wheel == list.end() || !wheel->determined || !(wheel->before > 0.0)) continue;
    const double times = wheel->after / wheel->before;
    if (std::abs(times - 1.0) >= kFar) noise.*size *= std::sqrt(times);
  }
  return noise;
}

/// Effects that are there and no constant undoes.
std::vector<std::string> others_of(const std::vector<EffectEstimate>& effects, const Robot& robot) {
  std::vector<std::string> names;
  for (const EffectEstimate& one : effects) {
    const std::vector<double>& a = one.effect.coefficients;
    const bool there = std::any_of(a.begin(), a.end(), [](double each) { return each != 0.0; });
    if (there && !has_constant(one.effect, robot)) names.push_back(one.effect.name);
  }
  return names;
}

/// Which of the estimates are constants' and were fitted; the others of the constants are held.
KnownGains known_of(const std::vector<EffectEstimate>& effects, const Robot& robot,
                    std::vector<std::size_t>& fitted) {
  KnownGains known;
  ChannelGains held;
  std::vector<double> g;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const auto& [effect, sd, not_fitted] = effects[e];
    if (effect.coefficients.empty() || !has_constant(effect, robot)) continue;
    known.asked.insert(effect.channel);
    const bool is_unknown = !not_fitted.empty() || std::isinf(sd.front());
    if (is_unknown) known.unknown.insert(effect.channel);
    if (is_unknown || !(sd.front() > 0.0)) {
      held[effect.channel] += effect.coefficients.front();
      continue;
    }
    fitted.push_back(e);
    known.channels.push_back(effect.channel);
    g.push_back(effect.coefficients.front());
  }
  known.g = Eigen::VectorXd::Map(g.data(), std::ssize(g));
  known.values = [robot, held, channels = known.channels](const Eigen::VectorXd& at) {
    ChannelGains gains = held;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      gains[channels[k]] += at[static_cast<Eigen::Index>(k)];
    }
    return constant_values(robot, gains);
  };
  return known;
}

/// Of these effects' only coefficients, from the fit.
Eigen::MatrixXd covariance_in(const fitting::FitState& fit,
                              const std::vector<std::size_t>& effects) {
  const auto size = std::ssize(effects);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
  std::vector<std::pair<Eigen::Index, Eigen::Index>> places;  // here, there
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const fitting::Coefficient& one = fit.columns.coefficients[idx(unknown[k])];
    const auto found = std::find(effects.begin(), effects.end(), one.effect);
    if (found != effects.end()) {
      places.emplace_back(found - effects.begin(), static_cast<Eigen::Index>(k));
    }
  }
  for (const auto& [i, k] : places) {
    for (const auto& [j, l] : places) {
      result(i, j) = fit.adjustment.coefficient_covariance(k, l);
    }
  }
  return result;
}

Eigen::MatrixXd independent(const std::vector<EffectEstimate>& effects,
                            const std::vector<std::size_t>& fitted) {
  Eigen::VectorXd variances(std::ssize(fitted));
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    variances[static_cast<Eigen::Index>(k)] = std::pow(effects[fitted[k]].sd.front(), 2);
  }
  return variances.asDiagonal();
}

/// Those that a calibration seeks, one after the other, beside what the model has besides.
KnownGains known_of(const Model& before, const WheelCalibration& found) {
  const Robot& robot = before.robot;
  const std::vector<SoughtConstant> sought = sought_constants(robot);
  Model others = before;
  std::erase_if(others.effects, [&sought](const Effect& effect) {
    return std::any_of(sought.begin(), sought.end(),
                       [&effect](const SoughtConstant& one) { return one.name == effect.name; });
  });
  KnownGains known;
  for (const SoughtConstant& one : sought) {
    const bool there = std::ranges::count(found.channels, one.channel) > 0;
    if (!one.seldom || there) known.asked.insert(one.channel);
  }
  known.unknown = known.asked;
  for (const Channel channel : found.channels) known.unknown.erase(channel);
  known.channels = found.channels;
  known.g = found.g;
  known.covariance = found.covariance;
  known.values = [robot, channels = found.channels,
                  beside = gains_of(others)](const Eigen::VectorXd& at) {
    std::vector<ConstantValue> values =
        constant_values(robot, side_by_side(robot, in_turn(channels, at)));
    const std::vector<ConstantValue> nominal = constant_values(robot, {});
    const std::vector<ConstantValue> more = constant_values(robot, beside);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (values[k].kind == ConstantKind::other) continue;
      values[k].value *= more[k].value / nominal[k].value;
    }
    return values;
  };
  return known;
}

/// Places of sensors, those of the model before with its effects.
void add_places(const std::vector<CalibratedMounting>& found, const Model& before,
                std::vector<RobotConstant>& list) {
  const Mountings stated = with_places_in_robot(before).robot.mounted;
  for (const CalibratedMounting& one : found) {
    const Mounting was = stated_place(stated, one.of);
    const auto add = [&](const char* name, const char* unit, double old,
                         const std::optional<Calibrated>& value, const char* note) {
      if (!value) return;
      list.push_back({.name = (one.of == "tracked" ? "truth" : one.of) + " " + name,
                      .unit = unit,
                      .before = old,
                      .after = value->value,
                      .sd = value->sd,
                      .note = note});
    };
    add("ahead", "m", was.x, one.x, "of the axle's centre");
    add("left", "m", was.y, one.y, "of the axle's centre");
    add("yaw", "rad", was.yaw, one.yaw, "to the left of ahead");
  }
}

/// Any point of the rear axle goes straight ahead: which one is the middle no motion tells.
void doubt_sides(const WheelCalibration& found, RobotConstants& result) {
  const bool sensors = std::ranges::any_of(
      found.mountings, [](const CalibratedMounting& one) { return one.y.has_value(); });
  for (const auto& [name, other] :
       {std::pair("measured wheel left", "steered"), std::pair("steered wheel left", "measured")}) {
    const auto at = std::ranges::find(result.list, name, &RobotConstant::name);
    if (!sensors || at == result.list.end() || !at->determined) continue;
    result.doubts.push_back(fmt::format(
        "wheels and sensors are told from each other to the left, not from the middle: it may as "
        "well be the {} wheel that is {:.3g} m to the {}, and all sensors with it",
        other, std::abs(at->after), at->after > 0.0 ? "right" : "left"));
    return;
  }
}

void add_fixes(const FixAlignment& fixes, const Model& before, std::vector<RobotConstant>& list) {
  if (fixes.late.empty()) return;
  const ChannelGains in_force = gains_of(before);
  double sum = 0.0;
  for (const auto& [session, late] : fixes.late) sum += late;
  list.push_back({.name = "fix delay",
                  .unit = "s",
                  .before = gain_of(in_force, Channel::fix_delay),
                  .after = sum / static_cast<double>(fixes.late.size()),
                  .note = fixes.late.size() == 1
                              ? "subtract it from the stamps"
                              : "subtract it from the stamps; mean of sessions"});
}

/// What squares call for, one after the other as a calibration has it. E_b holds the error of E_s.
KnownGains known_of(const Robot& robot, const SquareRound& last, SquareMethod method,
                    bool scale_measured) {
  const SquareSolution& found = method == SquareMethod::exact ? last.exact : last.formulas;
  const GeometryErrors errors = corrections_after(last, method).errors;
  const auto share = [](const Estimate& one) {
    return one.dof > 0.0 ? one.standard_error / one.value : 0.0;
  };
  const double e_d = errors.diameter_ratio;
  // By the logarithms of E_d, E_b and E_s.
  const Eigen::Vector3d slope(4.0 * e_d / std::pow(e_d + 1.0, 2), -1.0 / errors.wheelbase_ratio,
                              errors.scale);
  const double s = share(last.setup.scale);
  Eigen::Matrix3d shares = Eigen::Matrix3d::Zero();
  shares.diagonal() << std::pow(share(found.diameter_ratio), 2),
      std::pow(share(found.wheelbase_ratio), 2), s * s;
  shares(1, 2) = shares(2, 1) = s * s;
  KnownGains known;
  known.channels = {Channel::difference, Channel::turn, Channel::wheels};
  known.asked = {known.channels.begin(), known.channels.end()};
  if (!scale_measured) known.unknown = {Channel::wheels};
  known.g = Eigen::Vector3d(2.0 * (e_d - 1.0) / (e_d + 1.0), 1.0 / errors.wheelbase_ratio - 1.0,
                            errors.scale - 1.0);
  known.covariance = slope.asDiagonal() * shares * slope.asDiagonal();
  known.values = [robot, channels = known.channels](const Eigen::VectorXd& at) {
    return constant_values(robot, side_by_side(robot, in_turn(channels, at)));
  };
  return known;
}

}  // namespace

RobotConstants robot_constants(const Model& before, const ModelFit& after) {
  const Robot& robot = after.model.robot;
  std::vector<std::size_t> fitted;
  KnownGains known = known_of(after.effects, robot, fitted);
  known.covariance =
      after.state ? covariance_in(*after.state, fitted) : independent(after.effects, fitted);
  RobotConstants result = told(before, known);
  result.others = others_of(after.effects, robot);
  add_noise(before.noise, as_pasted(after.model.noise, result.list), robot, result.list);
  return result;
}

RobotConstants robot_constants(const Model& before, const std::vector<EffectEstimate>& after) {
  std::vector<std::size_t> fitted;
  KnownGains known = known_of(after, before.robot, fitted);
  known.covariance = independent(after, fitted);
  RobotConstants result = told(before, known);
  result.others = others_of(after, before.robot);
  add_noise(before.noise, as_pasted(before.noise, result.list), before.robot, result.list);
  return result;
}

RobotConstants robot_constants(const Model& before, const WheelCalibration& found) {
  const KnownGains known = known_of(before, found);
  RobotConstants result = told(before, known);
  doubt_sides(found, result);
  add_places(found.mountings, before, result.list);
  add_fixes(found.fixes, before, result.list);
  const Noise pasted = as_pasted(found.model.noise, result.list);
  for (const auto& [name, noise, size] :
       {std::tuple("left wheel noise", &found.noise_left, &Noise::left),
        std::tuple("right wheel noise", &found.noise_right, &Noise::right)}) {
    if (!*noise) continue;
    result.list.push_back({.name = name,
                           .unit = "m^1/2",
                           .before = before.noise.*size,
                           .after = pasted.*size,
                           .sd = (*noise)->sd * pasted.*size / found.model.noise.*size,
                           .note = "sd of its travel per root of a metre"});
  }
  return result;
}

RobotConstants robot_constants(const Model& before, const std::vector<SquareRound>& rounds,
                               SquareMethod method) {
  const bool measured = rounds.front().setup.scale.dof > 0.0 ||
                        corrections_after(rounds.back(), method).errors.scale != 1.0;
  return told(before, known_of(before.robot, rounds.back(), method, measured));
}

}  // namespace trussmap
