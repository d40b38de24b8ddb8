// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/fit_sections.hpp"
#include "report/page_words.hpp"
#include "trussmap/wording.hpp"

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

std::string page_verdict(const Comparison& before, const Comparison& after,
                         const std::vector<EffectEvidence>& effects) {
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
  return text + (after.consistent() ? " The model now explains the measurements."
                                    : " Something is still unexplained.");
}

}  // namespace

Page fit_page(const FitEvidence& evidence, const std::string& subject) {
  const Comparison& before = evidence.without.comparison;
  const Comparison& after = evidence.with.comparison;
  const std::vector<EffectEvidence>& effects = evidence.effects;
  PageContent page;
  page.command = "fit";
  page.subject = subject;
  page.tone = after.consistent() ? Tone::good : Tone::bad;
  page.verdict = page_verdict(before, after, effects);
  page.facts = {
      {fmt::format("{:.2f}", before.misfit()), "chi\u00b2 per degree of freedom without effects"},
      {fmt::format("{:.2f}", after.misfit()), "the same with them (1 is right)", page.tone}};
  if (!after.held_out.legs.empty()) {
    page.facts.push_back({millimetres(before), "held-out legs end so far off without effects"});
    page.facts.push_back({millimetres(after), "the same with them", page.tone});
  }
  for (const EffectEvidence& one : effects) {
    if (effects.size() > 1) {
      page.notes.push_back(one.estimate.effect.name + ": " +
                           typeset(in_words(one.estimate.effect, one.estimate.sd)));
    }
    for (const UnfittedCoefficient& why : one.estimate.not_fitted) {
      page.notes.push_back(in_words(one.estimate, why));
    }
  }
  if (!evidence.noise.empty()) {
    page.notes.push_back("Under the noise as estimated, other than the model stated it: " +
                         typeset(evidence.noise) + ".");
  }
  page.notes.insert(page.notes.end(), after.warnings.begin(), after.warnings.end());
  const NamedModel given{kBefore, evidence.without};
  const NamedModel fitted{kAfter, evidence.with};
  page.sections.push_back(effect_section("The effects", effects));
  page.sections.push_back(gain_section(given, fitted));
  page.sections.push_back(maps_section("The map, before and after", {given, fitted}));
  page.sections.push_back(legs_section("Legs, with the effects", after));
  move_tables_last(page);
  return page;
}

}  // namespace trussmap
