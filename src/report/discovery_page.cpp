// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT

#include "plot/fit_charts.hpp"
#include "report/diagnosis_tables.hpp"
#include "report/fit_sections.hpp"
#include "report/page_words.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr const char* kModelGiven = "as given";
constexpr const char* kModelFound = "as found";

/// "as given", "+ hard iron".
std::string step_name(const DiscoveryStep& step) {
  std::string name = step.added ? "+ " + name_in_words(*step.added) : kModelGiven;
  for (const std::string& dropped : step.dropped) name += ", \u2212 " + dropped;
  return name;
}

std::vector<LadderStep> ladder_of(const Discovery& discovery) {
  std::vector<LadderStep> steps;
  for (const DiscoveryStep& one : discovery.steps) {
    steps.push_back({step_name(one), one.held_out.arrival_rms, one.chi2, one.dof});
  }
  return steps;
}

/// The last line of the ladder.
std::string last_name(const Discovery& discovery) {
  return step_name(discovery.steps.back());
}

/// What an addition took away of chi^2, where that says how sure it is.
std::string gone_text(const Discovery& discovery) {
  std::vector<std::string> parts;
  for (std::size_t k = 1; k < discovery.steps.size(); ++k) {
    const DiscoveryStep& step = discovery.steps[k];
    const double fell = discovery.steps[k - 1].chi2 - step.chi2;
    if (!step.added || !(fell > 0.0)) continue;
    parts.push_back(fmt::format("{} explains {:.2g} % of the squared errors{}",
                                short_name(*step.added), 100.0 * fell / discovery.steps[k - 1].chi2,
                                k > 1 ? " that were left" : ""));
  }
  if (parts.empty()) return "";
  return fmt::format(
      "{}. {} significant with all tests allowed for, and predict{} legs that no fit has seen.",
      capitalised(listed(parts)), parts.size() == 1 ? "It is" : "All are",
      parts.size() == 1 ? "s" : "");
}

PageTable step_table(const Discovery& discovery) {
  PageTable table;
  table.caption = "The steps: what was predicted before each fit, and what came of it";
  table.headings = {"model",
                    "chi\u00b2",
                    "degrees of freedom",
                    "predicted chi\u00b2",
                    "legs end off [mm]",
                    "predicted [mm]"};
  for (std::size_t k = 0; k < discovery.steps.size(); ++k) {
    const DiscoveryStep& step = discovery.steps[k];
    const bool legs = !step.held_out.legs.empty();
    table.rows.push_back(
        {step_name(step), fmt::format("{:.1f}", step.chi2), std::to_string(step.dof),
         k > 0 ? fmt::format("{:.1f}", discovery.steps[k - 1].chi2 - step.predicted_chi2) : "-",
         legs ? fmt::format("{:.1f}", 1000.0 * step.held_out.arrival_rms) : "-",
         k > 0 && legs ? fmt::format("{:.1f}", 1000.0 * step.predicted.arrival_rms) : "-"});
  }
  return table;
}

std::string found_verdict(const Discovery& discovery, const DiscoveryEvidence& evidence) {
  const auto& effects = evidence.effects;
  const Comparison& now = evidence.found.comparison;
  if (effects.empty()) {
    const std::string off = now.held_out.legs.empty()
                                ? ""
                                : " Legs end " + distance_text(now.held_out.arrival_rms) + " off";
    if (!discovery.consistent) {
      return "Nothing found, and something is unexplained: " + objection_in_words(now) + "." +
             (off.empty() ? "" : off + ".");
    }
    return fmt::format("Nothing is missing: none of {} changes tried explains more than chance.",
                       discovery.last.tried) +
           (off.empty() ? "" : off + ", as good as this robot's noise allows.");
  }
  std::string text = "Found: ";
  text += named_with_sizes(effects);
  const std::string gain =
      gain_sentence(evidence.given.comparison, now, effects.size() == 1 ? "it" : "them");
  if (!gain.empty()) return text + ". " + gain;
  return text + (now.consistent() ? ". The model now explains the measurements."
                                  : ". Something is still unexplained.");
}

