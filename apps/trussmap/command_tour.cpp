// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap tour: the elastic paper's experiment.
#include "commands.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "trussmap/tour_experiment.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

using nlohmann::json;

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
  double compass_error = 0.03;  // rad
  std::string eta = "all";
  std::string json_file;
  PageOptions page;
};

TourOptions experiment_options(const CommandOptions& options) {
  TourOptions result;
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
  result.eta = parse_eta(options.eta);
  return result;
}

json metrics_json(const TourMetrics& metrics) {
  json result = {{"stretch_error", metrics.stretch_error.mean},
                 {"stretch_error_se", metrics.stretch_error.standard_error},
                 {"orientation_error_rad", metrics.orientation_error.mean},
                 {"orientation_error_rad_se", metrics.orientation_error.standard_error}};
  if (metrics.position_error) {
    result["position_error_m"] = metrics.position_error->mean;
    result["position_error_m_se"] = metrics.position_error->standard_error;
  }
  return result;
}

json result_json(const TourResult& result) {
  json tours = json::array();
  for (std::size_t tour = 0; tour < result.tours.size(); ++tour) {
    json methods;
    for (const auto& [name, metrics] : result.tours[tour]) methods[name] = metrics_json(metrics);
    tours.push_back({{"tour", tour + 1}, {"methods", methods}});
  }
  return {{"tours", tours},
          {"first_sight",
           {{"before", metrics_json(result.first_sight_before)},
            {"after", metrics_json(result.first_sight_after)}}}};
}

/// Which tours a table shows: the first few, then fewer and fewer, and the last.
std::vector<std::size_t> shown_tours(std::size_t count) {
  std::vector<std::size_t> shown;
  for (const std::size_t tour : {1, 2, 3, 4, 5, 10, 20, 50, 100, 200, 500, 1000}) {
    if (tour <= count) shown.push_back(tour);
  }
  if (shown.back() != count) shown.push_back(count);
  return shown;
}

template <class Pick>
void print_block(const TourResult& result, const char* title, int digits, const Pick& pick) {
  fmt::print("\n{}\n  tour", title);
  std::vector<std::string> methods;
  for (const std::string& method : tour_methods()) {
    if (pick(result.tours.front().at(method))) methods.push_back(method);
  }
  for (const std::string& method : methods) fmt::print("  {:>16}", method);
  fmt::print("\n");
  for (const std::size_t tour : shown_tours(result.tours.size())) {
    fmt::print("  {:>4}", tour);
    for (const std::string& method : methods) {
      fmt::print("  {:>16.{}f}", pick(result.tours[tour - 1].at(method))->mean, digits);
    }
    fmt::print("\n");
  }
}

void print_result(const TourResult& result, const CommandOptions& options) {
  const MethodMetrics& last = result.tours.back();
  const double raw = last.at("raw").stretch_error.mean;
  fmt::print(
      "after {} tours the elastic map's mean error is {:.2f} % of a route's stretch and {:.4f} rad "
      "of its orientation\n"
      "(single measurements: {:.2f} %, {:.4f} rad; the best possible, the adjustment: {:.2f} %, "
      "{:.4f} rad);\nmeans over {} seeds\n",
      result.tours.size(), 100.0 * last.at("elastic").stretch_error.mean,
      last.at("elastic").orientation_error.mean, 100.0 * raw, last.at("raw").orientation_error.mean,
      100.0 * last.at("adjustment").stretch_error.mean,
      last.at("adjustment").orientation_error.mean, options.seeds);
  print_block(result, "stretch error, mean of |s - s_true|/s_true over the routes", 4,
              [](const TourMetrics& f) { return std::optional<SeedMean>(f.stretch_error); });
  print_block(result, "orientation error, mean of |theta - theta_true| over the routes [rad]", 4,
              [](const TourMetrics& f) { return std::optional<SeedMean>(f.orientation_error); });
  print_block(result, "position error, mean distance of the landmarks from the truth [m]", 3,
              [](const TourMetrics& f) { return f.position_error; });
  fmt::print(
      "\nfirst sight, tour 1: before {:.3f} / {:.3f} rad, after {:.3f} / {:.3f} rad "
      "(the paper's Table I, one map: 0.049 / 0.033, then 0.046 / 0.032)\n",
      result.first_sight_before.stretch_error.mean,
      result.first_sight_before.orientation_error.mean, result.first_sight_after.stretch_error.mean,
      result.first_sight_after.orientation_error.mean);
}

TourResult toured(const CommandOptions& options) {
  TourOptions experiment = experiment_options(options);
  Progress progress({{"seeds"}});
  progress.next();
  experiment.seeds_done = [&](int done) { progress.report(done, options.seeds); };
  return run_tours(experiment);
}

void run_tour(const CommandOptions& options) {
  const TourResult result = toured(options);
  Files files;
  if (!options.json_file.empty()) {
    files.emplace_back(options.json_file, result_json(result).dump(2) + "\n");
  }
  if (options.page.wanted()) {
    const std::string world = options.x_lines.empty() ? options.mesh + " mesh" : "uneven mesh";
    add_page(files, tour_page(result, options.seeds, world + ", walk " + options.walk),
             options.page);
  }
  files.write();
  print_result(result, options);
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
  command
      .add_option("--eta", options->eta,
                  "Landmarks a refinement may move: a number, all, or auto (estimated each time)")
      .type_name("N|all|auto")
      .check(eta_text())
      .capture_default_str();
  command.add_option("--json", options->json_file, "Write every figure as JSON").type_name("FILE");
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.callback([options] { run_tour(*options); });
}

}  // namespace trussmap::app
