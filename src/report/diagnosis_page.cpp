// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/report/diagnosis_page.hpp"

#include "trussmap/criticism/effect_words.hpp"
#include "trussmap/report/fit_charts.hpp"
#include "trussmap/report/table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "diagnosis_tables.hpp"
#include "fit_sections.hpp"

namespace trussmap {
namespace {

constexpr const char* kGiven = "as given";
constexpr std::size_t kChangesDrawn = 6;

std::string with_name(const DiagnosisPictures& pictures) {
  return pictures.effects.size() == 1
             ? "with " + short_name(pictures.effects.front().estimate.effect)
             : "with what is missing";
}

std::string missing_verdict(const Diagnosis& diagnosis, const DiagnosisPictures& pictures) {
  const auto& effects = pictures.effects;
  const bool matters = diagnosis.findings.front().status == Status::missing;
  std::string text = matters ? "Missing: " : "Missing, but too small to matter: ";
  if (effects.size() == 1) {
    const FittedEffect& only = effects.front();
    text += name_in_words(only.estimate.effect) + " \u2013 " +
            typeset(size_in_words(only.estimate.effect, only.range.least, only.range.most));
  } else {
    std::vector<std::string> names;
    for (const FittedEffect& one : effects) names.push_back(name_in_words(one.estimate.effect));
    text += listed(names);
  }
  const std::string it = effects.size() == 1 ? "it" : "them";
  if (pictures.with) {
    return text + ". " + gain_sentence(pictures.given.comparison, pictures.with->comparison, it);
  }
  if (diagnosis.held_out.legs.empty()) return text + ".";
  const double off = diagnosis.held_out.arrival_rms;
  const double with = diagnosis.findings.front().held_out.arrival_rms;
  return text + fmt::format(". Without {} legs end {} off; with {} {}, as predicted.", it,
                            distance_text(off, with), effects.size() == 1 ? "it" : "the first",
                            distance_text(with, off));
}

std::string verdict_of(const Diagnosis& diagnosis, const DiagnosisPictures& pictures) {
  const std::string off =
      diagnosis.held_out.legs.empty() ? "" : distance_text(diagnosis.held_out.arrival_rms);
  switch (diagnosis.verdict) {
    case Diagnosis::Verdict::missing:
      return missing_verdict(diagnosis, pictures);
    case Diagnosis::Verdict::nothing_missing:
      return fmt::format("Nothing is missing: none of {} changes tried explains more than chance.",
                         diagnosis.tried) +
             (off.empty() ? ""
                          : " Legs end " + off + " off, as good as this robot's noise allows.");
    case Diagnosis::Verdict::unexplained_misfit:
      break;
  }
  std::string text = fmt::format(
      "Something is wrong that no effect explains: errors are {:.1f} times what the model's noise "
      "allows, and none of {} changes tried accounts for them.",
      std::sqrt(diagnosis.chi2 / std::max(1, diagnosis.dof)), diagnosis.tried);
  const std::vector<std::string> others = others_notes(diagnosis);
  return others.empty() ? text : text + " " + others.front();
}

std::vector<PageFact> facts_on(const Diagnosis& diagnosis, const DiagnosisPictures& pictures) {
  std::vector<PageFact> facts;
  for (const FittedEffect& one : pictures.effects) {
    const SizeText size = size_text_of(one);
    facts.push_back({size.size, short_name(one.estimate.effect) + " at its most" +
                                    (size.error.empty() ? "" : "; standard error " + size.error)});
  }
  if (!pictures.effects.empty()) {
    facts.push_back(
        {chance_text(diagnosis.p_value),
         fmt::format("chance of as much without it, {} tests allowed for", diagnosis.tried)});
  }
  if (!diagnosis.held_out.legs.empty()) {
    const Tone tone = pictures.effects.empty() ? Tone::neutral : Tone::bad;
    const double off = diagnosis.held_out.arrival_rms;
    const double less = pictures.with ? pictures.with->comparison.held_out.arrival_rms : off;
    facts.push_back(
        {distance_text(off, less), "legs that no fit has seen end so far off (rms)", tone});
    if (pictures.with) {
      const Comparison& with = pictures.with->comparison;
      facts.push_back({distance_text(less, off), "the same with what is missing",
                       is_explained(with) ? Tone::good : Tone::neutral});
    }
  }
  if (pictures.effects.empty()) {
    facts.push_back({fmt::format("{:.2f}", diagnosis.chi2 / std::max(1, diagnosis.dof)),
                     "chi\u00b2 per degree of freedom (1 is right)"});
    facts.push_back({std::to_string(diagnosis.tried), "changes to the model tried"});
  }
  return facts;
}

/// Advice, "what is lacking: why it matters; what to drive", with the drive first.
std::string advised_drive(const std::string& advice) {
  const std::size_t drive = advice.rfind("; ");
  if (drive == std::string::npos) return "Next drive, to see more: " + advice + ".";
  return fmt::format("Next drive, to see more: {} ({}).", advice.substr(drive + 2),
                     advice.substr(0, drive));
}

std::vector<std::string> notes_on(const Diagnosis& diagnosis, const DiagnosisPictures& pictures) {
  std::vector<std::string> notes;
  if (diagnosis.verdict == Diagnosis::Verdict::missing) {
    if (pictures.effects.size() > 1) {
      for (const FittedEffect& one : pictures.effects) notes.push_back(effect_in_words(one));
    }
    const Finding& first = diagnosis.findings.front();
    notes.push_back(rivals_note(first.candidate.effect, first.look_alikes));
    if (!diagnosis.next_drive.empty()) {
      notes.push_back("Next drive, to tell: " + diagnosis.next_drive + ".");
    }
    for (const FittedEffect& one : pictures.effects) {
      notes.push_back(cause_note(one.estimate.effect));
    }
    notes.emplace_back(
        "Then: put it into the model (trussmap add) and estimate it (trussmap fit), or have "
        "trussmap discover do both, and look for more.");
  } else {
    notes.push_back(seen_from_note(pictures.tables));
    if (!diagnosis.advice.empty()) {
      notes.push_back(advised_drive(diagnosis.advice.front()));
    }
  }
  const std::vector<std::string> others = others_notes(diagnosis);
  const bool said = diagnosis.verdict == Diagnosis::Verdict::unexplained_misfit;
  for (std::size_t k = said ? 1 : 0; k < others.size(); ++k) notes.push_back(others[k]);
  std::erase(notes, "");
  return notes;
}

/// What the best changes of different names would leave of the held-out error.
Chart changes_chart(const Diagnosis& diagnosis) {
  std::vector<LadderStep> steps{
      {kGiven, diagnosis.held_out.arrival_rms, diagnosis.chi2, diagnosis.dof}};
  for (const Finding& one : diagnosis.findings) {
    if (steps.size() > kChangesDrawn) break;
    steps.push_back({"+ " + name_in_words(one.candidate.effect), one.held_out.arrival_rms,
                     diagnosis.chi2 - one.score, diagnosis.dof - one.dof});
  }
  Chart chart = ladder_chart("changes", steps);
  chart.title = "What each change would leave";
  chart.caption =
      "How far off held-out legs would end (root mean square) with each of the best changes alone, "
      "as the diagnosis predicts it before any fit. Shorter is better.";
  return chart;
}

}  // namespace

Page diagnosis_page(const Diagnosis& diagnosis, const DiagnosisPictures& pictures,
                    const std::string& subject) {
  Page page;
  page.command = "diagnose";
  page.subject = subject;
  page.verdict = verdict_of(diagnosis, pictures);
  page.tone = diagnosis.verdict != Diagnosis::Verdict::nothing_missing ? Tone::bad
              : others_notes(diagnosis).empty()                        ? Tone::good
                                                                       : Tone::neutral;
  page.facts = facts_on(diagnosis, pictures);
  page.notes = notes_on(diagnosis, pictures);
  page.sections.push_back({"Part by part", {pictures.tables.parts}});
  const NamedModel given{kGiven, pictures.given};
  if (!pictures.effects.empty()) {
    PageSection missing = effect_section("What is missing", pictures.effects);
    if (!pictures.tables.rivals.rows.empty()) missing.blocks.emplace_back(pictures.tables.rivals);
    page.sections.push_back(std::move(missing));
  }
  if (pictures.with) {
    const NamedModel with{with_name(pictures), *pictures.with};
    PageSection gain = gain_section(given, with);
    if (!diagnosis.held_out.legs.empty())
      gain.blocks.emplace_back(ChartRow{changes_chart(diagnosis)});
    page.sections.push_back(std::move(gain));
    page.sections.push_back(maps_section(given, with));
  } else {
    page.sections.push_back(fit_section(given));
  }
  page.sections.push_back(trend_section("What the errors go with, in the model as given",
                                        pictures.given.comparison, pictures.trends));
  page.sections.push_back(legs_section("Legs, in the model as given", pictures.given.comparison));
  page.sections.push_back(tried_section(diagnosis, pictures.tables));
  return page;
}

}  // namespace trussmap
