// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap build: a landmark map from recordings.
#include "commands.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "terminal.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct BuildOptions {
  std::vector<std::string> recordings;
  std::string model;
  std::string method = "elastic";
  std::string eta = "50";
  double min_drive = kDefaultMinDrive;  // m
  std::optional<double> gate;           // standard deviations; none: the method's own
  std::string out;
  std::string json_file;
  std::string svg;
  PageOptions page;
};

constexpr std::size_t kRejectedShown = 10;

Method method_of(const std::string& option) {
  if (option == "elastic-printed") return Method::elastic_printed;
  if (option == "gauss-markov") return Method::gauss_markov;
  if (option == "adjustment") return Method::adjustment;
  return Method::elastic;
}

BuildMapOptions map_options(const BuildOptions& options) {
  BuildMapOptions result;
  result.method = method_of(options.method);
  result.eta = parse_eta(options.eta);
  result.eta.hold_first = false;
  result.min_drive = options.min_drive;
  result.gate = options.gate;
  return result;
}

json survey_json(const MapOnSurvey& on_survey) {
  const SurveyComparison& map = on_survey.comparison;
  json exchanged = json::array();
  for (const auto& [a, b] : map.exchanged) exchanged.push_back({a, b});
  return {{"landmarks", map.landmarks},
          {"rms_m", map.rigid.rms},
          {"rms_dead_reckoning_m", on_survey.rms_dead_reckoning},
          {"rms_similarity_m", map.similarity.rms},
          {"scale", map.similarity.scale},
          {"rms_with_contradicting_m", map.rms_all},
          {"contradicting", map.contradicting},
          {"exchanged", exchanged}};
}

json result_json(const BuiltMap& built, const std::string& method) {
  json rejected = json::array();
  for (const RejectedSighting& one : built.rejected) {
    rejected.push_back({{"recording", one.recording},
                        {"t", one.t},
                        {"landmark", one.landmark},
                        {"misfit_m", one.misfit}});
  }
  json result = {{"method", method},
                 {"legs", built.legs},
                 {"landmarks", built.map.landmarks()},
                 {"routes", built.map.routes()},
                 {"first_sight", built.first_sight},
                 {"refinements", built.refinements},
                 {"side_sightings", built.side_sightings},
                 {"rejected", rejected},
                 {"unconfirmed", built.unconfirmed},
                 {"warnings", built.warnings}};
  if (built.fit) {
    result["chi2"] = built.fit->chi2;
    result["dof"] = built.fit->dof;
    result["p_value"] = built.fit->p_value;
    result["iterations"] = built.fit->iterations;
    result["converged"] = built.fit->converged;
  }
  if (built.on_survey) result["survey"] = survey_json(*built.on_survey);
  return result;
}

void print_survey(const MapOnSurvey& on_survey) {
  const SurveyComparison& map = on_survey.comparison;
  fmt::print("\n  against the survey of {} landmarks, after rotation and translation:\n",
             map.landmarks);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms error of the map", map.rigid.rms);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms of dead reckoning", on_survey.rms_dead_reckoning);
  fmt::print("  {:<28} {:>8.3f} m  (the map is {:.1f} % too {})\n", "rms with a scale as well",
             map.similarity.rms, 100.0 * std::abs(1.0 / map.similarity.scale - 1.0),
             map.similarity.scale < 1.0 ? "large" : "small");
  if (map.contradicting.empty()) return;
  fmt::print(
      "\n  These landmarks contradict the survey and do not count above (with them the rms "
      "is {:.3f} m):\n",
      map.rms_all);
  for (const std::string& name : map.contradicting) fmt::print("    landmark {}\n", name);
  for (const auto& [a, b] : map.exchanged) {
    fmt::print(
        "    landmarks {} and {} each lie where the survey has the other: are their labels "
        "exchanged?\n",
        a, b);
  }
}

