// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"
#include "report/diagnosis_tables.hpp"
#include "report/fit_sections.hpp"
#include "report/page_words.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr const char* kGiven = "as given";
constexpr std::size_t kChangesDrawn = 6;

std::string with_name(const DiagnosisEvidence& evidence) {
  return evidence.effects.size() == 1
             ? "with " + short_name(evidence.effects.front().estimate.effect)
             : "with what is missing";
}

std::string missing_verdict(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  const auto& effects = evidence.effects;
  const bool matters = diagnosis.findings.front().status == Status::missing;
  std::string text = matters ? "Missing: " : "Missing, but too small to matter: ";
  text += named_with_sizes(effects);
  const std::string it = effects.size() == 1 ? "it" : "them";
  if (evidence.with) {
    return text + ". " + gain_sentence(evidence.given.comparison, evidence.with->comparison, it);
  }
  if (diagnosis.held_out.legs.empty()) return text + ".";
  const double off = diagnosis.held_out.arrival_rms;
  const double with = diagnosis.findings.front().held_out.arrival_rms;
  return text + fmt::format(". Without {} legs end {} off; with {} {}, as predicted.", it,
                            distance_text(off, with), effects.size() == 1 ? "it" : "the first",
                            distance_text(with, off));
}

std::string page_verdict(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  const std::string off =
      diagnosis.held_out.legs.empty() ? "" : distance_text(diagnosis.held_out.arrival_rms);
  switch (diagnosis.verdict) {
    case Diagnosis::Verdict::missing:
      return missing_verdict(diagnosis, evidence);
    case Diagnosis::Verdict::nothing_missing:
      return fmt::format("Nothing is missing: none of {} changes tried explains more than chance.",
                         diagnosis.tried) +
             (off.empty() ? ""
                          : " Legs end " + off + " off, as good as this robot's noise allows.") +
             (diagnosis.under && diagnosis.under->noise.changed()
                  ? " But the noise is not as the model states it: " +
                        typeset(in_words(diagnosis.under->noise)) + "."
                  : "");
    case Diagnosis::Verdict::unexplained_misfit:
      break;
  }
  const std::string text = "Something is wrong that no effect explains: " +
                           objection_in_words(evidence.given.comparison) + ".";
  const std::vector<std::string> others = others_notes(diagnosis);
  return others.empty() ? text : text + " " + others.front();
}

std::vector<PageFact> facts_on(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  std::vector<PageFact> facts;
  for (const EffectEvidence& one : evidence.effects) {
    const SizeText size = size_text_of(one);
    facts.push_back({size.size, short_name(one.estimate.effect) + " at its most" +
                                    (size.error.empty() ? "" : "; standard error " + size.error)});
  }
  if (!evidence.effects.empty()) {
    facts.push_back({chance_text(diagnosis.p_value),
                     fmt::format("p-value, adjusted for {} tests", diagnosis.tried)});
  }
  if (!diagnosis.held_out.legs.empty()) {
    const Tone tone = evidence.effects.empty() ? Tone::neutral : Tone::bad;
    const double off = diagnosis.held_out.arrival_rms;
    const double less = evidence.with ? evidence.with->comparison.held_out.arrival_rms : off;
    facts.push_back({distance_text(off, less), kLegsEnd, tone});
    if (evidence.with) {
      const Comparison& with = evidence.with->comparison;
      facts.push_back({distance_text(less, off), "the same with what is missing",
                       with.consistent() ? Tone::good : Tone::neutral});
    }
  }
  if (evidence.effects.empty()) {
    facts.push_back({fmt::format("{:.2f}", diagnosis.chi2 / std::max(1, diagnosis.dof)),
                     "chi\u00b2 per degree of freedom (1 is right)"});
    facts.push_back({std::to_string(diagnosis.tried), "changes to the model tried"});
  }
  return facts;
}

/// Sources that are clearly noisier than stated, and what to do about it.
std::string noise_advice(const Comparison& comparison) {
  constexpr double kClear = 3.0;  // standard errors
  std::vector<std::string> noisy;
  for (const SourceCalibration& one : comparison.sources) {
    if (one.factor - 1.0 > kClear * one.sd) {
      noisy.push_back(fmt::format("{} {} times", one.source, two_digits(one.factor)));
    }
  }
  if (noisy.empty()) return "";
  return fmt::format(
      "Check the noise in the model. Errors beside what it states: {}. Correct it, and diagnose "
      "again.",
      listed(noisy));
}

