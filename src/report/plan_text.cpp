// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap {
namespace {

constexpr std::size_t kMostPairs = 12;    // listed
constexpr std::size_t kMostEffects = 12;  // likewise, the worst
constexpr double kWorth = 1.3;  // factor of lambda that an instrument is worth its name for
constexpr double kWorthless = 1.05;

std::string minutes(double seconds) {
  return seconds < 100.0 ? fmt::format("{:.0f} s", seconds)
                         : fmt::format("{:.1f} min", seconds / 60.0);
}

std::string lambda_text(double lambda) {
  return lambda < 0.05 ? "0" : fmt::format("{:.1f}", lambda);
}

std::size_t count_beyond(const PlannedDrive& drive) {
  const auto is_beyond = [](const auto& one) { return one.beyond; };
  return static_cast<std::size_t>(
      std::count_if(drive.pairs.begin(), drive.pairs.end(), is_beyond) +
      std::count_if(drive.effects.begin(), drive.effects.end(), is_beyond));
}

std::string plan_verdict(const PlannedDrive& drive, TextStyle style) {
  const bool rivals = !drive.pairs.empty();
  const std::size_t beyond = count_beyond(drive);
  const std::size_t all = drive.pairs.size() + drive.effects.size();
  if (drive.plan.waypoints.empty() && drive.enough && beyond == 0) {
    return verdict_text(Mood::good,
                        "no drive needed: the recordings tell these rivals apart by the wished "
                        "power",
                        style) +
           "\n";
  }
  if (drive.plan.waypoints.empty()) {
    const char* what = drive.enough   ? "what drives on these routes can tell is told already"
                       : beyond < all ? "none within the limits tells anything"
                       : rivals       ? "no drive on these routes tells these rivals apart"
                                      : "no drive on these routes shows any of these effects";
    return verdict_text(Mood::bad, fmt::format("no drive: {}", what), style) + "\n";
  }
  const std::string size = fmt::format("{:.1f} m in {}", drive.length, minutes(drive.duration));
  const std::string what = rivals ? "decides between rivals" : "shows every effect";
  if (drive.enough && beyond == 0) {
    return verdict_text(Mood::good,
                        fmt::format("drive: {} {}, power {:.2f} at least", size, what, drive.power),
                        style) +
           "\n";
  }
  std::string text =
      drive.enough
          ? fmt::format("part: {} {} as far as drives do, power {:.2f}", size, what, drive.power)
          : fmt::format(
                "short: {} is the best within the limits, power {:.2f} where {:.2f} is "
                "wished",
                size, drive.power, drive.options.power);
  if (beyond > 0) {
    text += fmt::format("; {} of {} {} beyond any drive here", beyond, all,
                        rivals ? "pairs of rivals are" : "effects are");
  }
  return verdict_text(Mood::doubt, text, style) + "\n";
}

std::string pairs_part(const PlannedDrive& drive, TextStyle style) {
  TextTable table{
      {Align::left, Align::left, Align::right, Align::right, Align::right, Align::right},
      {{"if it is", "and not", "lambda", "with it", "power", "with it"}},
      true,
      2};
  std::vector<PlannedPair> pairs = drive.pairs;
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const PlannedPair& a, const PlannedPair& b) { return a.power < b.power; });
  for (const PlannedPair& one : pairs) {
    if (table.rows.size() > kMostPairs) break;
    table.rows.push_back({one.truth.name, one.rival.name, lambda_text(one.before),
                          lambda_text(one.after), fmt::format("{:.2f}", one.power_before),
                          one.beyond ? "beyond" : fmt::format("{:.2f}", one.power)});
  }
  std::string text = "\n" + table_text(table, style);
  if (pairs.size() > kMostPairs) {
    text += fmt::format("  and {} pairs more, told better\n", pairs.size() - kMostPairs);
  }
  return text;
}

