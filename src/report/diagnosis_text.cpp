// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/changing_effects.hpp"
#include "report/places_found.hpp"
#include "report/sets_of_effects.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"
#include "trussmap/workbench.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// In the unit that suits the larger of it and what stands beside it.
std::string length(double metres, double beside) {
  return std::max(metres, beside) < 1.0 ? fmt::format("{:.1f} mm", 1e3 * metres)
                                        : fmt::format("{:.3f} m", metres);
}

/// Those that are not told apart, then those that are; of either three.
std::string look_alikes_text(const std::vector<LookAlike>& all) {
  constexpr std::size_t kMost = 3;
  constexpr std::size_t kLongestFormula = 60;  // characters; --json has all of it
  std::string same, apart;
  std::size_t sames = 0, aparts = 0;
  for (const LookAlike& rival : all) {
    const std::string alike =
        fmt::format("{} ({}), cosine {:.3f}", rival.effect.name,
                    shortened(formula_of(rival.effect), kLongestFormula), rival.cosine);
    if (rival.told_apart()) {
      if (++aparts > kMost) continue;
      apart += fmt::format(
          "  looks much like it: {}; all measurements tell it apart (chi^2 {:.0f} behind)\n", alike,
          rival.behind);
    } else {
      if (++sames > kMost) continue;
      same += fmt::format("  looks the same here: {}{}\n", alike, behind_in_words(rival));
    }
  }
  if (sames > kMost) same += fmt::format("  looks the same here: {} more\n", sames - kMost);
  if (aparts > kMost) {
    apart += fmt::format("  looks much like it: {} more, which all measurements tell apart\n",
                         aparts - kMost);
  }
  return same + apart;
}

/// Where all sets of effects are weighed and most that is likely does without it.
std::string weakness_text(const Finding& one, const Explanations& explanations) {
  constexpr double kWeak = 0.5;
  if (explanations.sets.empty() || one.joint.empty()) return "";
  double chance = 0.0;
  for (const EffectChance& other : explanations.effects) {
    const bool is_it = other.effect.name == one.effect.name ||
                       std::ranges::count(other.otherwise, one.effect.name) > 0;
    if (is_it) chance = std::max(chance, other.probability);
  }
  if (chance >= kWeak) return "";
  return fmt::format(
      "  weak evidence: more than chance, but other sets of effects do as well (its probability: "
      "{:.2f})\n",
      chance);
}

std::string missing_text(const Diagnosis& result, TextStyle style) {
  std::string text;
  if (result.verdict != Diagnosis::Verdict::missing) {
    const bool good = result.verdict == Diagnosis::Verdict::nothing_missing;
    text += fmt::format(
        "{}\n", verdict_text(good ? Mood::good : Mood::bad, verdict_in_words(result), style));
  }
  for (const Finding* found : found_by(result)) {
    const Finding& one = *found;
    const Mood mood = one.status == Status::missing ? Mood::bad : Mood::doubt;
    text += fmt::format("{}\n", verdict_text(mood, in_words(one), style));
    const Explanation explained = explanation_of(one.effect);
    if (explained.unusual) text += fmt::format("  not its usual sign: {}\n", explained.does);
    text += look_alikes_text(one.look_alikes);
    text += weakness_text(one, result.explanations);
  }
  if (const std::string by = in_words(result.sightings);
      result.verdict == Diagnosis::Verdict::missing && !by.empty()) {
    text += fmt::format("  {}\n", by);
  }
  if (!result.missing.empty() && !result.held_out.legs.empty()) {
    const bool several = result.findings.size() > 1 && !result.findings[1].joint.empty();
    const char* what = several ? "them" : "it";
    const double without = result.held_out.arrival_rms;
    const double with = result.with_missing.arrival_rms;
    text += fmt::format(
        "  without {} legs end {} off, with {} {} (rms of {} held-out legs, predicted)\n", what,
        length(without, with), what, length(with, without), result.held_out.legs.size());
    constexpr double kWorse = 1.1;
    if (with > kWorse * without) {
      text += fmt::format(
          "  so these legs are predicted worse with {}: they are few, or {} not the whole cause\n",
          what, several ? "these are" : "it is");
    }
  }
  if (result.next_drive)
    text += fmt::format("  to tell them apart: {}\n", in_words(result.next_drive));
  return text;
}

