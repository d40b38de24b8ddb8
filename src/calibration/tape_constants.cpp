// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/welch.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

Estimate scaled(double value, double size, const Estimate& by) {
  return {value, std::abs(size) * by.standard_error, by.dof};
}

/// The factor of a wheel's travel: slope by E_d, in proportion to E_s.
Estimate wheel_factor(double value, double by_ratio, const GeometryErrors& in_force,
                      const TapeCalibration& found) {
  const Estimate factor = scaled(value, by_ratio * in_force.diameter_ratio, *found.diameter_ratio);
  return found.scale ? calibration::also_by(factor, value / found.scale->value, *found.scale)
                     : factor;
}

double coefficient_of(const Model& model, const char* name) {
  const auto at = std::find_if(model.effects.begin(), model.effects.end(),
                               [name](const Effect& one) { return one.name == name; });
  return at == model.effects.end() || at->coefficients.empty() ? 0.0 : at->coefficients.front();
}

}  // namespace

std::vector<TapedConstant> taped_constants(const Model& model, const TapeCalibration& found) {
  Model after = model;
  set_taped(after, found);
  const GeometryErrors old = geometry_errors(model);
  const GeometryErrors now = geometry_errors(after);
  std::vector<TapedConstant> constants;
  if (found.wheelbase_ratio) {
    const double b = model.robot.wheelbase;
    constants.push_back(
        {"wheelbase", b * old.wheelbase_ratio,
         scaled(b * now.wheelbase_ratio, b * old.wheelbase_ratio, *found.wheelbase_ratio), "m"});
  }
  if (found.diameter_ratio) {
    const double slope = 2.0 * now.scale / std::pow(now.diameter_ratio + 1.0, 2);
    constants.push_back(
        {"left wheel", old.left_factor(), wheel_factor(now.left_factor(), slope, old, found), ""});
    constants.push_back({"right wheel", old.right_factor(),
                         wheel_factor(now.right_factor(), slope, old, found), ""});
  } else if (found.scale) {
    constants.push_back({"wheels", old.scale, scaled(now.scale, old.scale, *found.scale), ""});
  }
  if (found.gyro_scale) {
    const double before = 1.0 + coefficient_of(model, "gyro scale");
    constants.push_back(
        {"gyro scale", before,
         scaled(1.0 + coefficient_of(after, "gyro scale"), before, *found.gyro_scale), ""});
  }
  if (found.gyro_bias) {
    constants.push_back({"gyro bias", coefficient_of(model, "gyro bias"),
                         scaled(coefficient_of(after, "gyro bias"), 1.0, *found.gyro_bias),
                         "rad/s"});
  }
  return constants;
}

bool is_off(const std::optional<Estimate>& one, double nominal) {
  constexpr double kErrors = 3.0;
  return one && one->dof > 0.0 && std::abs(one->value - nominal) > kErrors * one->standard_error;
}

TapeVerdict tape_verdict(const TapeCalibration& found) {
  if (!found.doubts.empty()) return TapeVerdict::doubtful;
  bool judged = false;
  for (const auto& [one, nominal] :
       {std::pair(&found.scale, 1.0), std::pair(&found.turn_factor, 1.0),
        std::pair(&found.wheelbase_ratio, 1.0), std::pair(&found.diameter_ratio, 1.0),
        std::pair(&found.gyro_scale, 0.0), std::pair(&found.gyro_bias, 0.0)}) {
    if (is_off(*one, nominal)) return TapeVerdict::worth_correcting;
    judged = judged || (*one && (*one)->dof > 0.0);
  }
  return judged ? TapeVerdict::nothing_to_correct : TapeVerdict::unsure;
}

}  // namespace trussmap
