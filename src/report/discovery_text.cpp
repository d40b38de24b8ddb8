// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/changing_effects.hpp"
#include "report/places_found.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <fmt/format.h>

namespace trussmap {
namespace {

/// Why degrees of freedom rise from line to line, or fall by more than the coefficients.
std::string come_and_gone_text(const Discovery& result) {
  std::string text;
  for (std::size_t k = 1; k < result.steps.size(); ++k) {
    const DiscoveryStep& step = result.steps[k];
    const std::size_t before = result.steps[k - 1].left_out;
    if (step.left_out == before || !step.added) continue;
    const bool back = step.left_out < before;
    const std::size_t count = back ? before - step.left_out : step.left_out - before;
    text += fmt::format("  with {} {} measurement{} that contradicted all others {}\n",
                        step.added->name, count, count == 1 ? "" : "s", back ? "come back" : "go");
  }
  return text;
}

/// `noise_found`: the model found has other noise than the one given.
std::string steps_text(const Discovery& result, bool noise_found, TextStyle style) {
  std::string text;
  const bool reckoned = result.steps.front().reckoned_30.has_value();
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::right,
                   Align::right, Align::right},
                  {},
                  true,
                  2};
  table.rows.push_back({"model", "chi2", "dof", "predicted", "held out [mm]", "predicted", "legs"});
  if (reckoned) {
    table.columns.insert(table.columns.end(), {Align::right, Align::right});
    table.rows.back().insert(table.rows.back().end(), {"10 s [mm]", "30 s [mm]"});
  }
  for (const DiscoveryStep& step : result.steps) {
    std::string name = step.added ? "+ " + step.added->name : "as given";
    for (const Effect& other : step.together) name += ", + " + other.name;
    for (const std::string& dropped : step.dropped) name += ", - " + dropped;
    const double before =
        &step == &result.steps.front() ? step.chi2 : (&step - 1)->chi2 - step.predicted_decrease;
    table.rows.push_back(
        {name, fmt::format("{:.1f}", step.chi2), fmt::format("{}", step.dof),
         step.added ? fmt::format("{:.1f}", before) : "-",
         step.held_out.legs.empty() ? "-" : fmt::format("{:.1f}", 1e3 * step.held_out.arrival_rms),
         step.added && !step.held_out.legs.empty()
             ? fmt::format("{:.1f}", 1e3 * step.predicted.arrival_rms)
             : "-",
         fmt::format("{}", step.held_out.legs.size())});
    if (!reckoned) continue;
    for (const std::optional<double>& error : {step.reckoned_10, step.reckoned_30}) {
      table.rows.back().push_back(error ? fmt::format("{:.0f}", 1e3 * *error) : "-");
    }
  }
  text += fmt::format("\n{}{}", table_text(table, style), come_and_gone_text(result));
  const Diagnosis& last = result.last;
  const bool anew = noise_found || (last.under && last.under->noise.changed());
  if (result.steps.size() > 1 && anew) {
    text += "  the noise is estimated anew in every line: chi2 is no measure across them\n";
  }
  if (reckoned) {
    text += "  10 s, 30 s: dead reckoning over so long, against the fit's own path (rms)\n";
  }
  return text;
}

}  // namespace

std::string discovery_text(const Discovery& result, const Noise& given,
                           const std::vector<NoiseBudget>& budget, TextStyle style) {
  const bool noise_found = !(result.found.model.noise == given);
  std::string text;
  text += fmt::format("{}\n", verdict_text(result.consistent ? Mood::good : Mood::bad,
                                           verdict_in_words(result), style));
  for (const std::string& line : effects_in_words(result.found)) {
    text += fmt::format("  {}\n", line);
  }
  text += steps_text(result, noise_found, style);
  for (const DiscoveryStep& step : result.steps) {
    constexpr std::size_t kMost = 3;
    std::size_t rivals = 0;
    for (const LookAlike& rival : step.look_alikes) {
      if (rival.told_apart() || ++rivals > kMost) continue;
      text += fmt::format("  instead of {} it could be: {} ({}), cosine {:.3f}{}\n",
                          step.added->name, rival.effect.name, formula_of(rival.effect),
                          rival.cosine, behind_in_words(rival));
    }
    if (rivals > kMost) {
      text +=
          fmt::format("  instead of {} it could be: {} more\n", step.added->name, rivals - kMost);
    }
  }
  text += report::changing_text(result.last) + report::places_text(result.last);
  for (const std::string& warning : result.found.warnings) {
    text += warning_text(warning, style);
  }
  if (!result.last.under) return text + budget_text(budget, style);
  text += "\n";
  if (noise_found && !result.last.under->noise.changed()) {
    text += "Noise is estimated, in an earlier step, and not as stated: the model found has it\n";
  } else {
    text += noise_text(result.last.under->noise, style);
  }
  return text + budget_text(budget, style);
}

}  // namespace trussmap
