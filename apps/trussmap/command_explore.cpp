// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap explore: a robot explores an unknown mesh (apps/explore), and how good its map becomes.
#include "commands.hpp"
#include "explorer.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "results/exploration.hpp"
#include "results/json.hpp"
#include "scope_options.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/survey_comparison.hpp"
#include "trussmap/wording.hpp"
#include "trussmap/write_files.hpp"
#include "world.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct ExploreOptions {
  std::string mesh = "8x8";
  explore::WorldOptions world;
  bool no_compass = false;
  bool no_monitor = false;
  double tours = 3.0;
  ScopeOptions scope;
  std::string json_file;
  std::string html;
  std::string svg;
};

void print_alarms(const std::vector<explore::Alarm>& alarms) {
  for (const explore::Alarm& alarm : alarms) {
    fmt::print("after {} legs: {}, since leg {}; the map was made anew with that\n", alarm.legs,
               in_words(alarm.found.effect, {alarm.found.sd}), alarm.found.leg);
  }
}

void print_tours(const std::vector<results::ExploredTour>& tours, Laid laid) {
  const bool both = laid == Laid::as_it_is;
  fmt::print("\n  errors{} each time the way is as long as all routes together\n",
             both ? "" : " after the best rotation and translation,");
  fmt::print("  tour     way [m]  landmarks  position [m]{}   stretch  orientation [rad]\n",
             both ? "  aligned [m]" : "");
  for (const results::ExploredTour& tour : tours) {
    const bool last = &tour == &tours.back();
    fmt::print("  {:>4}  {:>10.0f}  {:>9}  {:>12.4f}", last ? "end" : std::to_string(tour.number),
               tour.way, tour.landmarks, tour.errors.position.value_or(0.0));
    if (both) fmt::print("  {:>11.4f}", tour.aligned.position.value_or(0.0));
    fmt::print("  {:>8.4f}  {:>17.4f}\n", tour.errors.stretch, tour.errors.orientation);
  }
  if (both) fmt::print("\n  aligned: after the best rotation and translation\n");
}

/// A drive of months, and all the rows that it would take.
void check_way(const ExploreOptions& options, double all_routes) {
  constexpr double kMostWay = 1e6;  // m
  constexpr double kMostTours = 1e4;
  const double way = std::max(options.tours, 1.0) * all_routes;
  if (way <= kMostWay && options.tours <= kMostTours) return;
  throw UsageError(
      fmt::format("explore: --tours {:g} of {:g} m of routes (--mesh, --spacing) are too far to "
                  "drive, expected "
                  "{:g} tours and {:g} m in all at most",
                  options.tours, all_routes, kMostTours, kMostWay));
}

void run_explore(ExploreOptions options) {
  options.world.compass = !options.no_compass;
  const auto made = [&options] {
    try {
      options.world.size = parse_mesh_size(options.mesh);
      return explore::World(options.world);
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  };
  explore::World world = made();
  MapBuilderOptions how;
  how.scope = options.scope.scope();
  how.law = options.scope.stiffness_law();
  explore::Explorer robot(world, how, !options.no_monitor);
  const LandmarkPositions truth = positions_of(world.plan());
  const Laid laid = options.world.compass ? Laid::as_it_is : Laid::aligned;
  const double all_routes = world.length_of_all_routes();
  check_way(options, all_routes);
  std::vector<results::ExploredTour> tours;
  std::vector<ExplorationFrame> frames;
  int legs = 0;
  const auto note = [&] {
    const LandmarkGraph map = robot.map().map();
    tours.push_back({static_cast<int>(tours.size()) + 1, world.way_driven(), map.landmarks(),
                     map_errors(map, truth, laid), map_errors(map, truth, Laid::aligned)});
  };
  robot.explore(options.tours * all_routes, [&](const Arrival& arrival) {
    ++legs;
    if (!options.html.empty() || !options.svg.empty()) {
      const LandmarkGraph map = robot.map().map();
      frames.push_back({laid == Laid::aligned ? laid_over(map, truth) : map, arrival.landmark,
                        world.way_driven(), map_errors(map, truth, laid).position.value_or(0.0)});
    }
    const double next = static_cast<double>(tours.size()) + 1.0;
    if (world.way_driven() >= next * all_routes) note();
  });
  note();

  const LandmarkGraph map = robot.map().map();
  Files files;
  if (!options.json_file.empty()) {
    std::vector<results::ExploreAlarm> alarms;
    for (const explore::Alarm& one : robot.alarms()) alarms.push_back({one.legs, one.found});
    files.emplace_back(options.json_file,
                       results::json_text(results::ExploreReport{
                           legs, world.way_driven(), world.plan().landmarks(), map.landmarks(),
                           map.routes(), laid == Laid::aligned, std::move(alarms), tours}));
  }
  const std::string subject = fmt::format("{} mesh, seed {}", options.mesh, options.world.seed);
  if (!options.svg.empty()) {
    files.emplace_back(options.svg, exploration_picture(frames, world.plan(), subject));
  }
  if (!options.html.empty()) {
    files.emplace_back(options.html, exploration_page(frames, world.plan(), subject));
  }
  files.write();
  fmt::print("explored: {} of {} landmarks and {} routes, {} legs, {:.0f} m\n", map.landmarks(),
             world.plan().landmarks(), map.routes(), legs, world.way_driven());
  print_alarms(robot.alarms());
  print_tours(tours, laid);
}

}  // namespace

