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
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct CommandOptions {
  std::string mesh = "6x6";
  double spacing = 5.0;  // m
  std::vector<double> x_lines;
  std::vector<double> y_lines;
  int polygon = 0;  ///< corners; 0: a mesh
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
  std::vector<double> maps_after;
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
  Shard shard;
  try {
    shard = parse_shard(options.shard);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--shard: {}", error.what()));
  }
  if (!options.maps.empty() && !shard.has(0)) {
    throw UsageError(
        fmt::format("--maps shows the first seed, expected it with --shard 1/{} alone", shard.of));
  }
  return shard;
}

/// Absent: the paper's, those of them that are driven.
std::vector<int> maps_after(const CommandOptions& options) {
  constexpr int kPapers[] = {1, 5, 50};
  if (options.maps.empty() && !options.maps_after.empty()) {
    throw UsageError("--maps-after says after which tours --maps DIR writes: give both");
  }
  std::vector<int> after;
  for (const double tour : options.maps_after) {
    if (tour > options.tours) {
      throw UsageError(fmt::format("--maps-after {:g}, expected --tours of as many, not {}", tour,
                                   options.tours));
    }
    after.push_back(static_cast<int>(tour));
  }
  if (!after.empty()) return after;
  for (const int tour : kPapers) {
    if (tour <= options.tours) after.push_back(tour);
  }
  return after;
}

Mesh mesh_of(const CommandOptions& options) {
  if (options.polygon > 0) return regular_polygon(options.polygon, options.spacing);
  if (!options.x_lines.empty()) return mesh_of_lines(options.x_lines, options.y_lines);
  return even_mesh(parse_mesh_size(options.mesh), options.spacing);
}

/// Options of a robot that is not the one that was asked for are not left out in silence.
void check_robot(const Command& command, const CommandOptions& options) {
  const auto given = [&command](const char* name) { return command.count(name) > 0; };
  if (!options.wheels && given("--wheelbase")) {
    throw UsageError("--wheelbase is of a robot on wheels: give --wheels K, too");
  }
  if (options.wheels && given("--odometry-error")) {
    throw UsageError("--odometry-error and --wheels contradict each other");
  }
  if (options.no_compass && given("--compass-error")) {
    throw UsageError("--compass-error and --no-compass contradict each other");
  }
  if (given("--mesh") && (options.polygon > 0 || !options.x_lines.empty())) {
    throw UsageError("--mesh and --polygon or --x-lines contradict each other");
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
  if (options.polygon > 0 && !options.x_lines.empty()) {
    throw UsageError("--polygon and --x-lines contradict each other");
  }
  try {
    result.mesh = mesh_of(options);
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

/// Maps of the first seed, as GraphML and as pictures.
void gather_maps(TourOptions& experiment, const CommandOptions& options,
                 std::vector<FolderOfFiles>& maps) {
  experiment.maps_after = maps_after(options);
  if (options.maps.empty()) return;
  maps.push_back({options.maps, {}, {}});
  experiment.maps = [&maps](const TourMap& shown) {
    const std::string name = fmt::format("{}_{}", shown.method, shown.tour);
    const std::string what =
        fmt::format("trussmap tour, method {}, after tour {}", shown.method, shown.tour);
    auto& files = maps.front().files;
    files.emplace_back(name + ".graphml", format_map(shown.map, name + ".graphml", what));
    files.emplace_back(name + ".svg", tour_picture(shown));
  };
}

std::string world_in_words(const CommandOptions& options) {
  if (options.polygon > 0) return fmt::format("polygon of {}", options.polygon);
  return options.x_lines.empty() ? options.mesh + " mesh" : "uneven mesh";
}

/// Trials of a share, of which this process of a team does its own.
ShardResults run_share(const CommandOptions& options, const Shard& shard, const Team& team,
                       std::vector<FolderOfFiles>& maps) {
  TourOptions experiment = experiment_options(options);
  const std::string settings =
      tour_settings(experiment, fmt::format("{}, walk {}{}", world_in_words(options), options.walk,
                                            wheels_in_words(options)));
  const Shard mine{shard.number + shard.of * team.rank(), shard.of * team.count()};
  const auto seeds = static_cast<std::size_t>(options.seeds) / static_cast<std::size_t>(mine.of);
  if (team.rank() == 0) gather_maps(experiment, options, maps);
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
  std::vector<FolderOfFiles> maps;
  if (!run_together(false,
                    [&](const Team& team) { results = run_share(options, shard, team, maps); })) {
    return;
  }
  if (options.shard.empty()) {
    show_tour_run(results, {"", 0, false, options.json_file, options.page, std::move(maps)});
    return;
  }
  write_files({{options.out, format_shard(results)}}, maps);
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
  command
      .add_option("--polygon", options.polygon,
                  "In place of a mesh a regular polygon of N landmarks, --spacing apart")
      .check(whole_number(3));
  command
      .add_option(
          "--walk", options.walk,
          "How a tour covers all routes: by a closed walk, face by face, depth first or at random; "
          "drawn anew each tour")
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
      .check(length_of_robot())
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
  const Command command = app.add_subcommand("tour",
                                             "The elastic paper's experiment: a simulated robot "
                                             "tours a mesh again and again; errors of all "
                                             "methods' maps, tour by tour");
  add_world(command, *options);
  command.add_option("--tours", options->tours, "Number of tours")
      .check(whole_number(1))
      .capture_default_str();
  command.add_option("--seeds", options->seeds, "Average over this many simulated robots")
      .check(whole_number(1))
      .capture_default_str();
  command.add_option("--first-seed", options->first_seed, "Seed of the first of them")
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
      .add_option(
          "--maps", options->maps,
          "Write the first seed's maps by every method into this folder: METHOD_TOUR.graphml "
          "and, over the true map, METHOD_TOUR.svg; first_sight_1 is by first sight alone")
      .type_name("DIR");
  command
      .add_option("--maps-after", options->maps_after,
                  "With --maps: after which tours; if left out after 1, 5 and 50, as in the paper")
      .type_name("N,N...")
      .delimiter(',')
      .check(whole_number(1));
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
  command.callback([options, command] {
    check_robot(command, *options);
    run_tour(*options);
  });
}

}  // namespace trussmap::app
