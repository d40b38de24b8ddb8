// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap build: a landmark map from recordings.
#include "commands.hpp"
#include "json_values.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "recording_warnings.hpp"
#include "terminal.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
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
using json = nlohmann::ordered_json;

struct BuildOptions {
  std::vector<std::string> recordings;
  std::string model;
  std::string method = "adjustment";
  std::string eta = "50";
  double min_drive = kDefaultMinDrive;  // m
  std::optional<double> gate;           // standard deviations; none: the method's own
  std::string out;
  std::string json_file;
  std::string svg;
  std::string csv;
  PageOptions page;
};

constexpr std::size_t kRejectedShown = 10;

Method method_of(const std::string& option) {
  if (option == "elastic-printed") return Method::elastic_printed;
  if (option == "gauss-markov") return Method::gauss_markov;
  if (option == "elastic") return Method::elastic;
  return Method::adjustment;
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

json positions_json(const LandmarkGraph& map) {
  json positions = json::object();
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& one = map.landmark(k);
    json at = {{"x", one.position.x()}, {"y", one.position.y()}};
    if (one.covariance) {
      at["c_xx"] = (*one.covariance)(0, 0);
      at["c_xy"] = (*one.covariance)(0, 1);
      at["c_yy"] = (*one.covariance)(1, 1);
    }
    positions[one.name] = std::move(at);
  }
  return positions;
}

json freed_json(const std::vector<FreedError>& freed) {
  json result = nlohmann::ordered_json::array();
  for (const FreedError& one : freed) {
    json effect = effect_json(one.effect);
    effect["coefficients"] = one.effect.coefficients;
    effect["sd"] = one.sd;
    result.push_back(std::move(effect));
  }
  return result;
}

json quality_json(const MapQuality& quality) {
  return {{"median_sd_m", quality.median_sd},
          {"worst_sd_m", quality.worst_sd},
          {"worst_landmark", quality.worst_landmark},
          {"dispersion", quality.dispersion},
          {"loops", quality.loops},
          {"misclosure_share", number_or_null(quality.misclosure_share)},
          {"sightings", quality.sightings},
          {"left_out_share", quality.left_out_share},
          {"from_adjusted_rms_m", quality.from_adjusted}};
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
                 {"verdict", verdict_of(built)},
                 {"legs", built.legs},
                 {"landmarks", built.map.landmarks()},
                 {"routes", built.map.routes()},
                 {"first_sight", built.first_sight},
                 {"refinements", built.refinements},
                 {"side_sightings", built.side_sightings},
                 {"rejected", rejected},
                 {"unconfirmed", built.unconfirmed},
                 {"freed", freed_json(built.freed)},
                 {"quality", quality_json(built.quality)},
                 {"positions", positions_json(built.map)},
                 {"warnings", built.warnings},
                 {"notes", built.notes},
                 {"chi2", built.fit.chi2},
                 {"dof", built.fit.dof},
                 {"p_value", built.fit.p_value},
                 {"iterations", built.fit.iterations},
                 {"converged", built.fit.converged}};
  if (built.on_survey) result["survey"] = survey_json(*built.on_survey);
  return result;
}

void print_survey(const MapOnSurvey& on_survey) {
  const SurveyComparison& map = on_survey.comparison;
  fmt::print("\n  against the survey of {} landmarks, after rotation and translation:\n",
             map.landmarks);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms error of the map", map.rigid.rms);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms of dead reckoning", on_survey.rms_dead_reckoning);
  fmt::print("  {:<28} {:>8.3f} m  ({})\n", "rms with a scale as well", map.similarity.rms,
             map_scale_in_words(map.similarity.scale));
  if (map.contradicting.empty()) return;
  fmt::print(
      "\n  These landmarks contradict the survey and do not count above (with them the rms "
      "is {:.3f} m):\n",
      map.rms_all);
  for (const std::string& name : map.contradicting)
    fmt::print("    landmark {}\n", shortened_words(name));
  for (const auto& [a, b] : map.exchanged) {
    fmt::print(
        "    landmarks {} and {} each lie where the survey has the other: are their labels "
        "exchanged?\n",
        shortened_words(a), shortened_words(b));
  }
}

