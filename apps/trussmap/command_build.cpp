// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap build: a landmark map from recordings.
#include "adjusted_map.hpp"
#include "build_map/recording_map.hpp"
#include "commands.hpp"
#include "map_files.hpp"
#include "odometry/effect_correction.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "plot/map_picture.hpp"
#include "progress.hpp"
#include "report/map_page.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/survey_comparison.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/LU>
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

/// The map builder's part; an adjustment takes only legs and routes from it.
RecordingMapOptions map_options(const BuildOptions& options) {
  RecordingMapOptions result;
  result.builder.method = options.method == "elastic-printed" ? Method::elastic_printed
                          : options.method == "gauss-markov"  ? Method::gauss_markov
                          : options.method == "adjustment"    ? Method::gauss_markov
                                                              : Method::elastic;
  result.builder.eta = parse_eta(options.eta);
  result.builder.eta.hold_first = false;
  result.min_drive = options.min_drive;
  if (options.gate && options.method != "adjustment") result.gate = *options.gate;
  return result;
}

std::vector<SurveyPoint> survey_of(const std::vector<Recording>& recordings) {
  std::map<std::string, SurveyPoint> survey;
  for (const Recording& recording : recordings) {
    for (const SurveyPoint& point : recording.survey) survey.try_emplace(point.landmark, point);
  }
  std::vector<SurveyPoint> result;
  result.reserve(survey.size());
  for (const auto& [name, point] : survey) result.push_back(point);
  return result;
}

struct Judged {
  SurveyComparison map;
  double rms_dead_reckoning = 0.0;  // m
};

json survey_json(const Judged& judged) {
  json exchanged = json::array();
  for (const auto& [a, b] : judged.map.exchanged) exchanged.push_back({a, b});
  return {{"landmarks", judged.map.landmarks},
          {"rms_m", judged.map.rigid.rms},
          {"rms_dead_reckoning_m", judged.rms_dead_reckoning},
          {"rms_similarity_m", judged.map.similarity.rms},
          {"scale", judged.map.similarity.scale},
          {"rms_with_contradicting_m", judged.map.rms_all},
          {"contradicting", judged.map.contradicting},
          {"exchanged", exchanged}};
}

json result_json(const RecordingMap& built, const std::string& method) {
  json rejected = json::array();
  for (const RejectedSighting& one : built.rejected) {
    rejected.push_back({{"recording", one.recording},
                        {"t", one.t},
                        {"landmark", one.landmark},
                        {"misfit_m", one.misfit}});
  }
  return {{"method", method},
          {"legs", built.legs},
          {"landmarks", built.map.landmarks()},
          {"routes", built.map.routes()},
          {"first_sight", built.first_sight},
          {"refinements", built.refinements},
          {"side_sightings", built.side_sightings},
          {"rejected", rejected},
          {"unconfirmed", built.unconfirmed}};
}

json fit_json(const AdjustedMap& adjusted) {
  return {{"chi2", adjusted.chi2},
          {"dof", adjusted.dof},
          {"p_value", adjusted.p_value},
          {"iterations", adjusted.iterations},
          {"converged", adjusted.converged}};
}

void print_survey(const Judged& judged) {
  const SurveyComparison& map = judged.map;
  fmt::print("\n  against the survey of {} landmarks, after rotation and translation:\n",
             map.landmarks);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms error of the map", map.rigid.rms);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms of dead reckoning", judged.rms_dead_reckoning);
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

