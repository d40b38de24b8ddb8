// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap tour: the elastic paper's experiment.
#include "commands.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "scope_options.hpp"
#include "team.hpp"
#include "tour_shards.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct CommandOptions {
  std::string mesh = "6x6";
  double spacing = 5.0;  // m
  std::vector<double> x_lines;
  std::vector<double> y_lines;
  std::string walk = "euler";
  int tours = 20;
  int seeds = 20;
  std::uint64_t first_seed = 1;
  double odometry_error = 0.05;
  double compass_error = 0.03;   // rad
  std::optional<double> wheels;  // k of both, m^(1/2)
  double wheelbase = 0.34;       // m
  bool no_compass = false;
  std::string readings;
  ScopeOptions scope;
  std::string maps;
  std::vector<double> maps_after{1, 5, 50};
  std::string json_file;
  PageOptions page;
  std::string shard;  ///< "3/16", "" for the whole run
  std::string out;
};

Shard shard_of(const CommandOptions& options) {
  if (options.shard.empty() != options.out.empty()) {
    throw UsageError("--shard and --out are given both or not at all");
  }
  if (options.shard.empty()) return {};
  if (!options.json_file.empty() || options.page.wanted()) {
    throw UsageError("--json, --html and --plots are of whole runs: give them to merge");
  }
  try {
    return parse_shard(options.shard);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--shard: {}", error.what()));
  }
}

TourOptions experiment_options(const CommandOptions& options) {
  TourOptions result;
  if (!options.wheels && (options.no_compass || !options.readings.empty())) {
    throw UsageError("--no-compass and --readings are of robots on wheels: give --wheels K, too");
  }
  if (options.no_compass && !options.readings.empty()) {
    throw UsageError("--no-compass and --readings contradict each other");
  }
  if (options.x_lines.empty() != options.y_lines.empty()) {
    throw UsageError("--x-lines and --y-lines are given both or not at all");
  }
  try {
    result.mesh = options.x_lines.empty()
                      ? even_mesh(parse_mesh_size(options.mesh), options.spacing)
                      : mesh_of_lines(options.x_lines, options.y_lines);
    result.walk = parse_walk_kind(options.walk);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  result.tours = options.tours;
  result.seeds = options.seeds;
  result.first_seed = options.first_seed;
  result.odometry_error = options.odometry_error;
  result.compass_error = options.compass_error;
  result.scope = options.scope.scope();
  result.law = options.scope.stiffness_law();
  if (options.wheels) {
    result.wheels = TourWheels{*options.wheels, options.wheelbase, CompassReadings::landmark};
    if (!options.readings.empty()) {
      result.wheels->readings = parse_compass_readings(options.readings);
    }
    if (options.no_compass) result.wheels->readings = CompassReadings::none;
  }
  return result;
}

/// Seeds that are done, of this process's; a run of several processes shows the first one's.
class SeedProgress {
 public:
  SeedProgress(TourOptions& experiment, std::size_t seeds) {
    progress_.next();
    experiment.seeds_done = [this, seeds](int done) {
      progress_.report(done, static_cast<int>(seeds));
    };
  }

 private:
  Progress progress_{{{"seeds"}}};
};

std::string wheels_in_words(const CommandOptions& options) {
  if (!options.wheels) return "";
  return fmt::format(
      ", wheels {:g} m^1/2, {}", *options.wheels,
      options.no_compass
          ? "no compass"
          : "compass read once per " + (options.readings.empty() ? "landmark" : options.readings));
}

/// Maps of the first seed, as GraphML.
std::function<void(const std::string&, int, const LandmarkGraph&)> map_writer(
    const CommandOptions& options) {
  if (options.maps.empty()) return nullptr;
  std::filesystem::create_directories(options.maps);
  return [&options](const std::string& method, int tour, const LandmarkGraph& map) {
    if (std::ranges::count(options.maps_after, tour) == 0) return;
    const std::string name = fmt::format("{}/{}_{}.graphml", options.maps, method, tour);
    write_file(name,
               format_map(map, name,
                          fmt::format("trussmap tour, method {}, after tour {}", method, tour)));
  };
}

/// Trials of a share, of which this process of a team does its own.
ShardResults run_share(const CommandOptions& options, const Shard& shard, const Team& team) {
  TourOptions experiment = experiment_options(options);
  const std::string world = options.x_lines.empty() ? options.mesh + " mesh" : "uneven mesh";
  const std::string settings = tour_settings(
      experiment, fmt::format("{}, walk {}{}", world, options.walk, wheels_in_words(options)));
  const Shard mine{shard.number + shard.of * team.rank(), shard.of * team.count()};
  const auto seeds = static_cast<std::size_t>(options.seeds) / static_cast<std::size_t>(mine.of);
  if (team.rank() == 0) experiment.maps = map_writer(options);
  std::optional<SeedProgress> progress;
  if (team.rank() == 0) progress.emplace(experiment, std::max<std::size_t>(seeds, 1));
  ShardResults results = run_tour_shard(experiment, settings, mine);
  for (const std::string& text : team.gather(format_shard(results))) {
    results.results.merge(parse_shard_results(text, "a process's share").results);
  }
  results.shard = shard;
  return results;
}

void run_tour(const CommandOptions& options) {
  const Shard shard = shard_of(options);
  ShardResults results;
  if (!run_together(false, [&](const Team& team) { results = run_share(options, shard, team); })) {
    return;
  }
  if (options.shard.empty()) {
    show_tour_run(results, {"", 0, false, options.json_file, options.page});
    return;
  }
  write_file(options.out, format_shard(results));
  fmt::print("shard {}/{}: {} of {} seeds, in {}\n", shard.number, shard.of, results.results.size(),
             results.trials, options.out);
}

void add_world(const Command& command, CommandOptions& options) {
  command.add_option("--mesh", options.mesh, "Landmarks along x and along y, like 6x6")
      .type_name("NxN")
      .capture_default_str();
  command.add_option("--spacing", options.spacing, "Distance between neighbours [m]")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option("--x-lines", options.x_lines,
                  "Uneven mesh: x of its columns [m], like 0,1,9,11 (with --y-lines)")
      .type_name("X,X...")
      .delimiter(',');
  command.add_option("--y-lines", options.y_lines, "Uneven mesh: y of its rows [m]")
      .type_name("X,X...")
      .delimiter(',');
  command.add_option("--walk", options.walk, "How a tour covers the routes; drawn anew each tour")
      .check(one_of({"euler", "face", "depth-first", "random"}))
      .capture_default_str();
}

void add_wheels(const Command& command, CommandOptions& options) {
  command
      .add_option("--wheels", options.wheels,
                  "Measure by simulated wheels of this noise [m^1/2], covariances by the odometry "
                  "model, in place of --odometry-error")
      .type_name("K")
      .check(above_zero());
  command.add_option("--wheelbase", options.wheelbase, "With --wheels: their distance [m]")
      .check(above_zero())
      .capture_default_str();
  command.add_flag("--no-compass", options.no_compass, "With --wheels: the robot has no compass");
  command
      .add_option("--readings", options.readings,
                  "With --wheels: when it reads the compass: once per tour, at each landmark (the "
                  "default) or in each row")
      .check(one_of({"tour", "landmark", "row"}));
}

}  // namespace

