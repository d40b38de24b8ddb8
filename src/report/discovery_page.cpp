// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT

#include "plot/fit_charts.hpp"
#include "report/changing_effects.hpp"
#include "report/diagnosis_tables.hpp"
#include "report/fit_sections.hpp"
#include "report/noise_verdict.hpp"
#include "report/page_words.hpp"
#include "report/places_found.hpp"
#include "report/result_rows.hpp"
#include "report/rivals.hpp"
#include "report/robot_off.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr const char* kModelGiven = "as given";
constexpr const char* kModelFound = "as found";

/// "as given", "+ hard iron".
std::string step_name(const DiscoveryStep& step) {
  std::string name = step.added ? "+ " + name_in_words(*step.added) : kModelGiven;
  for (const Effect& other : step.together) name += ", + " + name_in_words(other);
  for (const std::string& dropped : step.dropped) name += ", \u2212 " + dropped;
  return name;
}

std::vector<plot::LadderStep> ladder_of(const Discovery& discovery) {
  std::vector<plot::LadderStep> steps;
  for (const DiscoveryStep& one : discovery.steps) {
    steps.push_back({step_name(one), one.held_out.arrival_rms, one.chi2, one.dof});
    if (one.added && one.predicted.arrival_rms > 0.0) {
      steps.back().predicted_rms = one.predicted.arrival_rms;
    }
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
         k > 0 ? fmt::format("{:.1f}", discovery.steps[k - 1].chi2 - step.predicted_decrease) : "-",
         legs ? fmt::format("{:.1f}", 1000.0 * step.held_out.arrival_rms) : "-",
         k > 0 && legs ? fmt::format("{:.1f}", 1000.0 * step.predicted.arrival_rms) : "-"});
  }
  return table;
}

std::string whose_noise(const Discovery& discovery) {
  return noise_is_wrong(discovery.last) ? "the noise found" : "its noise";
}

/// "3.1 cm off, as good as this robot's noise allows", and by which noise.
std::string end_off(const HeldOut& legs, bool noise_found, bool explained) {
  return fmt::format("Legs end {} off{}.", distance_text(legs.arrival_rms),
                     !explained || !as_good_as_noise(legs) ? ""
                     : noise_found                         ? ", as good as the noise found allows"
                                   : ", as good as this robot's noise allows");
}

bool is_unexplained(const Discovery& discovery) {
  return !discovery.consistent && !is_slight_misfit(discovery.last);
}

std::string found_verdict(const Discovery& discovery, const DiscoveryEvidence& evidence) {
  const auto& effects = evidence.effects;
  const Comparison& now = evidence.found.comparison;
  const bool noise = noise_is_wrong(discovery.last);
  const std::string off =
      now.held_out.legs.empty()
          ? ""
          : " " + end_off(now.held_out, noise, discovery.consistent && now.consistent());
  if (!effects.empty()) {
    const std::string gain =
        gain_sentence(evidence.given.comparison, now, effects.size() == 1 ? "it" : "them");
    return fmt::format("Found: {}. {}", named_with_rivals(effects, evidence.look_alikes),
                       !gain.empty()      ? gain
                       : now.consistent() ? "The model now explains the measurements."
                                          : "Something is still unexplained.");
  }
  if (is_unexplained(discovery)) {
    return fmt::format("Nothing found, and something is unexplained: {}.{}",
                       objection_in_words(discovery.last, now), off);
  }
  return faultless_verdict(discovery.last, off);
}

/// What held-out legs cannot tell from the first effect found.
std::vector<NearRival> near_first(const Discovery& discovery, const Effect& effect) {
  for (const Finding& one : discovery.first.findings) {
    if (one.effect.name == effect.name) return near_rivals(discovery.first, one);
  }
  return {};
}

ResultRows found_rows(const Discovery& discovery, const DiscoveryEvidence& evidence) {
  ResultRows rows;
  rows.sure = {gone_text(discovery)};
  rows.off = off_sentences(evidence.given, evidence.found, "with the model found",
                           evidence.found.comparison.held_out.expected_rms, whose_noise(discovery));
  for (std::size_t k = 0; k < evidence.effects.size(); ++k) {
    const EffectEvidence& one = evidence.effects[k];
    const Effect& effect = one.estimate.effect;
    rows.missing.push_back(what_it_is(effect));
    rows.large.push_back(how_large(one));
    for (std::string& sentence :
         rival_sentences(effect, evidence.look_alikes[k],
                         k == 0 ? near_first(discovery, effect) : std::vector<NearRival>{})) {
      rows.otherwise.push_back(std::move(sentence));
    }
    if (!evidence.next_drives[k]) continue;
    rows.next.push_back(fmt::format("To tell {} from its rivals, {}.", short_name(effect),
                                    in_words(evidence.next_drives[k])));
  }
  for (const EffectEvidence& one : evidence.effects) {
    rows.next.push_back(what_helps(one.estimate.effect));
  }
  rows.next.emplace_back(
      "Use the model found (trussmap discover --out FILE writes it) with build, compare and the "
      "robot's own odometry.");
  return rows;
}

