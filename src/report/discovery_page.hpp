// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of a discovery: the model as given and as found, and the steps between.
#pragma once

#include "criticism/discovery.hpp"
#include "report/diagnosis_page.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// A model between the one given and the one found, as the ladder names it.
struct FittedStep {
  std::string name;
  FittedModel model;
};

/// Name of a step's model: "as given", "+ hard iron".
[[nodiscard]] std::string step_name(const DiscoveryStep& step);

struct DiscoveryPictures {
  FittedModel given;
  std::vector<FittedStep> between;
  FittedModel found;
  std::vector<FittedEffect> effects;  ///< that were added and stayed
  std::vector<TrendPicture> trends;   ///< of the model found
  DiagnosisTables tables;             ///< of its last diagnosis, `effects` among the parts
};

/// Effects of the model found that the model given does not have, and what looks like each.
struct AddedEffects {
  std::vector<EffectEstimate> estimates;
  std::vector<std::vector<LookAlike>> rivals;
};
[[nodiscard]] AddedEffects added_effects(const Discovery& discovery);

[[nodiscard]] Page discovery_page(const Discovery& discovery, const DiscoveryPictures& pictures,
                                  const std::string& subject);

}  // namespace trussmap