/// Noise laws and single events that are significant.
std::string others_text(const Diagnosis& result, std::size_t count) {
  std::string text;
  std::size_t shown = 0;
  const bool estimated = result.under && result.under->noise.changed();  // shown by itself
  for (const NoiseTest& one : estimated ? std::vector<NoiseTest>() : result.noise) {
    if (one.p_adjusted >= result.level || shown >= 2) continue;
    if (shown++ == 0) text += "\nMore noise than the model states\n";
    text += fmt::format("  {}: {} (score {:.1f}, p {})\n", one.law, in_words(one), one.score,
                        probability_text(one.p_adjusted));
  }
  shown = 0;
  for (const EventTest& one : result.events) {
    if (one.p_adjusted >= result.level || shown >= count) continue;
    if (shown++ == 0) text += "\nSingle events\n";
    text += fmt::format("  {}: {} (score {:.1f}, p {})\n", name_of(one.kind), in_words(one),
                        one.score, probability_text(one.p_adjusted));
  }
  return text;
}

std::string candidates_text(const Diagnosis& result, std::size_t count, TextStyle style) {
  std::string text;
  constexpr std::size_t kWidestCell = 36;  // characters; --json has all of it
  TextTable table{{Align::left, Align::left, Align::right, Align::right, Align::right, Align::left},
                  {},
                  true,
                  2};
  table.rows.push_back({"best candidates", "channel x shape", "chi2 less (dof)", "p, adjusted",
                        "held out [mm]", "status"});
  for (std::size_t k = 0; k < std::min(count, result.findings.size()); ++k) {
    const Finding& one = result.findings[k];
    // By itself it may not show: the table's figures are of each alone.
    const bool beside = k > 0 && one.status == Status::missing && one.p_adjusted >= result.level;
    table.rows.push_back(
        {shortened(one.effect.name, kWidestCell), shortened(formula_of(one.effect), kWidestCell),
         fmt::format("{:.1f} ({})", one.score, one.dof),
         beside ? "with the above" : probability_text(one.p_adjusted),
         result.held_out.legs.empty() ? "-" : fmt::format("{:.1f}", 1e3 * one.held_out.arrival_rms),
         std::string(status_in_words(one))});
  }
  text +=
      fmt::format("\n{}; {} tests\n{}", fit_in_words(result.chi2, result.dof, result.coefficients),
                  result.tried, table_text(table, style));
  return text;
}

}  // namespace

std::string diagnosis_text(const Diagnosis& result, const std::vector<NoiseBudget>& budget,
                           std::size_t list, TextStyle style) {
  std::string text = missing_text(result, style) + report::changing_text(result) +
                     report::places_text(result) + report::sets_text(result) +
                     candidates_text(result, list, style) + others_text(result, list);
  if (!result.unobservable.empty()) text += "\nNot to be seen in these data\n";
  for (const Unobservable& one : result.unobservable) {
    const Advice advice = advice_on(one);
    text += fmt::format("  {}: {}; {}\n", one.effect.name, advice.why, advice.drive);
  }
  if (!result.lacks.empty()) text += "\nWhat these data lack\n";
  for (const std::string& line : in_words(result.lacks)) text += fmt::format("  {}\n", line);
  for (const std::string& warning : result.warnings) text += warning_text(warning, style);
  if (result.under) {
    const FittedNoise& noise = result.under->noise;
    text += noise.changed() || result.missing.empty()
                ? "\n" + noise_text(noise, style)
                : "\nBeside what is missing, noise is as the model states it.\n";
  }
  return text + budget_text(budget, style);
}

}  // namespace trussmap
