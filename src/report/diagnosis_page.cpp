// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/place.hpp"
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
#include "report/sets_of_effects.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr const char* kGiven = "as given";
constexpr std::size_t kChangesDrawn = 6;

std::string with_name(const DiagnosisEvidence& evidence) {
  return evidence.effects.size() == 1
             ? "with " + short_name(evidence.effects.front().estimate.effect)
             : "with what is missing";
}

std::vector<std::vector<LookAlike>> rivals_of(const Diagnosis& diagnosis) {
  std::vector<std::vector<LookAlike>> rivals;
  for (const Finding* one : found_by(diagnosis)) rivals.push_back(one->look_alikes);
  return rivals;
}

std::string missing_verdict(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  const auto& effects = evidence.effects;
  const bool matters = diagnosis.findings.front().status == Status::missing;
  std::string text =
      fmt::format("{}: {}.", matters ? "Missing" : "Missing, but too small to matter",
                  named_with_rivals(effects, rivals_of(diagnosis)));
  const std::string it = effects.size() == 1 ? "it" : "them";
  if (evidence.with) {
    const std::string gain =
        gain_sentence(evidence.given.comparison, evidence.with->comparison, it);
    return gain.empty() ? text : text + " " + gain;
  }
  if (diagnosis.held_out.legs.empty()) return text;
  const double off = diagnosis.held_out.arrival_rms;
  const double with = diagnosis.findings.front().held_out.arrival_rms;
  return text + fmt::format(" Legs end {} off, {} with {}, as predicted.", distance_text(off, with),
                            distance_text(with, off), effects.size() == 1 ? "it" : "the first");
}

std::string legs_end(const Diagnosis& diagnosis) {
  const HeldOut& legs = diagnosis.held_out;
  if (legs.legs.empty()) return "";
  return fmt::format(" Legs end {} off{}.", distance_text(legs.arrival_rms),
                     diagnosis.objection == Objection::none && as_good_as_noise(legs)
                         ? ", as good as this robot's noise allows"
                         : "");
}

std::string page_verdict(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  switch (diagnosis.verdict) {
    case Diagnosis::Verdict::missing:
      return missing_verdict(diagnosis, evidence);
    case Diagnosis::Verdict::nothing_missing:
      return faultless_verdict(diagnosis, legs_end(diagnosis));
    case Diagnosis::Verdict::unexplained_misfit:
      if (is_slight_misfit(diagnosis)) return faultless_verdict(diagnosis, legs_end(diagnosis));
      break;
  }
  const std::string text = "Something is wrong that no effect explains: " +
                           objection_in_words(diagnosis, evidence.given.comparison) + ".";
  const std::vector<std::string> others = others_notes(diagnosis);
  return others.empty() ? text : text + " " + others.front();
}

ResultRows missing_rows(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  ResultRows rows;
  const std::vector<const Finding*> found = found_by(diagnosis);
  for (const EffectEvidence& one : evidence.effects) {
    rows.missing.push_back(what_it_is(one.estimate.effect));
    rows.large.push_back(how_large(one));
  }
  rows.sure = {sure_text(diagnosis.p_value, diagnosis.tried)};
  for (const Finding* one : found) {
    const bool first = one == found.front();
    for (std::string& sentence :
         rival_sentences(one->effect, one->look_alikes,
                         first ? near_rivals(diagnosis, *one) : std::vector<NearRival>{})) {
      rows.otherwise.push_back(std::move(sentence));
    }
  }
  for (std::string& one : sentences_of(diagnosis.changing))
    rows.otherwise.push_back(std::move(one));
  for (std::string& one : sentences_of(diagnosis.places)) rows.otherwise.push_back(std::move(one));
  if (diagnosis.next_drive) {
    rows.next.push_back("To tell them apart, " + in_words(diagnosis.next_drive) + ".");
  }
  for (const EffectEvidence& one : evidence.effects) {
    rows.next.push_back(what_helps(one.estimate.effect));
  }
  rows.next.emplace_back(
      "Put it into the model (trussmap add) and estimate it (trussmap fit), or have trussmap "
      "discover do both, and look for more.");
  return rows;
}

