// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/fit_page.hpp"

#include "plot/fit_charts.hpp"
#include "report/fit_sections.hpp"
#include "wording/effect_words.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr const char* kBefore = "without effects";
constexpr const char* kAfter = "with them";

std::string millimetres(const Comparison& one) {
  return fmt::format("{:.0f} mm", 1000.0 * one.held_out.arrival_rms);
}

std::string verdict(const Comparison& before, const Comparison& after,
                    const std::vector<FittedEffect>& effects) {
  std::string text;
  if (effects.size() == 1) {
    const EffectEstimate& only = effects.front().estimate;
    text = only.effect.name + ": " + typeset(in_words(only.effect, only.sd)) + ".";
  } else {
    text = fmt::format("{} effects fitted.", effects.size());
  }
  if (!before.held_out.legs.empty() && !after.held_out.legs.empty()) {
    text += fmt::format(" Legs that no fit has seen end {} off without, {} with.",
                        millimetres(before), millimetres(after));
  }
  return text + (after.consistent ? " The model now explains the measurements."
                                  : " Something is still unexplained.");
}

constexpr std::size_t kMostRivalsDrawn = 3;

/// The first few, with the coefficients that each would have.
std::vector<Effect> drawn_rivals(const std::vector<LookAlike>& rivals, const ScoreTest& tests) {
  std::vector<Effect> drawn;
  for (const LookAlike& one : rivals) {
    if (drawn.size() == kMostRivalsDrawn) break;
    drawn.push_back(one.effect);
  }
  const std::vector<Score> scores = tests.test(drawn);
  for (std::size_t k = 0; k < drawn.size(); ++k) drawn[k].coefficients = scores[k].coefficients;
  return drawn;
}

}  // namespace

FittedModel fitted_model(const ModelFit& fit, Comparison comparison) {
  return {std::move(comparison), fitted_map(fit),
          residuals_by_source(fit.problem, snoop(fit.problem, fit.columns.border, fit.adjustment))};
}

FittedModel fitted_model(const std::vector<Recording>& recordings, const ModelFit& fit,
                         const ScoreTest& tests, const ComparisonOptions& options) {
  return fitted_model(fit, compare(recordings, fit.model, options, fit, tests));
}

std::vector<FittedEffect> fitted_effects(const ModelFit& without,
                                         const std::vector<EffectEstimate>& effects,
                                         const std::vector<std::vector<LookAlike>>& rivals) {
  std::vector<FittedEffect> result;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const Effect& effect = effects[k].effect;
    ScoreTest tests(without);
    for (std::size_t other = 0; other < effects.size(); ++other) {
      if (other != k) tests.condition_on(tests.columns(effects[other].effect));
    }
    FittedEffect one{effects[k], {}, range_of(effect, tests.context()), {}};
    if (k < rivals.size()) one.rivals = drawn_rivals(rivals[k], tests);
    const std::string variable = place_of(effect) ? kPlace : natural_variable(effect);
    if (!variable.empty()) {
      one.response = response_along(variable, effect, without, tests, one.rivals);
    }
    result.push_back(std::move(one));
  }
  return result;
}

Page fit_page(const FittedModel& without, const FittedModel& with,
              const std::vector<FittedEffect>& effects, const std::string& subject) {
  const Comparison& before = without.comparison;
  const Comparison& after = with.comparison;
  Page page;
  page.command = "fit";
  page.subject = subject;
  page.tone = after.consistent ? Tone::good : Tone::bad;
  page.verdict = verdict(before, after, effects);
  page.facts = {
      {fmt::format("{:.2f}", before.misfit()), "chi\u00b2 per degree of freedom without effects"},
      {fmt::format("{:.2f}", after.misfit()), "the same with them (1 is right)", page.tone}};
  if (!after.held_out.legs.empty()) {
    page.facts.push_back({millimetres(before), "held-out legs end so far off without effects"});
    page.facts.push_back({millimetres(after), "the same with them", page.tone});
  }
  for (const FittedEffect& one : effects) {
    if (effects.size() > 1) {
      page.notes.push_back(one.estimate.effect.name + ": " +
                           typeset(in_words(one.estimate.effect, one.estimate.sd)));
    }
    for (const std::string& why : one.estimate.not_fitted) page.notes.push_back(why);
  }
  page.notes.insert(page.notes.end(), after.warnings.begin(), after.warnings.end());
  const NamedModel given{kBefore, without};
  const NamedModel fitted{kAfter, with};
  page.sections.push_back(effect_section("The effects", effects));
  page.sections.push_back(gain_section(given, fitted));
  page.sections.push_back(maps_section("The map, before and after", {given, fitted}));
  page.sections.push_back(legs_section("Legs, with the effects", after));
  move_tables_last(page);
  return page;
}

}  // namespace trussmap
