// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/arc.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

constexpr const char* kRatio = "wheel diameter ratio";
constexpr const char* kWheelbaseEffect = "wheelbase";
constexpr const char* kScale = "wheel scale";
constexpr const char* kGyroScale = "gyro scale";
constexpr const char* kGyroBias = "gyro bias";

/// sin(x)/x and its derivative.
struct Sinc {
  explicit Sinc(double x) {
    if (std::abs(x) < 1e-3) {  // the next terms are below 1e-16
      const double x2 = x * x;
      value = 1.0 - x2 / 6.0 + x2 * x2 / 120.0;
      slope = x * (-1.0 / 3.0 + x2 / 30.0);
    } else {
      value = std::sin(x) / x;
      slope = (std::cos(x) - value) / x;
    }
  }
  double value;
  double slope;
};

double coefficient(const Effect& effect, Channel channel) {
  if (effect.channel != channel || !effect.is_constant() || effect.per_session) {
    throw std::invalid_argument("effect \"" + effect.name + "\" is not channel \"" +
                                std::string(name_of(channel)) +
                                "\" with shape [\"1\"], expected that or another name");
  }
  return effect.coefficients.empty() ? 0.0 : effect.coefficients.front();
}

auto effect_named(Model& model, const char* name) {
  return std::find_if(model.effects.begin(), model.effects.end(),
                      [&](const Effect& one) { return one.name == name; });
}

void set_effect(Model& model, const char* name, Channel channel, double value) {
  const Effect effect{name, channel, {"1"}, {value}, false};
  const auto found = effect_named(model, name);
  if (found == model.effects.end()) {
    model.effects.push_back(effect);
  } else {
    *found = effect;
  }
}

}  // namespace

GeometryErrors combined(const GeometryErrors& in_force, const GeometryErrors& found) {
  return {in_force.diameter_ratio * found.diameter_ratio,
          in_force.wheelbase_ratio * found.wheelbase_ratio, in_force.scale * found.scale};
}

GeometryErrors geometry_errors(const Model& model) {
  double difference = 0.0;
  double turn = 0.0;
  GeometryErrors errors;
  for (const Effect& effect : model.effects) {
    if (effect.name == kRatio) difference = coefficient(effect, Channel::difference);
    if (effect.name == kWheelbaseEffect) turn = coefficient(effect, Channel::turn);
    if (effect.name == kScale) errors.scale = 1.0 + coefficient(effect, Channel::wheels);
  }
  if (!(errors.scale > 0.0)) {
    throw std::invalid_argument(
        "effect \"wheel scale\" has a coefficient of -1 or less, expected one near 0");
  }
  if (std::abs(difference) >= 2.0 * errors.scale) {
    throw std::invalid_argument(
        "effect \"wheel diameter ratio\" has a coefficient of 2 or more, expected one near 0");
  }
  if (turn <= -errors.scale) {
    throw std::invalid_argument(
        "effect \"wheelbase\" has a coefficient of -1 or less, expected one near 0");
  }
  errors.diameter_ratio = (errors.scale + 0.5 * difference) / (errors.scale - 0.5 * difference);
  errors.wheelbase_ratio = errors.scale / (errors.scale + turn);
  return errors;
}

void set_geometry_errors(Model& model, const GeometryErrors& errors) {
  const double e_d = errors.diameter_ratio;
  const double scale = errors.scale;
  set_effect(model, kRatio, Channel::difference, scale * (2.0 * (e_d - 1.0) / (e_d + 1.0)));
  set_effect(model, kWheelbaseEffect, Channel::turn, scale * (1.0 / errors.wheelbase_ratio - 1.0));
  if (scale != 1.0 || effect_named(model, kScale) != model.effects.end()) {
    set_effect(model, kScale, Channel::wheels, scale - 1.0);
  }
}

