// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/units.hpp"

#include "geometry/units.hpp"

#include <algorithm>
#include <cctype>
#include <regex>
#include <vector>

namespace trussmap::logs {
namespace {

constexpr double kDegree = geometry::kFullTurn / 360.0;
constexpr double kInch = 0.0254;

constexpr Unit kUnits[] = {
    {"m", Quantity::length, 1.0},
    {"cm", Quantity::length, 1e-2},
    {"mm", Quantity::length, 1e-3},
    {"in", Quantity::length, kInch},
    {"ft", Quantity::length, 12.0 * kInch},
    {"rad", Quantity::angle, 1.0},
    {"deg", Quantity::angle, kDegree},
    {"turn", Quantity::angle, geometry::kFullTurn},
    {"s", Quantity::time, 1.0},
    {"ms", Quantity::time, 1e-3},
    {"us", Quantity::time, 1e-6},
    {"ns", Quantity::time, 1e-9},
    {"min", Quantity::time, 60.0},
    {"m/s", Quantity::speed, 1.0},
    {"cm/s", Quantity::speed, 1e-2},
    {"mm/s", Quantity::speed, 1e-3},
    {"in/s", Quantity::speed, kInch},
    {"ft/s", Quantity::speed, 12.0 * kInch},
    {"km/h", Quantity::speed, 1.0 / 3.6},
    {"rad/s", Quantity::turn_rate, 1.0},
    {"deg/s", Quantity::turn_rate, kDegree},
    {"turn/s", Quantity::turn_rate, geometry::kFullTurn},
    {"rpm", Quantity::turn_rate, geometry::kFullTurn / 60.0},
    {"tick", Quantity::ticks, 1.0},
    {"tick/s", Quantity::ticks, 1.0},
    {"", Quantity::none, 1.0},
};

struct Spelling {
  std::string_view written;
  std::string_view name;
};

constexpr Spelling kSpellings[] = {
    {"metre", "m"},         {"metres", "m"},        {"meter", "m"},         {"meters", "m"},
    {"inch", "in"},         {"inches", "in"},       {"feet", "ft"},         {"foot", "ft"},
    {"radian", "rad"},      {"radians", "rad"},     {"degree", "deg"},      {"degrees", "deg"},
    {"\u00b0", "deg"},      {"turns", "turn"},      {"rev", "turn"},        {"revs", "turn"},
    {"rotations", "turn"},  {"rotation", "turn"},   {"sec", "s"},           {"second", "s"},
    {"seconds", "s"},       {"secs", "s"},          {"msec", "ms"},         {"millis", "ms"},
    {"milliseconds", "ms"}, {"\u00b5s", "us"},      {"\u03bcs", "us"},      {"usec", "us"},
    {"micros", "us"},       {"microseconds", "us"}, {"nanoseconds", "ns"},  {"nanos", "ns"},
    {"nsec", "ns"},         {"minutes", "min"},     {"mps", "m/s"},         {"kph", "km/h"},
    {"degrees/s", "deg/s"}, {"dps", "deg/s"},       {"\u00b0/s", "deg/s"},  {"rps", "turn/s"},
    {"rev/s", "turn/s"},    {"ticks", "tick"},      {"counts", "tick"},     {"count", "tick"},
    {"ticks/s", "tick/s"},  {"counts/s", "tick/s"}, {"tick/sec", "tick/s"}, {"deg/sec", "deg/s"},
    {"rad/sec", "rad/s"},   {"m/sec", "m/s"},       {"mm/sec", "mm/s"},
};

}  // namespace

std::optional<Unit> unit_named(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string_view wanted = lower;
  for (const Spelling& one : kSpellings) {
    if (one.written == wanted) {
      wanted = one.name;
      break;
    }
  }
  for (const Unit& one : kUnits) {
    if (one.name == wanted) return one;
  }
  return std::nullopt;
}

std::optional<Unit> unit_in(const std::string& name) {
  static const std::regex kBrackets(R"([(\[]\s*([^)\]]+?)\s*[)\]]\s*$)");
  static const std::regex kSuffix(R"([_ ]([A-Za-z]+(?:[_/](?:s|sec))?)$)");
  std::smatch found;
  if (std::regex_search(name, found, kBrackets)) return unit_named(found[1].str());
  static const std::regex kHump(R"([a-z0-9]([A-Z][a-z]+)$)");
  if (!std::regex_search(name, found, kSuffix) && !std::regex_search(name, found, kHump)) {
    return std::nullopt;
  }
  std::string unit = found[1].str();
  std::replace(unit.begin(), unit.end(), '_', '/');
  return unit_named(unit);
}

std::string unit_names(Quantity quantity) {
  std::string names;
  for (const Unit& one : kUnits) {
    if (one.quantity != quantity) continue;
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  }
  return names;
}

}  // namespace trussmap::logs