void setup_tour(const Command& app) {
  auto options = std::make_shared<CommandOptions>();
  const Command command = app.add_subcommand(
      "tour", "Tour a simulated mesh again and again and compare all methods with the truth");
  add_world(command, *options);
  command.add_option("--tours", options->tours, "Number of tours")
      .check(whole_number(1))
      .capture_default_str();
  command.add_option("--seeds", options->seeds, "Average over this many seeds")
      .check(whole_number(1))
      .capture_default_str();
  command.add_option("--first-seed", options->first_seed, "The first of them")
      .check(whole_number(0))
      .capture_default_str();
  command
      .add_option("--odometry-error", options->odometry_error,
                  "Mean absolute error of a route's stretch, as a fraction of it")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option("--compass-error", options->compass_error,
                  "Mean absolute error of a route's orientation [rad]")
      .check(above_zero())
      .capture_default_str();
  add_wheels(command, *options);
  add_scope_options(command, options->scope);
  command
      .add_option("--maps", options->maps,
                  "Write the first seed's maps by every method into this folder (GraphML)")
      .type_name("DIR");
  command.add_option("--maps-after", options->maps_after, "After which tours")
      .type_name("N,N...")
      .delimiter(',')
      .capture_default_str();
  command.add_option("--json", options->json_file, "Write every figure as JSON").type_name("FILE");
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command
      .add_option("--shard", options->shard,
                  "Do a share of the seeds alone, like 3/16, as a task of a job array; with --out")
      .type_name("K/N");
  command
      .add_option("--out", options->out,
                  "With --shard: write its results; merge prints what the whole run would have")
      .type_name("FILE");
  if (built_with_mpi()) {
    command.footer("mpirun -n N trussmap tour ... shares the seeds among N processes.");
  }
  command.callback([options] { run_tour(*options); });
}

}  // namespace trussmap::app
