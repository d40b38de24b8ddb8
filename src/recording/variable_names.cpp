// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "recording/variable_names.hpp"

#include <algorithm>
#include <array>

namespace trussmap::recording {
namespace {

constexpr std::array<std::string_view, 4> kRates{"speed", "turn_rate", "acceleration", "curvature"};
constexpr std::array<std::string_view, 4> kEvents{"starts", "spins", "reverses_left",
                                                  "reverses_right"};

}  // namespace

const std::vector<std::string>& reserved_variables() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all(kRates.begin(), kRates.end());
    all.insert(all.end(),
               {"arc_angle", "spin_angle", "heading", "x", "y", "t", "distance", "session"});
    all.insert(all.end(), kEvents.begin(), kEvents.end());
    return all;
  }();
  return names;
}

std::string_view unit_of_variable(std::string_view variable) {
  if (variable == "speed") return "m/s";
  if (variable == "acceleration") return "m/s\u00b2";
  if (variable == "turn_rate") return "rad/s";
  if (variable == "curvature") return "1/m";
  if (variable == "t") return "s";
  if (variable == "x" || variable == "y" || variable == "distance") return "m";
  if (variable == "heading" || variable == "arc_angle" || variable == "spin_angle") return "rad";
  return "";
}

bool is_event(std::string_view variable) {
  return std::find(kEvents.begin(), kEvents.end(), variable) != kEvents.end();
}

bool is_rate(std::string_view variable) {
  return std::find(kRates.begin(), kRates.end(), variable) != kRates.end();
}

}  // namespace trussmap::recording