std::string effects_part(const PlannedDrive& drive, TextStyle style) {
  TextTable table{{Align::left, Align::left, Align::right, Align::right, Align::right},
                  {{"effect", "channel", "practical |g|", "lambda", "power"}},
                  true,
                  2};
  std::vector<PlannedEffect> effects = drive.effects;
  std::stable_sort(
      effects.begin(), effects.end(),
      [](const PlannedEffect& a, const PlannedEffect& b) { return a.power < b.power; });
  for (const PlannedEffect& one : effects) {
    if (table.rows.size() > kMostEffects) break;
    table.rows.push_back({one.effect.name, std::string(name_of(one.effect.channel)),
                          fmt::format("{:.3g} {}", one.size, facts_of(one.effect.channel).unit),
                          lambda_text(one.lambda),
                          one.beyond ? "beyond" : fmt::format("{:.2f}", one.power)});
  }
  std::string text = "\n" + table_text(table, style);
  if (effects.size() > kMostEffects) {
    text += fmt::format("  and {} effects more, shown better\n", effects.size() - kMostEffects);
  }
  return text;
}

std::string turn_text(const Waypoint& one) {
  if (one.turn == 0.0) return "";
  const double degrees = geometry::kDegrees * one.turn;
  if (std::abs(degrees) < 0.5) return "";
  return fmt::format("{:.0f} deg {} at {:g} rad/s", std::abs(degrees),
                     degrees > 0.0 ? "left" : "right", one.turn_rate);
}

/// The waypoints, and what loads become there.
std::string steps_part(const DrivePlan& plan, TextStyle style) {
  TextTable table{{Align::right, Align::left, Align::right, Align::right, Align::right},
                  {{"no", "landmark", "x", "y", "comes"}},
                  true,
                  2};
  std::vector<std::string>& heading = table.rows.front();
  heading.insert(heading.end(), {"stands", "turns"});
  table.columns.insert(table.columns.end(), {Align::right, Align::left});
  for (const std::string& load : plan.loads) {
    heading.push_back(load);
    table.columns.push_back(Align::right);
  }
  for (std::size_t k = 0; k < plan.waypoints.size(); ++k) {
    const Waypoint& one = plan.waypoints[k];
    std::string comes = k == 0 ? "" : fmt::format("{:g} m/s", one.speed);
    if (one.bend != 0.0) comes += one.bend > 0.0 ? ", bends left" : ", bends right";
    std::vector<std::string> row = {std::to_string(k + 1),
                                    one.landmark,
                                    fmt::format("{:.2f}", one.place.x()),
                                    fmt::format("{:.2f}", one.place.y()),
                                    comes,
                                    one.stop > 0.0 ? fmt::format("{:g} s", one.stop) : "",
                                    turn_text(one)};
    for (const double load : one.loads) row.push_back(fmt::format("{:g}", load));
    table.rows.push_back(std::move(row));
  }
  return "\n" + table_text(table, style);
}

std::string worth_part(const PlannedDrive& drive) {
  std::vector<std::string> useful;
  std::vector<std::string> useless;
  const std::size_t beyond = count_beyond(drive);
  for (const InstrumentWorth& one : drive.worth) {
    if (one.there) continue;
    const std::string name(name_of(one.instrument));
    if (one.tells > 0) {
      useful.push_back(
          fmt::format("{} (tells {} of the {} that no drive does)", name, one.tells, beyond));
    } else if (one.factor >= kWorth && useful.size() < 2) {
      useful.push_back(fmt::format("{} (lambda times {:.1f}, standard errors times {:.2f})", name,
                                   one.factor, 1.0 / std::sqrt(one.factor)));
    } else if (one.factor < kWorthless) {
      useless.push_back(name);
    }
  }
  std::string text = "\n";
  if (!useful.empty()) {
    text += fmt::format("  On the same drive would help: {}.\n", fmt::join(useful, "; "));
  }
  if (!useless.empty()) {
    text += fmt::format("  Of no use here: {}.\n", fmt::join(useless, ", "));
  }
  return text == "\n" ? "" : text;
}

}  // namespace

std::string plan_text(const PlannedDrive& drive, const std::string& files, TextStyle style) {
  std::string text = plan_verdict(drive, style);
  if (!drive.pairs.empty()) text += pairs_part(drive, style);
  if (!drive.effects.empty()) text += effects_part(drive, style);
  if (!drive.plan.waypoints.empty()) text += steps_part(drive.plan, style);
  text += worth_part(drive);
  if (!files.empty()) text += fmt::format("\n  The waypoints are in {}.\n", files);
  return text;
}

}  // namespace trussmap
