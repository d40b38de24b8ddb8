// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/fleet.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string quantity(double value, double sd) {
  const QuantityText text = quantity_text(value, sd);
  return text.error.empty() ? text.value : fmt::format("{} +- {}", text.value, text.error);
}

/// Of one coefficient; each robot in one line at most.
void say(std::vector<std::string>& lines, const FleetCoefficient& one, double level) {
  const auto line = [&](std::string text) {
    lines.push_back(fmt::format("  {}", std::move(text)));
  };
  if (one.common && one.goes_with.empty()) {
    line(fmt::format("common to all {} robots: {} (p {})", one.robots, quantity(one.mean, one.sd),
                     probability_text(one.p_common)));
  }
  for (const FleetKey& key : one.goes_with) {
    std::string others;
    for (const std::string& other : key.same_as) others += fmt::format(", or {}", other);
    line(fmt::format("{} with {}{} (p {})", one.common ? "common to all, but it goes" : "goes",
                     key.key, others, probability_text(key.p_adjusted)));
    for (const FleetGroup& group : key.groups) {
      line(fmt::format("  {} {}: {}{} ({} robots)", key.key, group.value,
                       quantity(group.mean, group.sd),
                       group.p_value < level ? "" : ", which may be none", group.robots));
    }
  }
  if (one.p_tau < level) {
    line(fmt::format("robots scatter by {:.2g} beyond their errors (p {})", one.tau,
                     probability_text(one.p_tau)));
  }
  if (one.all_drift) {
    line(fmt::format("drifts by {} a day in all robots (p {})", quantity(one.slope, one.slope_sd),
                     probability_text(one.p_slope)));
  }
  for (const FleetRobot& robot : one.members) {
    if (!robot.differs && !robot.drifts) continue;
    std::string text = fmt::format("robot {}", robot.robot);
    if (robot.differs) {
      text += fmt::format(" differs: {} (p {})", quantity(robot.value, robot.sd),
                          probability_text(robot.p_differs));
    }
    if (robot.drifts) {
      text += fmt::format("{} drifts by {} a day (p {})", robot.differs ? " and" : "",
                          quantity(robot.slope, robot.slope_sd), probability_text(robot.p_drifts));
    }
    line(text);
  }
}

}  // namespace

std::vector<std::string> in_words(const FleetReport& report) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{} robots, {} days, chi2 {:.1f} ({} dof)", report.robots,
                              report.days, report.chi2, report.dof));
  bool found = false;
  for (const FleetFinding& one : report.findings) {
    found = found || !one.of_model;
    lines.push_back(one.of_model ? fmt::format("{} (in the model)", one.effect)
                                 : fmt::format("{}: missing (p {})", one.effect,
                                               probability_text(one.p_adjusted)));
    for (const FleetCoefficient& each : one.coefficients) {
      if (one.coefficients.size() > 1) lines.push_back(fmt::format("  of {}", each.shape));
      const std::size_t before = lines.size();
      say(lines, each, report.level);
      if (lines.size() == before && one.coefficients.size() == 1) {
        lines.emplace_back(one.of_model
                               ? "  no robot differs from the others, and none drifts"
                               : "  in the fleet as a whole; no group or robot stands out");
      }
    }
    for (const FleetLookAlike& rival : one.look_alikes) {
      lines.push_back(
          fmt::format("  looks the same here: {} (cosine {:.3f})", rival.effect, rival.cosine));
    }
  }
  if (!found) {
    lines.push_back(fmt::format("nothing missing: none of {} candidates", report.tests.size()));
  }
  return lines;
}

}  // namespace trussmap
