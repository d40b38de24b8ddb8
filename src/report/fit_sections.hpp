// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sections that pages on fitted models have in common.
#pragma once

#include "plot/fit_charts.hpp"
#include "report/page.hpp"
#include "trussmap/evidence.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// A model with the name that charts and tables call it by.
struct NamedModel {
  std::string name;
  const ModelEvidence& model;
};

/// Each effect as the recordings show it, how sure it is, and its coefficients.
[[nodiscard]] PageSection effect_section(const std::string& title,
                                         const std::vector<EffectEvidence>& effects);

/// `ladder` may be empty: then it is the two models.
[[nodiscard]] PageSection gain_section(const NamedModel& before, const NamedModel& after,
                                       const std::vector<LadderStep>& ladder = {});

/// The map as each of the models has it, the same force in the same colour.
[[nodiscard]] PageSection maps_section(const std::string& title,
                                       const std::vector<NamedModel>& models);

/// One model alone: its map, its noise, its held-out legs.
[[nodiscard]] PageSection fit_section(const NamedModel& model);

/// Q-Q charts of the models that have errors enough to draw, side by side.
void add_quantiles(PageSection& section, const std::vector<NamedModel>& models);

/// Pictures first: tables of sections that have charts go to a section of their own at the end.
void move_tables_last(PageContent& page);

/// Every leg, and the worst.
[[nodiscard]] PageSection legs_section(const std::string& title, const Comparison& comparison);

/// A picture per variable.
[[nodiscard]] PageSection trend_section(const std::string& title, const Comparison& comparison,
                                        const std::vector<TrendEvidence>& trends);

}  // namespace trussmap
