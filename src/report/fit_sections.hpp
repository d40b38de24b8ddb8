// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sections that pages on fitted models have in common.
#pragma once

#include "plot/fit_charts.hpp"
#include "report/comparison_page.hpp"
#include "report/fit_page.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// A model with the name that charts and tables call it by.
struct NamedModel {
  std::string name;
  const FittedModel& model;
};

/// The words of reports with the signs that a page has: "±" and "°".
[[nodiscard]] std::string typeset(std::string text);

/// "16 mm", "21 cm", "1.3 m". With `beside`, in the unit that suits the larger of the two.
[[nodiscard]] std::string distance_text(double metres, double beside = 0.0);

/// "hard iron: the compass reads up to 2.9° too much or too little".
[[nodiscard]] std::string effect_in_words(const FittedEffect& effect);

/// No misfit to speak of, as diagnose and discover count it.
[[nodiscard]] bool is_explained(const Comparison& comparison);

/// "Without it legs end 21 cm off; with it 1.6 cm, as good as this robot's noise allows." Empty
/// without held-out legs. `it`: "it", "them".
[[nodiscard]] std::string gain_sentence(const Comparison& before, const Comparison& after,
                                        const std::string& it);

/// Each effect as the recordings show it, how sure it is, and its coefficients.
[[nodiscard]] PageSection effect_section(const std::string& title,
                                         const std::vector<FittedEffect>& effects);

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
void move_tables_last(Page& page);

/// Every leg, and the worst.
[[nodiscard]] PageSection legs_section(const std::string& title, const Comparison& comparison);

/// A picture per variable.
[[nodiscard]] PageSection trend_section(const std::string& title, const Comparison& comparison,
                                        const std::vector<TrendPicture>& trends);

}  // namespace trussmap
