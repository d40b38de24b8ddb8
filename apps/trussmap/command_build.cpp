// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap build: a landmark map from recordings; of recordings without landmarks, their path.
#include "build_output.hpp"
#include "commands.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "recording_warnings.hpp"
#include "results/json.hpp"
#include "results/maps.hpp"
#include "scope_options.hpp"
#include "store_sessions.hpp"
#include "terminal.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDefaultMethod = "adjustment";

struct BuildOptions {
  std::vector<std::string> recordings;
  std::string model;
  std::string store;
  std::optional<std::string> method;
  ScopeOptions scope;
  bool relax = false;
  double min_drive = kDefaultMinDrive;  // m
  std::optional<double> gate;           // standard deviations; none: the method's own
  std::string out;
  std::string json_file;
  std::string svg;
  std::string csv;
  PageOptions page;
};

Method method_of(const std::string& option) {
  if (option == "elastic-printed") return Method::elastic_printed;
  if (option == "gauss-markov") return Method::gauss_markov;
  if (option == "elastic") return Method::elastic;
  return Method::adjustment;
}

BuildMapOptions map_options(const BuildOptions& options) {
  BuildMapOptions result;
  result.method = method_of(options.method.value_or(kDefaultMethod));
  result.scope = options.scope.scope();
  result.law = options.scope.stiffness_law();
  result.relax = options.relax;
  result.min_drive = options.min_drive;
  result.gate = options.gate;
  return result;
}

/// What a method does not do is not left out in silence.
void check_scope(const BuildOptions& options) {
  const bool stored = !options.store.empty();
  const std::string method = options.method.value_or(stored ? "" : kDefaultMethod);
  const ScopeOptions& scope = options.scope;
  if (options.relax && stored) {
    throw UsageError("--relax is of a map that is built in one go, expected it without --store");
  }
  if (method == kDefaultMethod && (scope.given() || options.relax)) {
    throw UsageError(
        "--eta, --no-groups, --law and --relax are of maps that are built leg by leg, expected "
        "--method elastic, elastic-printed or gauss-markov with them");
  }
  if (method == "gauss-markov" &&
      (scope.no_groups || (scope.eta != "auto" && scope.eta != "all"))) {
    throw UsageError(
        "gauss-markov always brings the whole map to equilibrium: expected --method elastic "
        "--law variance with --eta");
  }
  if (method == "elastic-printed" && scope.law == "variance") {
    throw UsageError("elastic-printed has the paper's law: expected --method elastic with --law");
  }
}

void check_usage(const BuildOptions& options) {
  check_scope(options);
  std::set<fs::path> seen;
  for (const std::string& folder : options.recordings) {
    std::error_code ignored;
    if (!seen.insert(fs::weakly_canonical(folder, ignored)).second) {
      throw UsageError(folder + " is given twice, expected each session once");
    }
  }
  if (!options.store.empty() && (!options.svg.empty() || options.page.wanted())) {
    throw UsageError(
        "--store goes with --out, --csv and --json alone; a picture is drawn without it, or of a "
        "converted map");
  }
  for (const std::string& file : {options.out, options.csv, options.json_file}) {
    std::error_code ignored;
    if (!options.store.empty() && !file.empty() &&
        fs::weakly_canonical(file, ignored) == fs::weakly_canonical(options.store, ignored)) {
      throw UsageError(file + " is the store, expected another file to write");
    }
  }
  if (!options.out.empty() && !is_map_file(options.out)) {
    throw UsageError("cannot write " + options.out +
                     ": expected .graphml, .g2o, .geojson, .dot or .yaml");
  }
}

/// Legs are handed to a builder whose memory is a file.
void run_store(const BuildOptions& options) {
  if (options.method == "adjustment") {
    throw UsageError("a store grows leg by leg: expected elastic, elastic-printed or gauss-markov");
  }
  StoreSessions how{options.recordings, options.model, options.store};
  how.build = map_options(options);
  if (options.method) how.method = how.build.method;
  how.scope_given = options.scope.given();
  how.out = options.out;
  how.csv = options.csv;
  how.json_file = options.json_file;
  add_sessions(how);
}