void print_left_out(const BuiltMap& built, bool several) {
  fmt::print("  {:<28} {:>8}  of {}\n", "sightings left out", built.rejected.size(),
             built.quality.sightings);
  for (std::size_t k = 0; k < std::min(built.rejected.size(), kRejectedShown); ++k) {
    const RejectedSighting& one = built.rejected[k];
    const std::string where = several ? one.recording + ", " : "";
    fmt::print("    {}t = {:.3f} s: landmark {} seen {:.2f} m from where the map has it\n", where,
               one.t, shortened_words(one.landmark), one.misfit);
  }
  if (built.rejected.size() > kRejectedShown) {
    fmt::print("    and {} more (--json lists all)\n", built.rejected.size() - kRejectedShown);
  }
}

void print_quality(const BuiltMap& built) {
  const MapQuality& quality = built.quality;
  fmt::print("  {:<28} {:>8.3f} m  (median; worst {:.3f} m, landmark {})\n",
             "standard error of landmarks", quality.median_sd, quality.worst_sd,
             shortened_words(quality.worst_landmark));
  if (built.method != Method::adjustment) {
    fmt::print("  {:<28} {:>8.3f} m  (rms; the standard errors above are that map's)\n",
               "off the adjusted map by", quality.from_adjusted);
  }
  fmt::print("  {:<28} {:>8.2f}  (chi^2/dof of {} degrees of freedom{}; 1: as the model says)\n",
             "dispersion of the errors", quality.dispersion, built.fit.dof,
             built.on_survey ? " without the survey" : "");
  if (quality.loops > 0) {
    fmt::print("  {:<28} {:>7.2f} %  of the way, by dead reckoning (median of {})\n",
               "loops miss their start by", 100.0 * quality.misclosure_share, quality.loops);
  }
}

void print_result(const BuiltMap& built, const BuildOptions& options) {
  fmt::print("map of {} landmarks and {} routes, method {}\n", built.map.landmarks(),
             built.map.routes(), options.method);
  fmt::print("{}\n\n",
             verdict_text(built.good() ? Mood::good : Mood::doubt, verdict_in_words(built)));
  print_quality(built);
  const auto line = [](const char* what, int number) {
    fmt::print("  {:<28} {:>8}\n", what, number);
  };
  line("legs", built.legs);
  line("loops closed at first sight", built.first_sight);
  line("known routes driven again", built.refinements);
  line("sightings beside a leg's end", built.side_sightings);
  print_left_out(built, options.recordings.size() > 1);
  if (built.on_survey) print_survey(*built.on_survey);
  for (std::size_t k = 1; k < built.warnings.size(); ++k) {  // the verdict has the first
    fmt::print("\n{}", warning_text(built.warnings[k]));
  }
  for (const std::string& note : built.notes) fmt::print("\nnote: {}\n", shortened_words(note));
}

void print_written(const Files& files) {
  const std::vector<fs::path> paths = files.paths();
  if (paths.empty()) return;
  fmt::print("\n  written: ");
  for (std::size_t k = 0; k < paths.size(); ++k) {
    fmt::print("{}{}", k == 0 ? "" : ", ", paths[k].string());
  }
  fmt::print("\n");
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
  Progress progress({{"reading", 30}, {"building the map", 70}});
  progress.next();
  const std::vector<Recording> recordings = read_recordings(options.recordings);
  const Model model = read_model(options.model, recordings);
  warn_of_mistakes(recordings, model, options.model);
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
  if (!options.csv.empty()) files.emplace_back(options.csv, format_positions(built.map));
  if (options.page.wanted()) {
    const std::string subject = subject_of(options.recordings, options.model) + ", " + method;
    add_page(files, map_page(built, subject), options.page);
  }
  files.write();
  progress.end();
  print_result(built, options);
  print_written(files);
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
          "How the map is made: by an adjustment of all measurements at once, or leg by leg, as a "
          "robot would on its way")
      .check(one_of({"adjustment", "elastic", "elastic-printed", "gauss-markov"}))
      .capture_default_str();
  command.add_option("--out", options->out, "Write the map (.graphml, .g2o, .geojson or .dot)")
      .type_name("FILE");
  command.add_option("--json", options->json_file, "Write every figure as JSON").type_name("FILE");
  command.add_option("--svg", options->svg, "Write a picture of the map before and after (SVG)")
      .type_name("FILE");
  command
      .add_option("--csv", options->csv,
                  "Write where the landmarks are: landmark,x,y and, where known, c_xx,c_xy,c_yy")
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
          fmt::format("Leave out sightings that are off by more of their own standard deviations "
                      "at the best fit of all others; by default {:g}, and more where too many "
                      "would go",
                      kAdjustmentGate))
      .check(above_zero());
  command.callback([options] { run_build(*options); });
}

}  // namespace trussmap::app