void set_taped(Model& model, const TapeCalibration& found) {
  const auto value_of = [](const std::optional<Estimate>& one) { return one ? one->value : 1.0; };
  const GeometryErrors errors = combined(
      geometry_errors(model),
      {value_of(found.diameter_ratio), value_of(found.wheelbase_ratio), value_of(found.scale)});
  const auto lacks = [&model](const char* name) {
    return effect_named(model, name) == model.effects.end();
  };
  const bool no_ratio = !found.diameter_ratio && lacks(kRatio);
  const bool no_wheelbase = !found.wheelbase_ratio && lacks(kWheelbaseEffect);
  double scale = 0.0;
  double bias = 0.0;
  for (const Effect& effect : model.effects) {
    if (effect.name == kGyroScale) scale = coefficient(effect, Channel::gyro_scale);
    if (effect.name == kGyroBias) bias = coefficient(effect, Channel::gyro);
  }
  set_geometry_errors(model, errors);
  if (no_ratio) model.effects.erase(effect_named(model, kRatio));
  if (no_wheelbase) model.effects.erase(effect_named(model, kWheelbaseEffect));
  // theta = (1 + s) ((1 + s_0) G - g_0 t) - g t
  const double more = found.gyro_scale ? found.gyro_scale->value : 0.0;
  if (found.gyro_scale) {
    set_effect(model, kGyroScale, Channel::gyro_scale, (1.0 + scale) * (1.0 + more) - 1.0);
  }
  if (found.gyro_bias || !lacks(kGyroBias)) {
    const double rest = found.gyro_bias ? found.gyro_bias->value : 0.0;
    set_effect(model, kGyroBias, Channel::gyro, (1.0 + more) * bias + rest);
  }
}

Model with_geometry(Model model, const GeometryErrors& errors) {
  model.robot.wheelbase *= errors.wheelbase_ratio;
  model.robot.wheelbase_stated = true;
  set_geometry_errors(model, {errors.diameter_ratio, 1.0, errors.scale});
  return model;
}

PathError path_error(const TestPath& path, double wheelbase, const GeometryErrors& errors) {
  using Row2 = Eigen::RowVector2d;
  const double b = wheelbase * errors.wheelbase_ratio;
  const double c_left = errors.left_factor();
  const double c_right = errors.right_factor();
  // dc_R/dE_d = -dc_L/dE_d
  const double slope = errors.scale * 2.0 / std::pow(errors.diameter_ratio + 1.0, 2);
  Pose calculated;
  Pose actual;
  PathError result;
  Row2 dx = Row2::Zero();
  Row2 dy = Row2::Zero();
  Row2 dheading = Row2::Zero();
  for (const PathSegment& segment : path) {
    const double left = segment.distance - 0.5 * wheelbase * segment.turn;
    const double right = segment.distance + 0.5 * wheelbase * segment.turn;
    calculated = compose(calculated, arc_displacement({left, right}, wheelbase));

    const double distance = 0.5 * (c_left * left + c_right * right);
    const double turn = (c_right * right - c_left * left) / b;
    const Row2 ddistance(0.5 * slope * (right - left), 0.0);
    const Row2 dturn(slope * (left + right) / b, -turn / errors.wheelbase_ratio);
    const Sinc sinc(0.5 * turn);
    const double chord = distance * sinc.value;
    const Row2 dchord = ddistance * sinc.value + 0.5 * distance * sinc.slope * dturn;
    const double middle = actual.heading + 0.5 * turn;
    const Row2 dmiddle = dheading + 0.5 * dturn;
    actual.x += chord * std::cos(middle);
    actual.y += chord * std::sin(middle);
    actual.heading += turn;
    dx += dchord * std::cos(middle) - chord * std::sin(middle) * dmiddle;
    dy += dchord * std::sin(middle) + chord * std::cos(middle) * dmiddle;
    dheading += dturn;
  }
  result.error = {actual.x - calculated.x, actual.y - calculated.y,
                  actual.heading - calculated.heading};
  result.jacobian << dx, dy, dheading;
  return result;
}

}  // namespace trussmap
