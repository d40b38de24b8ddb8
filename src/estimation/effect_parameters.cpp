// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/effect_parameters.hpp"

namespace trussmap {
namespace {

DrivePattern pattern_of(PlainEffect effect, double left, double right, double wheelbase) {
  const double path = 0.5 * (left + right);
  const double turn = (right - left) / wheelbase;
  switch (effect) {
    case PlainEffect::turn:
      return {0.0, 0.0, turn, 0.0};
    case PlainEffect::difference:
      return {0.25 * (right - left), 0.0, path / wheelbase, 0.0};
    case PlainEffect::wheels:
      return {path, 0.0, turn, 0.0};
    case PlainEffect::compass:
      return {0.0, 0.0, 0.0, 1.0};
  }
  return {};
}

const char* name_of(PlainEffect effect) {
  switch (effect) {
    case PlainEffect::turn:
      return "turn";
    case PlainEffect::difference:
      return "difference";
    case PlainEffect::wheels:
      return "wheels";
    case PlainEffect::compass:
      return "compass";
  }
  return "";
}

}  // namespace

std::vector<int> unknown_coefficients(const EffectParameters& border) {
  std::vector<int> unknown;
  for (std::size_t k = 0; k < border.size(); ++k) {
    if (!border[k].held) unknown.push_back(static_cast<int>(k));
  }
  return unknown;
}

EffectPattern plain_effect(PlainEffect effect, const std::vector<Recording>& recordings,
                           const Robot& robot) {
  EffectPattern result;
  result.name = name_of(effect);
  for (const Recording& recording : recordings) {
    const Drive& drive = recording.drive;
    std::vector<DrivePattern>& patterns = result.drives.emplace_back();
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      patterns.push_back(pattern_of(effect, drive.left[row], drive.right[row], robot.wheelbase));
    }
  }
  return result;
}

}  // namespace trussmap