void print_result(const RecordingMap& built, const std::optional<AdjustedMap>& adjusted,
                  const BuildOptions& options, bool judged_too, const Judged& judged,
                  const std::vector<std::string>& warnings) {
  fmt::print("map of {} landmarks and {} routes, method {}\n\n", built.map.landmarks(),
             built.map.routes(), options.method);
  const auto line = [](const char* what, std::size_t number) {
    fmt::print("  {:<28} {:>8}\n", what, number);
  };
  line("legs", static_cast<std::size_t>(built.legs));
  line("loops closed at first sight", static_cast<std::size_t>(built.first_sight));
  line("known routes driven again", static_cast<std::size_t>(built.refinements));
  line("sightings beside a leg's end", static_cast<std::size_t>(built.side_sightings));
  if (adjusted) {
    fmt::print("  {:<28} {:>8.1f}  of {} degrees of freedom\n", "chi^2 of the adjustment",
               adjusted->chi2, adjusted->dof);
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
  if (judged_too) print_survey(judged);
  for (const std::string& warning : warnings) fmt::print("\n{}", warning_text(warning));
  if (!options.out.empty()) fmt::print("\n  map written to {}\n", options.out);
}

MapPicture picture_of(const RecordingMap& built, const std::vector<SurveyPoint>& survey,
                      const Judged& judged, const std::string& method) {
  MapPicture picture;
  picture.title = "Landmark map, method " + method;
  picture.map = built.map;
  picture.before = built.dead_reckoned;
  if (judged.map.landmarks >= 3) {
    picture.map_onto_truth = judged.map.rigid;
    for (const SurveyPoint& point : survey) picture.truth[point.landmark] = {point.x, point.y};
  }
  return picture;
}

void check_usage(const BuildOptions& options) {
  std::set<fs::path> seen;
  for (const std::string& folder : options.recordings) {
    std::error_code ignored;
    if (!seen.insert(fs::weakly_canonical(folder, ignored)).second) {
      throw UsageError(folder + " is given twice, expected each session once");
    }
  }
  if (!options.out.empty()) check_map_format(options.out);
}

/// Numbers that no wheeled robot has: other units, mostly.
void doubt_units(const std::vector<Recording>& recordings, const Model& model,
                 std::vector<std::string>& warnings) {
  constexpr double kFast = 30.0;  // m/s
  constexpr double kWide = 10.0;  // m
  for (const Recording& recording : recordings) {
    const Drive& drive = recording.drive;
    double path = 0.0;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      path += std::max(std::abs(drive.left[row]), std::abs(drive.right[row]));
    }
    const double speed = path / (drive.t.back() - drive.start());
    if (speed > kFast) {
      warnings.push_back(
          fmt::format("{}: the wheels drive at {:.3g} m/s on average; are left and "
                      "right in metres, t in seconds?",
                      recording.name, speed));
    }
  }
  if (model.robot.wheelbase > kWide) {
    warnings.push_back(
        fmt::format("a wheelbase of {:g} m; is it in metres?", model.robot.wheelbase));
  }
}

/// How far the map's routes are from what was measured of them, in standard deviations, in the
/// middle of all routes. Sound maps have 1 to 5.
double contradiction(const LandmarkGraph& map) {
  std::vector<double> distances;
  for (int k = 0; k < map.routes(); ++k) {
    const Route& route = map.route(k);
    const Vector2 off = map.landmark(route.target).position - map.landmark(route.source).position -
                        route.displacement;
    distances.push_back(std::sqrt(off.dot(route.covariance.inverse() * off)));
  }
  if (distances.empty()) return 0.0;
  std::nth_element(distances.begin(), distances.begin() + std::ssize(distances) / 2,
                   distances.end());
  return distances[distances.size() / 2];
}