std::vector<PageFact> found_facts(const Discovery& discovery, const DiscoveryEvidence& evidence) {
  std::vector<PageFact> facts;
  for (const EffectEvidence& one : evidence.effects) {
    const SizeText size = size_text_of(one);
    facts.push_back({size.size, short_name(one.estimate.effect) + " at its most" +
                                    (size.error.empty() ? "" : "; standard error " + size.error)});
  }
  const Comparison& given = evidence.given.comparison;
  const Comparison& found = evidence.found.comparison;
  const Tone tone = found.consistent() ? Tone::good : Tone::bad;
  if (!found.held_out.legs.empty()) {
    const double off = given.held_out.arrival_rms;
    const double now = found.held_out.arrival_rms;
    if (!evidence.effects.empty()) {
      facts.push_back({distance_text(off, now), kLegsEnded, Tone::bad});
    }
    facts.push_back({distance_text(now, off), kLegsEndNow, tone});
  }
  facts.push_back({fmt::format("{:.2f}", found.misfit()),
                   "chi\u00b2 per degree of freedom now (1 is right)", tone});
  if (evidence.effects.empty()) {
    facts.push_back({std::to_string(discovery.last.tried), "changes to the model tried"});
  }
  return facts;
}

std::vector<PageAnswer> found_answers(const Discovery& discovery,
                                      const DiscoveryEvidence& evidence) {
  const std::vector<std::vector<LookAlike>>& rivals = evidence.look_alikes;
  std::vector<PageAnswer> answers;
  for (const EffectEvidence& one : evidence.effects) {
    answers.push_back({kHowLarge, sized_in_words(one)});
  }
  if (!evidence.effects.empty()) answers.push_back({kHowSure, gone_text(discovery)});
  for (std::size_t k = 0; k < evidence.effects.size(); ++k) {
    answers.push_back({kWhatElse, rivals_note(evidence.effects[k].estimate.effect, rivals[k])});
  }
  for (std::size_t k = 0; k < evidence.effects.size(); ++k) {
    if (!evidence.next_drives[k]) continue;
    const Effect& effect = evidence.effects[k].estimate.effect;
    answers.push_back({kNext, fmt::format("To tell {} from its rivals, {}.", short_name(effect),
                                          in_words(evidence.next_drives[k]))});
  }
  if (!evidence.effects.empty()) {
    answers.push_back({kNext,
                       "Use the model found (trussmap discover --out FILE writes it) with build, "
                       "compare and the robot's own odometry."});
  } else if (!discovery.last.lacks.empty()) {
    answers.push_back({kNext, advised_drive(advice_on(discovery.last.lacks.front()))});
  }
  for (const EffectEvidence& one : evidence.effects) {
    answers.push_back({kCause, cause_note(one.estimate.effect)});
  }
  if (evidence.effects.empty())
    answers.push_back({kSeen, seen_from_note({discovery.last, evidence.sizes})});
  answers.push_back({"Why it stopped", capitalised(stop_in_words(discovery)) + "."});
  for (std::string& note : others_notes(discovery.last)) {
    answers.push_back({kBeside, std::move(note)});
  }
  std::erase_if(answers, [](const PageAnswer& one) { return one.answer.empty(); });
  return answers;
}

}  // namespace

Page discovery_page(const Discovery& discovery, const DiscoveryEvidence& evidence,
                    const std::string& subject) {
  const SizedDiagnosis sized{discovery.last, evidence.sizes};
  PageContent page;
  page.command = "discover";
  page.subject = subject;
  page.verdict = found_verdict(discovery, evidence);
  page.tone = discovery.consistent ? Tone::good : Tone::bad;
  page.facts = found_facts(discovery, evidence);
  page.answers = found_answers(discovery, evidence);
  page.sections.push_back({"Part by part", {parts_table(sized, evidence.effects)}});
  PageTable noise = noise_table(discovery.last);
  if (!noise.rows.empty()) page.sections.back().blocks.emplace_back(std::move(noise));
  const NamedModel given{kModelGiven, evidence.given};
  const NamedModel found{kModelFound, evidence.found};
  if (evidence.effects.empty()) {
    page.sections.push_back(fit_section(given));
  } else {
    PageSection gain = gain_section(given, found, ladder_of(discovery));
    gain.blocks.emplace_back(step_table(discovery));
    page.sections.push_back(std::move(gain));
    page.sections.push_back(effect_section("What was found", evidence.effects));
    std::vector<NamedModel> models{given};
    for (std::size_t k = 0; k < evidence.between.size(); ++k) {
      models.push_back({step_name(discovery.steps[k + 1]), evidence.between[k]});
    }
    models.push_back(
        {evidence.between.empty() ? kModelFound : last_name(discovery), evidence.found});
    page.sections.push_back(maps_section("The map, model by model", models));
  }
  page.sections.push_back(trend_section("What errors go with, in the model found",
                                        evidence.found.comparison, evidence.trends));
  page.sections.push_back(legs_section("Legs, in the model found", evidence.found.comparison));
  page.sections.push_back(tried_section(sized));
  move_tables_last(page);
  return page;
}

}  // namespace trussmap
