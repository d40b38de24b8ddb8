// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Findings as constants to paste (trussmap/calibrate.hpp).
#include "text/number_text.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/discover.hpp"

#include <algorithm>

namespace trussmap {
namespace {

/// A sentence where recordings cannot tell it from something else.
void doubt(const Effect& effect, const std::vector<LookAlike>& alike, RobotConstants& constants) {
  const LookAlike* rival = closest_rival(alike);
  if (rival == nullptr) return;
  constants.doubts.push_back(text::joined(effect.name, " looks the same here as ",
                                          rival->effect.name, ": tell them apart first"));
}

}  // namespace

RobotConstants robot_constants(const Diagnosis& diagnosis, const Model& before) {
  std::vector<EffectEstimate> effects;
  for (const Effect& one : before.effects) {
    effects.push_back({one, std::vector<double>(one.coefficients.size(), 0.0), {}});
  }
  RobotConstants constants;
  bool any = false;
  for (const Finding& one : diagnosis.findings) {
    if (one.status != Status::missing) continue;
    any = true;
    EffectEstimate estimate{one.effect, one.sd, {}};
    if (!one.joint.empty()) {
      estimate.effect.coefficients = one.joint;
      estimate.sd = one.joint_sd;
    }
    effects.push_back(std::move(estimate));
  }
  if (!any) return constants;
  constants = robot_constants(before, effects);
  for (const Finding& one : diagnosis.findings) {
    if (one.status == Status::missing) doubt(one.effect, one.look_alikes, constants);
  }
  return constants;
}

RobotConstants robot_constants(const Discovery& discovery, const Model& before) {
  if (discovery.steps.size() < 2 && before.effects.empty()) return {};
  RobotConstants constants = robot_constants(before, discovery.found);
  for (const DiscoveryStep& step : discovery.steps) {
    const auto is_there = [&step](const EffectEstimate& one) {
      return one.effect.name == step.added->name;
    };
    if (!step.added ||
        std::none_of(discovery.found.effects.begin(), discovery.found.effects.end(), is_there)) {
      continue;
    }
    doubt(*step.added, step.look_alikes, constants);
  }
  return constants;
}

}  // namespace trussmap
