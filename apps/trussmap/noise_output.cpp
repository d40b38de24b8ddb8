// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "noise_output.hpp"

#include "terminal.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

std::string size_text(double size, double error) {
  if (error == 0.0) return fmt::format("{:.3g}", size);
  constexpr double kUnknown = 0.7;  // of the size
  if (error > kUnknown * size) return fmt::format("about {:.1g}", size);
  const QuantityText text = quantity_text(size, error);
  return text.error.empty() ? text.value : text.value + " +- " + text.error;
}

/// Absent: 0.
nlohmann::ordered_json number_or_null(double value) {
  return value > 0.0 ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

void print_noise(const FittedNoise& noise) {
  if (!noise.changed()) {
    fmt::print("Noise is as the model states it.\n");
    return;
  }
  fmt::print("Noise, estimated\n");
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
  fmt::print("{}", table_text(table));
  if (std::any_of(noise.sources.begin(), noise.sources.end(),
                  [](const NoiseSource& one) { return one.at_limit; })) {
    fmt::print("  * as far as sizes and lengths are sought: it may lie beyond\n");
  }
}

void print_budget(const std::vector<NoiseBudget>& budget) {
  if (budget.empty() || budget.back().shares.size() < 2) return;
  fmt::print("\nWhat dead reckoning by the wheels alone owes to each source of noise\n");
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
  fmt::print("{}  {}\n", table_text(table), in_words(budget.back()));
}

nlohmann::ordered_json budget_json(const std::vector<NoiseBudget>& budget) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const NoiseBudget& one : budget) {
    nlohmann::ordered_json shares = nlohmann::ordered_json::array();
    for (const NoiseShare& share : one.shares) {
      shares.push_back({{"source", share.source}, {"share", share.share}});
    }
    list.push_back({{"horizon_s", one.horizon},
                    {"rms_m", one.rms},
                    {"windows", one.windows},
                    {"shares", shares},
                    {"in_words", in_words(one)}});
  }
  return list;
}

nlohmann::ordered_json noise_json(const FittedNoise& noise) {
  nlohmann::ordered_json sources = nlohmann::ordered_json::array();
  for (const NoiseSource& one : noise.sources) {
    nlohmann::ordered_json source{{"source", one.name}, {"unit", one.unit}};
    if (one.lasts) {
      source["channel"] = name_of(one.process.channel);
      source["process"] = name_of(one.process.process);
    }
    source["stated"] = one.stated;
    source["sd"] = one.sd;
    source["sd_error"] = number_or_null(one.sd_error);
    source["at_limit"] = one.at_limit;
    if (one.process.length > 0.0) {
      source["length"] = one.process.length;
      source["length_error"] = number_or_null(one.length_error);
    }
    source["gain"] = one.gain;
    if (one.lasts) source["p_adjusted"] = one.p_value;
    sources.push_back(source);
  }
  return {{"changed", noise.changed()},
          {"gain", noise.gain},
          {"tried", noise.tried},
          {"sources", sources}};
}

}  // namespace trussmap::app