std::vector<std::string> doubts_of(const RecordingMap& built,
                                   const std::vector<Recording>& recordings, const Model& model,
                                   const BuildOptions& options) {
  constexpr double kTorn = 20.0;  // standard deviations
  std::vector<std::string> warnings;
  doubt_units(recordings, model, warnings);
  const double torn = contradiction(built.map);
  if (torn > kTorn) {
    warnings.push_back(fmt::format(
        "the map contradicts its own routes, by {:.0f} standard deviations in the middle; {}", torn,
        options.method == "elastic-printed"
            ? "the printed refinement diverges here, use --method elastic"
            : "wrong units, a wrong wheelbase, exchanged columns or labels, or noise that is "
              "believed too small"));
  }
  return warnings;
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
  if (!model.effects.empty()) {
    try {
      recordings = without_effects(recordings, model);
    } catch (const std::invalid_argument& error) {
      throw InputError(options.model, 0, error.what());
    }
  }
  progress.next();
  std::optional<AdjustedMap> adjusted;
  if (at_once) {
    adjusted = map_by_adjustment(recordings, model, options.gate.value_or(kAdjustmentGate),
                                 map_options(options));
  }
  const RecordingMap built =
      adjusted ? adjusted->map : map_recordings(recordings, model, map_options(options));

  const std::vector<SurveyPoint> survey = survey_of(recordings);
  Judged judged;
  judged.map = compare_with_survey(positions_of(built.map), survey);
  judged.rms_dead_reckoning = survey_rms(built.dead_reckoned, survey, judged.map.contradicting);
  const bool judged_too = judged.map.landmarks >= 3;
  std::vector<std::string> warnings = doubts_of(built, recordings, model, options);
  if (adjusted)
    warnings.insert(warnings.end(), adjusted->warnings.begin(), adjusted->warnings.end());

  Files files;
  if (!options.out.empty()) {
    files.emplace_back(options.out, format_map(built.map, options.out,
                                               "trussmap build, method " + options.method));
  }
  if (!options.json_file.empty()) {
    json result = result_json(built, options.method);
    if (adjusted) result.update(fit_json(*adjusted));
    if (judged_too) result["survey"] = survey_json(judged);
    result["warnings"] = warnings;
    files.emplace_back(options.json_file, result.dump(2) + "\n");
  }
  if (!options.svg.empty()) {
    files.emplace_back(options.svg, draw_map(picture_of(built, survey, judged, options.method)));
  }
  if (options.page.wanted()) {
    BuiltMap shown;
    shown.picture = picture_of(built, survey, judged, options.method);
    shown.method = options.method;
    shown.survey = judged.map;
    shown.rms_dead_reckoning = judged.rms_dead_reckoning;
    shown.legs = built.legs;
    shown.first_sight = built.first_sight;
    shown.refinements = built.refinements;
    shown.rejected = built.rejected.size();
    shown.warnings = warnings;
    add_page(files, map_page(shown, subject_of(options.recordings, options.model)), options.page);
  }
  write_files(files);
  progress.end();
  print_result(built, adjusted, options, judged_too, judged, warnings);
}

}  // namespace

void setup_build(CLI::App& app) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App* command = app.add_subcommand(
      "build", "Build a landmark map from recordings (several folders: several sessions)");
  command->add_option("RECORDING", options->recordings, "Folders of CSV files, one per session")
      ->required()
      ->type_name("DIR");
  command->add_option("--model", options->model, "The robot and its noise (TOML)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "--method", options->method,
          "How the map is made: leg by leg, or by an adjustment of all measurements at once")
      ->check(CLI::IsMember({"elastic", "elastic-printed", "gauss-markov", "adjustment"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "Write the map (.graphml, .g2o, .geojson or .dot)")
      ->type_name("FILE");
  command->add_option("--json", options->json_file, "Write every figure as JSON")
      ->type_name("FILE");
  command->add_option("--svg", options->svg, "Write a picture of the map before and after (SVG)")
      ->type_name("FILE");
  add_html_option(*command, options->page);
  add_plots_option(*command, options->page);
  command
      ->add_option(
          "--eta", options->eta,
          "How many landmarks a refinement of the elastic methods may move: a number, all, "
          "or auto")
      ->type_name("N|all|auto")
      ->check(eta_text())
      ->capture_default_str();
  command
      ->add_option("--min-drive", options->min_drive,
                   "Shortest driven path between a leg's ends [m]")
      ->check(zero_or_more())
      ->capture_default_str();
  command
      ->add_option(
          "--gate", options->gate,
          fmt::format("Leave sightings out that contradict the map by more standard deviations "
                      "than this; by default {:g}, of the sighting, the reckoning and the "
                      "map jointly, with --method adjustment {:g}, of the sighting alone",
                      kMapGate, kAdjustmentGate))
      ->check(above_zero());
  command->callback([options] { run_build(*options); });
}

}  // namespace trussmap::app