/// A map file would be empty.
void check_landmarks(const BuildOptions& options, const std::vector<DrivenRecording>& recordings) {
  if (options.out.empty() && options.csv.empty()) return;
  const bool none = std::all_of(recordings.begin(), recordings.end(),
                                [](const DrivenRecording& one) { return one.sightings.empty(); });
  if (!none) return;
  throw UsageError("no landmark was sighted, so that there is no map for " +
                   std::string(options.out.empty() ? "--csv" : "--out") +
                   ", expected apply --adjusted --out, which writes the path");
}

void run_build(const BuildOptions& options) {
  check_usage(options);
  if (!options.store.empty()) return run_store(options);
  Progress progress({{"reading", 30}, {"building the map", 70}});
  progress.next();
  const std::vector<Recording> read = read_recordings(options.recordings);
  const Model model = read_model(options.model, read);
  const std::vector<DrivenRecording> recordings = with_wheels(read, model.robot);
  check_landmarks(options, recordings);
  warn_of_mistakes(read, model, options.model);
  progress.next();
  const BuiltMap built = [&] {
    try {
      return build_map(recordings, model, map_options(options));
    } catch (const std::invalid_argument& error) {  // an effect that these recordings cannot have
      throw InputError(options.model, 0, error.what());
    }
  }();

  Files files;
  const std::string method = options.method.value_or(kDefaultMethod);
  const std::string by = "method " + method;
  if (!options.out.empty()) {
    files.emplace_back(options.out, format_map(built.map, options.out, "trussmap build, " + by));
  }
  if (!options.json_file.empty()) {
    files.emplace_back(options.json_file, results::json_text(results::MapReport{&built, method}));
  }
  if (!options.svg.empty()) {
    files.emplace_back(options.svg, map_picture(built, built.paths.empty() ? "Landmark map, " + by
                                                                           : "Path, " + by));
  }
  if (!options.csv.empty()) files.emplace_back(options.csv, format_positions(built.map));
  if (options.page.wanted()) {
    const std::string subject = subject_of(options.recordings, options.model) + ", " + by;
    add_page(files, map_page(built, subject), options.page, recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}", map_text(built, method, options.recordings.size() > 1, style_of(stdout)));
  print_written(files);
}

}  // namespace

void setup_build(const Command& app) {
  auto options = std::make_shared<BuildOptions>();
  const Command command = app.add_subcommand(
      "build",
      "Build a landmark map from recordings (several folders: several sessions); where no landmark "
      "is sighted but there are fixes or loops, the path");
  command.add_option("RECORDING", options->recordings, "Folders of CSV files, one per session")
      .required()
      .type_name("DIR");
  command.add_option("--model", options->model, "The robot and its noise (TOML)")
      .required()
      .type_name("FILE");
  command
      .add_option(
          "--method", options->method,
          "How the map is made: by an adjustment of all measurements at once (the default), or leg "
          "by leg, as a robot would on its way: elastic, whose routes pull until all is at rest; "
          "gauss-markov, the same as weighted least squares; elastic-printed, the paper's rule, "
          "which may diverge. A store keeps its own, a new one has gauss-markov")
      .check(one_of({"adjustment", "elastic", "elastic-printed", "gauss-markov"}));
  command
      .add_option("--store", options->store,
                  "Add the recordings' legs to the map that is kept in this file (.db), which is "
                  "made if it is not there; each recording as a whole or not at all, none twice")
      .type_name("FILE");
  command
      .add_option("--out", options->out, "Write the map (.graphml, .g2o, .geojson, .dot or .yaml)")
      .type_name("FILE");
  command.add_option("--json", options->json_file, "Write every figure as JSON").type_name("FILE");
  command
      .add_option("--svg", options->svg,
                  "Write a picture of the map, or path, before and after (SVG)")
      .type_name("FILE");
  command
      .add_option(
          "--csv", options->csv,
          "Write where the landmarks are: landmark,x,y and, where known, c_xx,c_xy,c_yy and "
          "heading,sd_heading")
      .type_name("FILE");
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  add_scope_options(command, options->scope);
  command.add_flag("--relax", options->relax,
                   "Leg by leg: at the end, let the whole come to equilibrium");
  command
      .add_option("--min-drive", options->min_drive,
                  "Shortest driven path between a leg's ends [m]")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option(
          "--gate", options->gate,
          fmt::format("Leave out sightings that are off by more of their own standard deviations "
                      "at the best fit of all others; by default {:g}, and more where too many "
                      "would go",
                      kAdjustmentGate))
      .check(above_zero());
  command.callback([options] { run_build(*options); });
}

}  // namespace trussmap::app