void setup_explore(const Command& app) {
  auto options = std::make_shared<ExploreOptions>();
  const Command command = app.add_subcommand(
      "explore",
      "Let a simulated robot explore a mesh that it does not know, mapping it on the way; errors "
      "of its map as it grows");
  command.add_option("--mesh", options->mesh, "Landmarks along x and along y, like 8x8")
      .type_name("NxN")
      .capture_default_str();
  command.add_option("--spacing", options->world.spacing, "Distance between neighbours [m]")
      .check(above_zero())
      .capture_default_str();
  command.add_flag("--uneven", options->world.uneven,
                   "Gaps of 1 to 10 m between the mesh's lines, drawn, in place of --spacing");
  command
      .add_option("--walls", options->world.walls,
                  "Share of the mesh's routes that are walled up; all stays connected")
      .check(zero_or_more())
      .capture_default_str();
  command.add_option("--wheels", options->world.wheels, "Noise of both wheels [m^1/2]")
      .type_name("K")
      .check(above_zero())
      .capture_default_str();
  command.add_option("--wheelbase", options->world.wheelbase, "Distance of the wheels [m]")
      .check(length_of_robot())
      .capture_default_str();
  command.add_flag("--no-compass", options->no_compass, "The robot has no compass");
  command
      .add_option("--compass-sd", options->world.compass_sd,
                  "Standard deviation of a compass reading [rad]")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option(
          "--reach", options->world.reach,
          "How far it sees other landmarks, by range and bearing [m]; 0: it knows the one alone on "
          "which it stands")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option(
          "--tours", options->tours,
          "How far it drives, as a multiple of the length of all routes together; further where "
          "something is still unknown")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option("--air-loss", options->world.air_loss,
                  "Share of its radius that the left tyre loses on the way")
      .check(between(0.0, 0.5))
      .capture_default_str();
  command
      .add_option("--air-loss-leg", options->world.air_loss_leg,
                  "Legs that it has driven when the tyre loses air")
      .check(whole_number(0))
      .capture_default_str();
  command.add_flag("--no-monitor", options->no_monitor,
                   "The robot does not watch whether the model of its wheels still holds");
  command.add_option("--seed", options->world.seed, "Draws the world and the noise")
      .check(whole_number(0))
      .capture_default_str();
  add_scope_options(command, options->scope);
  command.add_option("--json", options->json_file, "Write every figure as JSON").type_name("FILE");
  command.add_option("--html", options->html, "Write a page that shows the map grow")
      .type_name("FILE");
  command.add_option("--svg", options->svg, "Write the map as it grows, as an animated picture")
      .type_name("FILE");
  command.callback([options] { run_explore(*options); });
}

}  // namespace trussmap::app
