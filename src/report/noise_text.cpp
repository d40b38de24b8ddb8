// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string size_text(double size, double error) {
  if (error == 0.0) return fmt::format("{:.3g}", size);
  constexpr double kUnknown = 0.7;  // of the size
  if (error > kUnknown * size) return fmt::format("about {:.1g}", size);
  const QuantityText text = quantity_text(size, error);
  return text.error.empty() ? text.value : text.value + " +- " + text.error;
}

}  // namespace

std::string noise_text(const FittedNoise& noise, TextStyle style) {
  std::string text;
  if (!noise.changed()) {
    text += "Noise is as the model states it.\n";
    return text;
  }
  text += "Noise, estimated\n";
  TextTable table{
      {Align::left, Align::right, Align::right, Align::left, Align::right}, {}, true, 2};
  table.rows.push_back({"noise of", "stated", "found", "unit", "lasts for"});
  for (const NoiseSource& one : noise.sources) {
    const bool as_stated = !one.lasts && one.sd == one.stated;
    const char* unit = one.process.process == ProcessKind::correlated_in_t ? " s" : " m";
    table.rows.push_back(
        {one.name, one.stated > 0.0 ? fmt::format("{:.4g}", one.stated) : "-",
         as_stated ? "as stated" : size_text(one.sd, one.sd_error) + (one.at_limit ? " *" : ""),
         one.unit,
         one.process.length > 0.0 ? size_text(one.process.length, one.length_error) + unit : ""});
  }
  text += table_text(table, style);
  if (std::any_of(noise.sources.begin(), noise.sources.end(),
                  [](const NoiseSource& one) { return one.at_limit; })) {
    text += "  * as far as sizes and lengths are sought: it may lie beyond\n";
  }
  return text;
}

std::string budget_text(const std::vector<NoiseBudget>& budget, TextStyle style) {
  std::string text;
  if (budget.empty() || budget.back().shares.size() < 2) return text;
  text += "\nWhat dead reckoning by the wheels alone owes to each source of noise\n";
  TextTable table{{Align::left}, {}, true, 2};
  table.rows.push_back({"noise of"});
  for (const NoiseBudget& one : budget) {
    table.columns.push_back(Align::right);
    table.rows.back().push_back(one.horizon == 0.0 ? "a leg" : fmt::format("{:g} s", one.horizon));
  }
  for (const NoiseShare& share : budget.back().shares) {
    table.rows.push_back({share.source});
    for (const NoiseBudget& one : budget) {
      double there = 0.0;
      for (const NoiseShare& other : one.shares) {
        if (other.source == share.source) there = other.share;
      }
      table.rows.back().push_back(fmt::format("{:.0f} %", 100.0 * there));
    }
  }
  table.rows.push_back({"error expected [mm, rms]"});
  for (const NoiseBudget& one : budget) {
    table.rows.back().push_back(fmt::format("{:.0f}", 1e3 * one.rms));
  }
  text += fmt::format("{}  {}\n", table_text(table, style), in_words(budget.back()));
  return text;
}

}  // namespace trussmap
