// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/number_text.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string tenths(double value) {
  return text::without_sign_of_nothing(text::fixed_text(value, 1));
}

std::string estimates_text(const EffectGain& result, TextStyle style) {
  std::string text;
  for (const EffectEstimate& one : result.with.effects) {
    const bool none = std::all_of(one.effect.coefficients.begin(), one.effect.coefficients.end(),
                                  [](double a) { return a == 0.0; });
    const bool unseen = none && !one.not_fitted.empty();
    text += fmt::format(
        "{}\n", verdict_text(unseen ? Mood::doubt : Mood::good,
                             fmt::format("{}: {}", one.effect.name,
                                         unseen ? "not fitted" : in_words(one.effect, one.sd)),
                             style));
    TextTable table{{Align::left, Align::right, Align::right}, {}, false, 4};
    for (std::size_t k = 0; k < one.effect.coefficients.size(); ++k) {
      const QuantityText size = quantity_text(one.effect.coefficients[k], one.sd[k]);
      const Shape& shape = one.effect.shape[k % one.effect.shape.size()];
      table.rows.push_back({fmt::format("{} x {}", name_of(one.effect.channel), shape.text()),
                            size.value, size.error.empty() ? "" : "+- " + size.error});
    }
    text += table_text(table, style);
    if (const std::string held = held_in_words(one.effect); !held.empty()) {
      text += fmt::format("    {}\n", held);
    }
    for (const UnfittedCoefficient& why : one.not_fitted) {
      text += fmt::format("    {}\n", in_words(one, why));
    }
  }
  return text;
}

}  // namespace

std::string fit_text(const EffectGain& result, const std::optional<FittedNoise>& noise,
                     TextStyle style) {
  std::string text = estimates_text(result, style);
  const std::optional<OneWheel> wheel = robot_constants(result.with.model, result.with).one_wheel;
  if (wheel) text += "one wheel: " + in_words(*wheel) + "\n";
  if (result.with.model.effects.empty()) {
    text += fmt::format("under the noise found: {}, p {}\n\n",
                        fit_in_words(result.with.chi2, result.with.dof, result.with.coefficients),
                        probability_text(result.with.p_value));
    for (const std::string& warning : result.with.warnings) text += warning_text(warning, style);
    return noise ? text + noise_text(*noise, style) : text;
  }
  const ModelFit& before = result.without;
  const ModelFit& after = result.with;
  TextTable table{
      {Align::left, Align::right, Align::right, Align::right, Align::right}, {}, true, 2};
  table.rows.push_back({"", "chi2", "dof", "p", "held out [mm]"});
  const auto row = [&table](const char* name, const ModelFit& fit, const HeldOut& held) {
    table.rows.push_back({name, fmt::format("{:.1f}", fit.chi2), fmt::format("{}", fit.dof),
                          probability_text(fit.p_value),
                          held.legs.empty() ? "-" : fmt::format("{:.1f}", 1e3 * held.arrival_rms)});
  };
  row("without effects", before, result.held_out_without);
  row("with them", after, result.held_out_with);
  text += fmt::format("\n{}", table_text(table, style));
  text += fmt::format("  chi2 was predicted to fall by {}, and fell by {}\n",
                      tenths(result.predicted_decrease), tenths(before.chi2 - after.chi2));
  text += fmt::format("  {}\n", in_words(result.held_out_with));
  for (const std::string& warning : after.warnings) text += warning_text(warning, style);
  return noise ? text + "\n" + noise_text(*noise, style) : text;
}

}  // namespace trussmap