void print_result(const BuiltMap& built, const BuildOptions& options) {
  fmt::print("map of {} landmarks and {} routes, method {}\n\n", built.map.landmarks(),
             built.map.routes(), options.method);
  const auto line = [](const char* what, std::size_t number) {
    fmt::print("  {:<28} {:>8}\n", what, number);
  };
  line("legs", static_cast<std::size_t>(built.legs));
  line("loops closed at first sight", static_cast<std::size_t>(built.first_sight));
  line("known routes driven again", static_cast<std::size_t>(built.refinements));
  line("sightings beside a leg's end", static_cast<std::size_t>(built.side_sightings));
  if (built.fit) {
    fmt::print("  {:<28} {:>8.1f}  of {} degrees of freedom\n", "chi^2 of the adjustment",
               built.fit->chi2, built.fit->dof);
  }
  line("sightings kept out", built.rejected.size());
  for (std::size_t k = 0; k < std::min(built.rejected.size(), kRejectedShown); ++k) {
    const RejectedSighting& one = built.rejected[k];
    const std::string where = options.recordings.size() > 1 ? one.recording + ", " : "";
    fmt::print("    {}t = {:.3f} s: landmark {} seen {:.2f} m from where the map has it\n", where,
               one.t, one.landmark, one.misfit);
  }
  if (built.rejected.size() > kRejectedShown) {
    fmt::print("    and {} more (--json lists all)\n", built.rejected.size() - kRejectedShown);
  }
  for (const std::string& name : built.unconfirmed) {
    fmt::print("  landmark {} was sighted too seldom to be placed\n", name);
  }
  if (built.on_survey) print_survey(*built.on_survey);
  for (const std::string& warning : built.warnings) fmt::print("\n{}", warning_text(warning));
  if (!options.out.empty()) fmt::print("\n  map written to {}\n", options.out);
}

void check_usage(const BuildOptions& options) {
  std::set<fs::path> seen;
  for (const std::string& folder : options.recordings) {
    std::error_code ignored;
    if (!seen.insert(fs::weakly_canonical(folder, ignored)).second) {
      throw UsageError(folder + " is given twice, expected each session once");
    }
  }
  if (!options.out.empty() && !is_map_file(options.out)) {
    throw UsageError("cannot write " + options.out + ": expected .graphml, .g2o, .geojson or .dot");
  }
}

void run_build(const BuildOptions& options) {
  check_usage(options);
  const bool at_once = options.method == "adjustment";
  Progress progress({{"reading", 30}, {at_once ? "adjusting" : "building the map", 70}});
  progress.next();
  std::vector<Recording> recordings;
  for (const std::string& folder : options.recordings) {
    recordings.push_back(read_recording(folder));
  }
  const Model model = read_model(options.model, recordings);
  progress.next();
  const BuiltMap built = [&] {
    try {
      return build_map(recordings, model, map_options(options));
    } catch (const std::invalid_argument& error) {  // an effect that these recordings cannot have
      throw InputError(options.model, 0, error.what());
    }
  }();

  Files files;
  const std::string method = "method " + options.method;
  if (!options.out.empty()) {
    files.emplace_back(options.out,
                       format_map(built.map, options.out, "trussmap build, " + method));
  }
  if (!options.json_file.empty()) {
    files.emplace_back(options.json_file, result_json(built, options.method).dump(2) + "\n");
  }
  if (!options.svg.empty()) {
    files.emplace_back(options.svg, map_picture(built, "Landmark map, " + method));
  }
  if (options.page.wanted()) {
    const std::string subject = subject_of(options.recordings, options.model) + ", " + method;
    add_page(files, map_page(built, subject), options.page);
  }
  write_files(files);
  progress.end();
  print_result(built, options);
}

}  // namespace

void setup_build(const Command& app) {
  auto options = std::make_shared<BuildOptions>();
  const Command command = app.add_subcommand(
      "build", "Build a landmark map from recordings (several folders: several sessions)");
  command.add_option("RECORDING", options->recordings, "Folders of CSV files, one per session")
      .required()
      .type_name("DIR");
  command.add_option("--model", options->model, "The robot and its noise (TOML)")
      .required()
      .type_name("FILE");
  command
      .add_option(
          "--method", options->method,
          "How the map is made: leg by leg, or by an adjustment of all measurements at once")
      .check(one_of({"elastic", "elastic-printed", "gauss-markov", "adjustment"}))
      .capture_default_str();
  command.add_option("--out", options->out, "Write the map (.graphml, .g2o, .geojson or .dot)")
      .type_name("FILE");
  command.add_option("--json", options->json_file, "Write every figure as JSON").type_name("FILE");
  command.add_option("--svg", options->svg, "Write a picture of the map before and after (SVG)")
      .type_name("FILE");
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command
      .add_option("--eta", options->eta,
                  "How many landmarks a refinement of the elastic methods may move: a number, all, "
                  "or auto")
      .type_name("N|all|auto")
      .check(eta_text())
      .capture_default_str();
  command
      .add_option("--min-drive", options->min_drive,
                  "Shortest driven path between a leg's ends [m]")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option(
          "--gate", options->gate,
          fmt::format("Leave sightings out that contradict the map by more standard deviations "
                      "than this; by default {:g}, of the sighting, the reckoning and the "
                      "map jointly, with --method adjustment {:g}, of the sighting alone",
                      kMapGate, kAdjustmentGate))
      .check(above_zero());
  command.callback([options] { run_build(*options); });
}

}  // namespace trussmap::app
