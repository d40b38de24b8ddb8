// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sections that pages on fitted models have in common.
#pragma once

#include "plot/fit_charts.hpp"
#include "report/page.hpp"
#include "trussmap/evidence.hpp"

#include <map>
#include <string>
#include <vector>

namespace trussmap::report {

/// A model with the name that charts and tables call it by.
struct NamedModel {
  std::string name;
  const ModelEvidence& model;
};

/// How far off held-out legs would end with an effect, m, by its name.
using LeftBy = std::map<std::string, double>;

/// Each effect as the recordings show it, beside its rivals with what each would leave; how sure it
/// is, and its coefficients.
[[nodiscard]] PageSection effect_section(const std::string& title,
                                         const std::vector<EffectEvidence>& effects,
                                         const LeftBy& left = {});

/// A staircase down to what noise alone leaves (`floor`, m). `ladder` may be empty: then it is the
/// two models.
[[nodiscard]] PageSection gain_section(const NamedModel& before, const NamedModel& after,
                                       double floor,
                                       const std::vector<plot::LadderStep>& ladder = {});

/// The map as each of the models has it, the same millimetres in the same colour, with rings round
/// the places of these effects.
[[nodiscard]] PageSection maps_section(const std::string& title,
                                       const std::vector<NamedModel>& models,
                                       const std::vector<EffectEvidence>& effects = {});

/// Source by source, beside the errors' scatter.
[[nodiscard]] PageSection noise_section(const std::vector<NamedModel>& models);
/// The same where the noise is what is wrong: as found, over what the model states.
[[nodiscard]] PageSection noise_section(const NamedModel& model, const FittedNoise& found);

/// What few ask for: tables, and sections that are nothing else, are closed.
void close_tables(PageContent& page);

/// Every leg, and the worst: for those who ask.
[[nodiscard]] PageSection legs_section(const std::string& title, const Comparison& comparison);

/// A picture per variable that errors go with, a sentence on the others.
[[nodiscard]] PageSection trend_section(const std::string& title, const Comparison& comparison,
                                        const std::vector<TrendEvidence>& trends);

}  // namespace trussmap::report
