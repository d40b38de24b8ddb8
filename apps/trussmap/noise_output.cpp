// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "noise_output.hpp"

#include "trussmap/wording.hpp"

namespace trussmap::app {
namespace {

/// Absent: 0.
nlohmann::ordered_json null_if_absent(double value) {
  return value > 0.0 ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

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
    source["sd_error"] = null_if_absent(one.sd_error);
    source["at_limit"] = one.at_limit;
    if (one.process.length > 0.0) {
      source["length"] = one.process.length;
      source["length_error"] = null_if_absent(one.length_error);
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
