// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "io/geojson.hpp"
#include "recording/plan_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/test_path.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap {
using namespace io;

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 10> kPlanColumns = {
    "number", "landmark", "x", "y", "heading", "speed", "bend", "turn", "turn_rate", "stop_s"};
constexpr double kFarthest = 1e6;   // m
constexpr double kFastest = 100.0;  // m/s, rad/s
constexpr double kLargestLoad = 1e9;

/// A row as it stands, each number by itself.
Waypoint read_waypoint(const CsvReader& table, const std::vector<int>& loads) {
  const auto number = [&table](std::string_view column, double largest) {
    return table.number(table.require(column), largest);
  };
  Waypoint one;
  one.landmark = table.field(table.require("landmark"));
  if (one.landmark.empty()) table.fail("landmark is empty, expected the name of one");
  one.place = {number("x", kFarthest), number("y", kFarthest)};
  one.heading = number("heading", recording::kMostTurn);
  one.speed = number("speed", kFastest);
  one.bend = number("bend", recording::kMostTurn);
  one.turn = number("turn", recording::kMostTurn);
  one.turn_rate = number("turn_rate", kFastest);
  one.stop = number("stop_s", recording::kLongestStop);
  for (const int column : loads) one.loads.push_back(table.number(column, kLargestLoad));
  return one;
}

/// What it must be for a robot to drive it.
void require_drivable(const CsvReader& table, const Waypoint& one, const Waypoint* before) {
  if (before != nullptr && before->landmark == one.landmark) {
    table.fail(fmt::format("landmark is {} as in the row before, expected another",
                           shown_field(one.landmark)));
  }
  if (before != nullptr && !(one.speed > 0.0)) {
    table.fail(fmt::format("speed is {:g} m/s, expected above 0 (of all but the first waypoint)",
                           one.speed));
  }
  if (before != nullptr && one.place == before->place) {
    table.fail("x and y are those of the row before, expected another place");
  }
  if (one.stop < 0.0) table.fail(fmt::format("stop_s is {:g}, expected 0 or more", one.stop));
  if (one.turn != 0.0 && !(one.turn_rate > 0.0)) {
    table.fail(fmt::format("turn_rate is {:g} rad/s, expected above 0 where turn is not 0",
                           one.turn_rate));
  }
  if (std::abs(one.bend) > recording::kSharpestBend) {
    table.fail(fmt::format("bend is {:g}, expected -1 to 1 rad (are these degrees?)", one.bend));
  }
}

}  // namespace

DrivePlan read_plan(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string());
  for (const std::string_view name : kPlanColumns) static_cast<void>(table.require(name));
  DrivePlan plan;
  std::vector<int> loads;
  for (const std::string& name : table.columns()) {
    if (std::find(kPlanColumns.begin(), kPlanColumns.end(), name) != kPlanColumns.end()) continue;
    if (!is_covariate_name(name)) {
      throw InputError(file.string(), 1,
                       "column " + shown_field(name) +
                           " is no name of a load, expected a letter, then letters, digits, _");
    }
    plan.loads.push_back(name);
    loads.push_back(table.require(name));
  }
  std::map<std::string, Vector2> places;
  while (table.next()) {
    const double number = table.number(table.require("number"));
    const std::size_t expected = plan.waypoints.size() + 1;
    if (number != static_cast<double>(expected)) {
      table.fail(fmt::format("number is {:g}, expected {}", number, expected));
    }
    Waypoint one = read_waypoint(table, loads);
    require_drivable(table, one, plan.waypoints.empty() ? nullptr : &plan.waypoints.back());
    const auto [known, first] = places.emplace(one.landmark, one.place);
    if (!first && known->second != one.place) {
      table.fail(fmt::format("landmark {} is at ({:g}, {:g}), and above at ({:g}, {:g})",
                             shown_field(one.landmark), one.place.x(), one.place.y(),
                             known->second.x(), known->second.y()));
    }
    plan.waypoints.push_back(std::move(one));
  }
  if (plan.waypoints.size() < 2) {
    throw InputError(file.string(), 0,
                     fmt::format("{} waypoints, expected two or more", plan.waypoints.size()));
  }
  constexpr double kLongest = 1e6;  // s
  if (const double lasts = plan_duration(plan); !(lasts <= kLongest)) {
    throw InputError(file.string(), 0,
                     fmt::format("the plan lasts {:g} s, expected {:g} at most", lasts, kLongest));
  }
  return plan;
}

std::string format_plan(const DrivePlan& plan) {
  std::string text;
  for (const std::string_view name : kPlanColumns) {
    text += (text.empty() ? "" : ",") + std::string(name);
  }
  for (const std::string& load : plan.loads) text += "," + csv_field(load);
  text += "\n";
  for (std::size_t k = 0; k < plan.waypoints.size(); ++k) {
    const Waypoint& one = plan.waypoints[k];
    text += std::to_string(k + 1) + "," + csv_field(one.landmark);
    for (const double value : {one.place.x(), one.place.y(), one.heading, one.speed, one.bend,
                               one.turn, one.turn_rate, one.stop}) {
      text += "," + csv_number(value);
    }
    for (const double value : one.loads) text += "," + csv_number(value);
    text += "\n";
  }
  return text;
}

std::string format_plan_geojson(const DrivePlan& plan) {
  json features = json::array();
  for (std::size_t k = 0; k < plan.waypoints.size(); ++k) {
    const Waypoint& one = plan.waypoints[k];
    json properties = {{"number", k + 1},  {"landmark", one.landmark},   {"heading", one.heading},
                       {"turn", one.turn}, {"turn_rate", one.turn_rate}, {"stop_s", one.stop}};
    for (std::size_t load = 0; load < plan.loads.size(); ++load) {
      properties[plan.loads[load]] = one.loads[load];
    }
    features.push_back(geojson_point(one.place, std::move(properties)));
  }
  for (std::size_t k = 1; k < plan.waypoints.size(); ++k) {
    const Waypoint& from = plan.waypoints[k - 1];
    const Waypoint& to = plan.waypoints[k];
    features.push_back(geojson_line(
        from.place, to.place,
        {{"from", from.landmark}, {"to", to.landmark}, {"speed", to.speed}, {"bend", to.bend}}));
  }
  return geojson_text(features);
}

}  // namespace trussmap