ResultRows rows_without(const Discovery& discovery, const DiscoveryEvidence& evidence) {
  const Diagnosis& last = discovery.last;
  const bool noise = noise_is_wrong(last);
  ResultRows rows;
  rows.missing = {is_unexplained(discovery)
                      ? fmt::format("Unknown: none of {} changes tried explains it.", last.tried)
                      : fmt::format("{}: none of {} changes tried explains more than chance.",
                                    noise ? "No effect" : "Nothing", last.tried)};
  if (noise) rows.large = {fmt::format("Noise: {}.", found_and_stated(last.under->noise))};
  rows.large.push_back(seen_from_note({last, evidence.sizes}));
  rows.sure = {fmt::format("Errors as large arise from noise alone, with probability {}.",
                           chance_text(evidence.found.comparison.p_value))};
  rows.off = off_sentences(evidence.found, whose_noise(discovery));
  const std::vector<std::string> unseen = unseen_names(last);
  rows.otherwise = {
      unseen.empty()
          ? "Nothing that was looked for is hidden from these recordings."
          : fmt::format("Hidden from these recordings, and so perhaps there: {}.", listed(unseen))};
  if (noise) {
    rows.next = {"Use the noise found (trussmap discover --out FILE writes it into the model)."};
  }
  rows.next.push_back(drive_that_shows_more(last));
  return rows;
}

ResultRows rows_on(const Discovery& discovery, const DiscoveryEvidence& evidence) {
  ResultRows rows = evidence.effects.empty() ? rows_without(discovery, evidence)
                                             : found_rows(discovery, evidence);
  if (!evidence.effects.empty() || is_unexplained(discovery)) {
    rows.missing.push_back(fmt::format("Looked for more: {}.", stop_in_words(discovery)));
  }
  const std::vector<std::string> others = others_notes(discovery.last);
  // Noise that is the headline is no further suspect.
  const bool said = evidence.effects.empty() && noise_is_wrong(discovery.last);
  rows.otherwise.insert(rows.otherwise.end(), others.begin() + (said ? 1 : 0), others.end());
  return rows;
}

}  // namespace

Page discovery_page(const Discovery& discovery, const DiscoveryEvidence& evidence,
                    const std::string& subject) {
  const SizedDiagnosis sized{discovery.last, evidence.sizes};
  const bool found_any = !evidence.effects.empty();
  PageContent page;
  page.command = "discover";
  page.subject = subject;
  page.verdict = with_judged(found_verdict(discovery, evidence), discovery.sightings);
  const bool noise_alone = !found_any && noise_is_wrong(discovery.last);
  page.tone = noise_alone || is_unexplained(discovery) ? Tone::bad
              : discovery.consistent                   ? Tone::good
                                                       : Tone::neutral;
  page.answers = answers_of(rows_on(discovery, evidence));
  const NamedModel given{kModelGiven, evidence.given};
  const NamedModel found{kModelFound, evidence.found};
  std::vector<NamedModel> models{given};
  if (found_any) {
    PageSection gain = gain_section(given, found, evidence.found.comparison.held_out.expected_rms,
                                    ladder_of(discovery));
    gain.details.emplace_back(step_table(discovery));
    page.sections.push_back(std::move(gain));
    page.sections.push_back(effect_section("What was found", evidence.effects));
    for (std::size_t k = 0; k < evidence.between.size(); ++k) {
      models.push_back({step_name(discovery.steps[k + 1]), evidence.between[k]});
    }
    models.push_back(
        {evidence.between.empty() ? kModelFound : last_name(discovery), evidence.found});
  }
  PageSection noise = noise_alone ? noise_section(given, discovery.last.under->noise)
                      : found_any ? noise_section({given, found})
                                  : noise_section({given});
  PageTable sources = noise_table(discovery.last);
  if (!sources.rows.empty()) noise.details.emplace_back(std::move(sources));
  if (noise_alone) page.sections.push_back(noise);
  page.sections.push_back(
      maps_section("Where legs end off, model by model", models, evidence.effects));
  add_changes(discovery.last, page);
  add_places(discovery.last, page);
  if (!noise_alone) page.sections.push_back(std::move(noise));
  page.sections.push_back(trend_section("What errors go with, in the model found",
                                        evidence.found.comparison, evidence.trends));
  page.sections.push_back(legs_section("Legs, in the model found", evidence.found.comparison));
  page.sections.push_back({"Part by part", {parts_table(sized, evidence.effects)}});
  page.sections.push_back(tried_section(sized));
  close_tables(page);
  return page;
}

}  // namespace trussmap