std::vector<PageAnswer> answers_on(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  std::vector<PageAnswer> answers;
  if (diagnosis.verdict == Diagnosis::Verdict::missing) {
    for (const EffectEvidence& one : evidence.effects) {
      answers.push_back({kHowLarge, sized_in_words(one)});
    }
    answers.push_back({kHowSure, sure_text(diagnosis.p_value, diagnosis.tried)});
    const Finding& first = diagnosis.findings.front();
    answers.push_back({kWhatElse, rivals_note(first.effect, first.look_alikes)});
    if (diagnosis.next_drive) {
      answers.push_back({kNext, "To tell them apart, " + in_words(diagnosis.next_drive) + "."});
    }
    answers.push_back(
        {kNext,
         "Put it into the model (trussmap add) and estimate it (trussmap fit), or have trussmap "
         "discover do both, and look for more."});
    for (const EffectEvidence& one : evidence.effects) {
      answers.push_back({kCause, cause_note(one.estimate.effect)});
    }
  } else {
    if (diagnosis.verdict == Diagnosis::Verdict::unexplained_misfit) {
      answers.push_back({kNext, noise_advice(evidence.given.comparison)});
    }
    if (!diagnosis.lacks.empty()) {
      answers.push_back({kNext, advised_drive(advice_on(diagnosis.lacks.front()))});
    }
    answers.push_back({kSeen, seen_from_note({diagnosis, evidence.sizes})});
  }
  const std::vector<std::string> others = others_notes(diagnosis);
  const bool said = diagnosis.verdict == Diagnosis::Verdict::unexplained_misfit;
  for (std::size_t k = said ? 1 : 0; k < others.size(); ++k)
    answers.push_back({kBeside, others[k]});
  std::erase_if(answers, [](const PageAnswer& one) { return one.answer.empty(); });
  return answers;
}

/// What the best changes of different names would leave of the held-out error.
Chart changes_chart(const Diagnosis& diagnosis) {
  std::vector<LadderStep> steps{
      {kGiven, diagnosis.held_out.arrival_rms, diagnosis.chi2, diagnosis.dof}};
  for (const Finding& one : diagnosis.findings) {
    if (steps.size() > kChangesDrawn) break;
    steps.push_back({"+ " + name_in_words(one.effect), one.held_out.arrival_rms,
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

Page diagnosis_page(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence,
                    const std::string& subject) {
  const SizedDiagnosis sized{diagnosis, evidence.sizes};
  PageContent page;
  page.command = "diagnose";
  page.subject = subject;
  page.verdict = page_verdict(diagnosis, evidence);
  page.tone = diagnosis.verdict != Diagnosis::Verdict::nothing_missing ? Tone::bad
              : others_notes(diagnosis).empty()                        ? Tone::good
                                                                       : Tone::neutral;
  page.facts = facts_on(diagnosis, evidence);
  page.answers = answers_on(diagnosis, evidence);
  page.sections.push_back({"Part by part", {parts_table(sized)}});
  PageTable noise = noise_table(diagnosis);
  if (!noise.rows.empty()) page.sections.back().blocks.emplace_back(std::move(noise));
  const NamedModel given{kGiven, evidence.given};
  if (!evidence.effects.empty()) {
    page.sections.push_back(effect_section("What is missing", evidence.effects));
    PageTable rivals = rivals_table(sized);
    if (!rivals.rows.empty()) {
      page.sections.push_back({"What else it could be", {std::move(rivals)}});
    }
  }
  if (evidence.with) {
    const NamedModel with{with_name(evidence), *evidence.with};
    PageSection gain = gain_section(given, with);
    if (!diagnosis.held_out.legs.empty())
      gain.blocks.emplace_back(ChartRow{changes_chart(diagnosis)});
    page.sections.push_back(std::move(gain));
    page.sections.push_back(maps_section("The map, before and after", {given, with}));
  } else {
    page.sections.push_back(fit_section(given));
  }
  page.sections.push_back(trend_section("What the errors go with, in the model as given",
                                        evidence.given.comparison, evidence.trends));
  page.sections.push_back(legs_section("Legs, in the model as given", evidence.given.comparison));
  page.sections.push_back(tried_section(sized));
  move_tables_last(page);
  return page;
}

}  // namespace trussmap