ResultRows faultless_rows(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  ResultRows rows;
  const bool noise = noise_is_wrong(diagnosis);
  rows.missing = {fmt::format("{}: none of {} changes tried explains more than chance.",
                              noise ? "No effect" : "Nothing", diagnosis.tried)};
  if (noise) {
    rows.large = {fmt::format("Noise: {}.", found_and_stated(diagnosis.under->noise))};
  }
  rows.large.push_back(seen_from_note({diagnosis, evidence.sizes}));
  rows.sure = {"What is ruled out would have been named nine times in ten, had it been there.",
               fmt::format("Errors as large arise from noise alone, with probability {}.",
                           chance_text(evidence.given.comparison.p_value))};
  const std::vector<std::string> unseen = unseen_names(diagnosis);
  rows.otherwise = {unseen.empty() ? "Nothing that was looked for is hidden from these recordings."
                                   : "Hidden from these recordings, and so perhaps there: " +
                                         listed(unseen) + "."};
  if (noise) {
    rows.next = {"Write the noise found into the model (trussmap fit --noise --out FILE)."};
  }
  rows.next.push_back(drive_that_shows_more(diagnosis));
  if (!noise && rows.next.back().empty()) rows.next.emplace_back("Use the model as it is.");
  return rows;
}

ResultRows unexplained_rows(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  const Comparison& given = evidence.given.comparison;
  ResultRows rows;
  rows.missing = {fmt::format("Unknown: none of {} changes tried explains it.", diagnosis.tried)};
  rows.large = {capitalised(objection_in_words(given)) + "."};
  rows.sure = {
      fmt::format("Errors as large arise from noise alone, were the model right, with "
                  "probability {}.",
                  chance_text(given.p_value))};
  const std::string noisy = noisier_than_stated(given);
  if (!noisy.empty()) {
    rows.otherwise = {fmt::format("Noise that is stated too small: {} what is stated.", noisy)};
    rows.next = {
        fmt::format("Check the noise in the model. Errors beside what it states: {}. "
                    "Correct it, and diagnose again.",
                    noisy)};
  }
  rows.next.push_back(drive_that_shows_more(diagnosis));
  return rows;
}

/// Of a model that has what is there, but a coefficient of it changes.
ResultRows changing_rows(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  ResultRows rows;
  const ChangingCoefficient& first = diagnosis.changing.front();
  rows.missing = {capitalised(objection_in_words(diagnosis, evidence.given.comparison)) + "."};
  rows.large = sentences_of(diagnosis.changing);
  rows.sure = {
      fmt::format("Were it the same all the time, noise would show as much with "
                  "probability {}.",
                  chance_text(first.p_value))};
  rows.next = {first.goes_with.empty()
                   ? "Look for what happened then, and record it as a column: with it the change "
                     "can be part of the model."
                   : fmt::format("Put an effect that goes with {} into the model (trussmap add).",
                                 first.goes_with.front())};
  return rows;
}

/// Of a model that has what is there, but something differs from place to place.
ResultRows place_rows(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  ResultRows rows;
  rows.missing = {capitalised(objection_in_words(diagnosis, evidence.given.comparison)) + "."};
  rows.large = sentences_of(diagnosis.places);
  rows.sure = {
      fmt::format("Were it the same everywhere, noise would show as much with probability {}.",
                  chance_text(diagnosis.places.front().p_value))};
  rows.next = {"Look at its map for what the floor, or the building, has there."};
  return rows;
}

ResultRows rows_on(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  ResultRows rows =
      diagnosis.verdict == Diagnosis::Verdict::missing ? missing_rows(diagnosis, evidence)
      : diagnosis.objection == Objection::change       ? changing_rows(diagnosis, evidence)
      : diagnosis.objection == Objection::place        ? place_rows(diagnosis, evidence)
      : diagnosis.verdict == Diagnosis::Verdict::nothing_missing || is_slight_misfit(diagnosis)
          ? faultless_rows(diagnosis, evidence)
          : unexplained_rows(diagnosis, evidence);
  rows.off = evidence.with
                 ? off_sentences(evidence.given, *evidence.with, with_name(evidence),
                                 noise_floor(diagnosis, evidence))
                 : off_sentences(evidence.given,
                                 noise_is_wrong(diagnosis) ? "the noise found" : "its noise");
  const bool noise = noise_is_wrong(diagnosis);
  const bool missing = diagnosis.verdict == Diagnosis::Verdict::missing;
  if (noise && !missing) rows.off.push_back(noise_gain(evidence));
  if (noise && missing) {
    rows.otherwise.emplace_back(
        "The noise seems other than stated, too, but what is missing looks like noise until it is "
        "in the model: look again then.");
  }
  // Noise that is the headline, or was spoken of just now, is the first of them.
  const bool said = noise && diagnosis.verdict != Diagnosis::Verdict::unexplained_misfit;
  const std::vector<std::string> others = others_notes(diagnosis);
  rows.otherwise.insert(rows.otherwise.end(), others.begin() + (said ? 1 : 0), others.end());
  return rows;
}

LeftBy left_by(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  LeftBy left;
  if (diagnosis.held_out.legs.empty()) return left;
  for (const Finding& one : diagnosis.findings) {
    left.emplace(one.effect.name, one.held_out.arrival_rms);
  }
  if (!evidence.with) return left;
  for (const EffectEvidence& one : evidence.effects) {  // fitted with the others
    left[one.estimate.effect.name] = evidence.with->comparison.held_out.arrival_rms;
  }
  return left;
}

