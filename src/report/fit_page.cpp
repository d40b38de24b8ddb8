// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/fit_sections.hpp"
#include "report/page_words.hpp"
#include "report/result_rows.hpp"
#include "report/robot_off.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr const char* kBefore = "without effects";
constexpr const char* kAfter = "with effects";

std::string page_verdict(const Comparison& before, const Comparison& after,
                         const std::vector<EffectEvidence>& effects) {
  if (effects.empty()) {
    return after.consistent() ? "The noise is estimated; the model explains the measurements."
                              : "The noise is estimated; something is still unexplained.";
  }
  std::string text = fmt::format("Fitted: {}.", named_with_sizes(effects));
  const std::string gain = gain_sentence(before, after, effects.size() == 1 ? "it" : "them");
  if (!gain.empty()) return text + " " + gain;
  return text + (after.consistent() ? " The model now explains the measurements."
                                    : " Something is still unexplained.");
}

/// How clearly an effect is other than none.
std::string sure_of(const EffectEvidence& one) {
  double most = 0.0;
  for (std::size_t k = 0; k < one.estimate.sd.size(); ++k) {
    const double sd = one.estimate.sd[k];
    if (sd > 0.0) most = std::max(most, std::abs(one.estimate.effect.coefficients.at(k)) / sd);
  }
  return most > 0.0 ? fmt::format("{}: {} standard errors from none{}.",
                                  capitalised(short_name(one.estimate.effect)), two_digits(most),
                                  most < 2.0 ? ", which chance makes as well" : "")
                    : "";
}

std::string still_unexplained(const Comparison& after) {
  return after.consistent()
             ? "Nothing more that chi\u00b2 or a trend shows; fit tries no other effect."
             : fmt::format("Something still: {}.", objection_in_words(after));
}

ResultRows rows_on(const FitEvidence& evidence) {
  const Comparison& after = evidence.with.comparison;
  ResultRows rows;
  rows.missing = {still_unexplained(after)};
  rows.off = off_sentences(evidence.without, evidence.with, kAfter, after.held_out.expected_rms);
  for (const EffectEvidence& one : evidence.effects) {
    rows.large.push_back(how_large(one));
    rows.sure.push_back(sure_of(one));
  }
  if (!evidence.noise.empty()) {
    rows.large.push_back("Noise, as estimated: " + typeset(evidence.noise) + ".");
  }
  rows.otherwise = {"Unknown: fit tries no other effect, diagnose does."};
  for (const EffectEvidence& one : evidence.effects) {
    if (const std::string held = held_in_words(one.estimate.effect); !held.empty()) {
      rows.next.push_back(capitalised(short_name(one.estimate.effect)) + ": " + held + ".");
    }
    for (const UnfittedCoefficient& why : one.estimate.not_fitted) {
      rows.next.push_back(capitalised(in_words(one.estimate, why)) + ".");
    }
  }
  rows.next.emplace_back(
      after.consistent()
          ? "Use the model fitted (trussmap fit --out FILE writes it) with build, compare and the "
            "robot's own odometry."
          : "Give trussmap diagnose the model fitted (trussmap fit --out FILE writes it): it names "
            "what is missing besides.");
  return rows;
}

/// What the fit cannot tell apart well: coefficients whose estimates move together.
std::optional<PageTable> correlation_table(const FitEvidence& evidence) {
  constexpr Eigen::Index kMost = 12;
  const Eigen::Index count = evidence.correlation.rows();
  if (count < 2 || count > kMost) return std::nullopt;
  std::vector<std::string> names;
  for (const EffectEvidence& one : evidence.effects) {
    const Effect& effect = one.estimate.effect;
    for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
      const bool several = effect.coefficients.size() > 1;
      names.push_back(name_in_words(effect) + (several ? fmt::format(", {}", k + 1) : ""));
    }
  }
  if (static_cast<Eigen::Index>(names.size()) != count) return std::nullopt;
  PageTable table;
  table.caption =
      "How the coefficients' errors are correlated: near 1 or \u22121 the recordings tell the two "
      "apart badly";
  table.headings = {""};
  for (Eigen::Index k = 0; k < count; ++k) table.headings.push_back(fmt::format("{}", k + 1));
  for (Eigen::Index k = 0; k < count; ++k) {
    std::vector<std::string> row{fmt::format("{} {}", k + 1, names[static_cast<std::size_t>(k)])};
    for (Eigen::Index j = 0; j < count; ++j) {
      row.push_back(j > k ? "" : typeset(fmt::format("{:.2f}", evidence.correlation(k, j))));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
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
  page.answers = answers_of(rows_on(evidence));
  for (const std::string& line : after.warnings) {
    page.notes.push_back(capitalised(typeset(line)) + ".");
  }
  const NamedModel given{kBefore, evidence.without};
  const NamedModel fitted{kAfter, evidence.with};
  page.sections.push_back(maps_section("The map, before and after", {given, fitted}, effects));
  if (!effects.empty()) {
    page.sections.push_back(effect_section("The effects", effects));
    if (auto table = correlation_table(evidence)) {
      page.sections.back().details.emplace_back(std::move(*table));
    }
  }
  page.sections.push_back(gain_section(given, fitted, after.held_out.expected_rms));
  page.sections.push_back(noise_section({given, fitted}));
  page.sections.push_back(legs_section("Legs, with the effects", after));
  close_tables(page);
  return page;
}

}  // namespace trussmap
