// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_record.hpp"
#include "geometry/units.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

namespace trussmap {
using namespace wording;

namespace {

ShownUnit unit_of(const std::string& variable) {
  if (variable == "heading") return {geometry::kDegrees, "\u00b0"};
  if (variable == "turn_rate") return {geometry::kDegrees, "\u00b0/s"};
  if (variable == "speed") return {1.0, "m/s"};
  if (variable == "acceleration") return {1.0, "m/s\u00b2"};
  if (variable == "t") return {1.0, "s"};
  if (variable == "distance" || variable == "x" || variable == "y" || variable == kPlace) {
    return {1.0, "m"};
  }
  return {1.0, ""};
}

}  // namespace

ResponseAxes axes_of(const Response& response) {
  const ShownUnit across = unit_of(response.variable);
  const ShownUnit up = shown_unit(response.unit);
  const std::string name = response.variable == kPlace ? "distance from its place"
                                                       : variable_in_words(response.variable);
  return {across.name.empty() ? name : name + " [" + across.name + "]", across.factor,
          std::string(effects::record_of(response.channel).axis) + " [" + up.name + "]", up.factor};
}

std::string name_in_words(const TrendEvidence& trend) {
  return trend.trend.kind + " against " + variable_in_words(trend.response.variable);
}

}  // namespace trussmap