/// What the best changes of different names would leave of the held-out error, rivals first.
plot::Chart changes_chart(const Diagnosis& diagnosis, double floor) {
  std::vector<plot::LadderStep> steps{
      {kGiven, diagnosis.held_out.arrival_rms, diagnosis.chi2, diagnosis.dof}};
  for (const Finding& one : diagnosis.findings) {
    if (steps.size() > kChangesDrawn) break;
    // What shows only beside the first changes little alone.
    if (steps.size() > 1 && one.status == Status::missing) continue;
    steps.push_back({"+ " + name_in_words(one.effect), one.held_out.arrival_rms,
                     diagnosis.chi2 - one.score, diagnosis.dof - one.dof});
  }
  plot::Chart chart = plot::ladder_chart("changes", steps, floor);
  chart.title = "What each change would leave";
  chart.caption =
      "How far off held-out legs would end (root mean square) with each of the best changes alone, "
      "as the diagnosis predicts it before any fit. Shorter is better; dashed: what noise alone "
      "would leave.";
  return chart;
}

PageSection cause_section(const SizedDiagnosis& sized, const DiagnosisEvidence& evidence) {
  const Diagnosis& diagnosis = sized.diagnosis;
  PageSection section =
      effect_section("The suspected cause", evidence.effects, left_by(diagnosis, evidence));
  if (!diagnosis.held_out.legs.empty()) {
    section.blocks.emplace_back(
        ChartRow{changes_chart(diagnosis, noise_floor(diagnosis, evidence))});
  }
  PageTable rivals = rivals_table(sized);
  if (!rivals.rows.empty()) section.details.emplace_back(std::move(rivals));
  PageTable sets = sets_table(diagnosis);
  if (!sets.rows.empty()) {
    section.blocks.emplace_back(chances_note(diagnosis));
    section.details.emplace_back(std::move(sets));
  }
  return section;
}

}  // namespace

Page diagnosis_page(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence,
                    const std::string& subject) {
  const SizedDiagnosis sized{diagnosis, evidence.sizes};
  PageContent page;
  page.command = "diagnose";
  page.subject = subject;
  page.verdict = with_judged(page_verdict(diagnosis, evidence), diagnosis.sightings);
  const bool slight = is_slight_misfit(diagnosis);
  page.tone = diagnosis.verdict != Diagnosis::Verdict::nothing_missing && !slight ? Tone::bad
              : noise_is_wrong(diagnosis)                                         ? Tone::bad
              : others_notes(diagnosis).empty() && !slight                        ? Tone::good
                                                                                  : Tone::neutral;
  page.answers = answers_of(rows_on(diagnosis, evidence));
  const NamedModel given{kGiven, evidence.given};
  std::vector<NamedModel> models{given};
  if (evidence.with) models.push_back({with_name(evidence), *evidence.with});
  // A place is seen on the map.
  const bool place = std::any_of(
      evidence.effects.begin(), evidence.effects.end(),
      [](const EffectEvidence& one) { return effects::place_of(one.estimate.effect).has_value(); });
  PageSection maps = maps_section("Where legs end off", models, evidence.effects);
  if (place) page.sections.push_back(maps);
  if (!evidence.effects.empty()) page.sections.push_back(cause_section(sized, evidence));
  add_changes(diagnosis, page);
  add_places(diagnosis, page);
  const bool noise_first = evidence.effects.empty() && noise_is_wrong(diagnosis);
  PageSection noise =
      noise_first ? noise_section(given, diagnosis.under->noise) : noise_section(models);
  PageTable sources = noise_table(diagnosis);
  if (!sources.rows.empty()) noise.details.emplace_back(std::move(sources));
  if (noise_first) page.sections.push_back(noise);
  if (!evidence.with && !diagnosis.held_out.legs.empty()) {
    std::get<ChartRow>(maps.blocks.front())
        .push_back(plot::held_out_chart("held-out", {{"", evidence.given.comparison.held_out}}));
  }
  if (!place) page.sections.push_back(std::move(maps));
  if (evidence.with) {
    page.sections.push_back(gain_section(given, models.back(), noise_floor(diagnosis, evidence)));
  }
  if (!noise_first) page.sections.push_back(std::move(noise));
  page.sections.push_back(trend_section("What the errors go with, in the model as given",
                                        evidence.given.comparison, evidence.trends));
  page.sections.push_back(legs_section("Legs, in the model as given", evidence.given.comparison));
  page.sections.push_back({"Part by part", {parts_table(sized)}});
  page.sections.push_back(tried_section(sized));
  close_tables(page);
  return page;
}

}  // namespace trussmap
