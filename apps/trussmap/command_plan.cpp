// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap plan: the next drive, which decides what recordings leave open; the drive that accepts
// a new robot.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "progress.hpp"
#include "results/json.hpp"
#include "results/plans.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/session.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct PlanCommand {
  ModelRecordingsOptions input;
  AcceptanceOptions plan;
  std::string rivals;
  std::string map;
  std::string mesh;
  double spacing = 5.0;
  bool no_compass = false;
  std::string out;
};

/// Names between commas, those within brackets apart: "slippery patch (x=12, y=9, r=3)" is one.
std::vector<std::string> names_between_commas(const std::string& text) {
  std::vector<std::string> names(1);
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0) {
      names.emplace_back();
    } else if (c != ' ' || !names.back().empty()) {
      names.back() += c;
    }
  }
  for (std::string& name : names) {
    while (!name.empty() && name.back() == ' ') name.pop_back();
  }
  std::erase(names, "");
  return names;
}

/// waypoints.csv is asked for: waypoints.geojson goes beside it.
std::string geojson_of(const std::string& out) {
  return std::filesystem::path(out).replace_extension(".geojson").string();
}

/// A mesh's landmarks and routes as a map of the model's survey.
LandmarkGraph map_of(const Mesh& mesh) {
  LandmarkGraph map;
  for (int k = 0; k < mesh.landmarks(); ++k) {
    map.add_landmark(landmark_name(mesh, k), mesh.positions[static_cast<std::size_t>(k)]);
  }
  for (const MeshRoute& one : mesh.routes) map.add_route(one.from, one.to);
  return map;
}

LandmarkGraph map_asked_for(const PlanCommand& options) {
  if (!options.map.empty()) return read_map(options.map);
  return map_of(even_mesh(parse_mesh_size(options.mesh), options.spacing));
}

Model model_asked_for(const std::string& file) {
  if (!file.empty()) return read_model(file);
  Model model;
  model.robot = usual_robot(DriveKind::differential);
  return model;
}

PlannedDrive acceptance_drive(const PlanCommand& options) {
  const Model model = model_asked_for(options.input.model);
  try {
    return plan_acceptance(map_asked_for(options), model, options.plan);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("plan: {}", error.what()));
  }
}

struct Planned {
  PlannedDrive drive;
  std::vector<std::string> notes;
};

Planned deciding_drive(const PlanCommand& options) {
  std::vector<Stage> stages = diagnose_stages();
  stages.push_back({"planning the drive", 40});
  Progress progress(stages);
  progress.next();
  Session session = read_session(options.input);
  const DiagnosisReport report = diagnose(session, [&progress] { progress.next(); });
  progress.next();
  try {
    Planned planned{plan_drive(report.found, options.plan), session.rows.notes};
    progress.end();
    return planned;
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("plan: {}", error.what()));
  }
}

void check_input(const PlanCommand& options) {
  const bool recorded = !options.input.recordings.empty();
  const int ways =
      (recorded ? 1 : 0) + (options.map.empty() ? 0 : 1) + (options.mesh.empty() ? 0 : 1);
  if (ways != 1) {
    throw UsageError(
        "plan: expected either recordings, of which the drive is to decide what they leave open, "
        "or --map or --mesh, on which a new robot is to be accepted");
  }
  if (recorded && options.input.model.empty()) {
    throw UsageError("plan: --model is required with recordings");
  }
  if (!recorded && !options.rivals.empty()) {
    throw UsageError("plan: --rivals are of recordings, expected one");
  }
}

void run_plan(PlanCommand& options) {
  check_input(options);
  options.plan.compass = !options.no_compass;
  options.plan.rivals = names_between_commas(options.rivals);
  const bool recorded = !options.input.recordings.empty();
  const Planned planned =
      recorded ? deciding_drive(options) : Planned{acceptance_drive(options), {}};
  const bool drives = !planned.drive.plan.waypoints.empty();
  NamedContents files;
  std::string written;
  if (!options.out.empty() && drives) {
    files.emplace_back(options.out, format_plan(planned.drive.plan));
    files.emplace_back(geojson_of(options.out), format_plan_geojson(planned.drive.plan));
    written = options.out + " and " + geojson_of(options.out);
  }
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json,
                       results::json_text(results::PlanReport{&planned.drive, &planned.notes}));
  }
  write_files(files);
  fmt::print("{}{}", plan_text(planned.drive, written, style_of(stdout)),
             notes_text(planned.notes));
  if (!planned.drive.enough) throw AnswerIsNo();
}

void add_plan_options(const Command& command, PlanCommand& options) {
  command
      .add_option("--rivals", options.rivals,
                  "Effects between which to decide, by name with commas between; without it what "
                  "the diagnosis of the recordings leaves open")
      .type_name("NAME,...");
  command
      .add_option("--max-speed", options.plan.max_speed,
                  "Highest speed [m/s]; else as fast as was driven, of a new robot 0.9")
      .check(above_zero());
  command.add_option("--time", options.plan.most_time, "Longest drive [s]")
      .check(above_zero())
      .capture_default_str();
  command.add_option("--length", options.plan.most_length, "Longest drive [m]")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option("--power", options.plan.power,
                  "Wished chance that the drive decides, or shows what is there")
      .check(between(0.5, 0.9999))
      .capture_default_str();
  command
      .add_option("--false-alarm", options.plan.level,
                  "Chance that it decides for what is wrong, or shows what is not there")
      .check(between(1e-6, 0.5))
      .capture_default_str();
  command
      .add_option("--start", options.plan.start,
                  "Landmark at which the drive begins; else where the last recording ended")
      .type_name("NAME");
}

void add_new_robot_options(const Command& command, PlanCommand& options) {
  command
      .add_option("--map", options.map,
                  "Map on whose routes a new robot is to be accepted (.graphml, .g2o), in place of "
                  "recordings")
      .type_name("FILE");
  command
      .add_option("--mesh", options.mesh,
                  "The same on a mesh of landmarks, along x and along y, like 4x4")
      .type_name("NxN");
  command.add_option("--spacing", options.spacing, "Distance between neighbours of the mesh [m]")
      .check(above_zero())
      .capture_default_str();
  command.add_flag("--no-compass", options.no_compass, "The new robot has no compass");
  command.add_flag("--gyro", options.plan.gyro, "The new robot has a gyro");
  command
      .add_option("--size", options.plan.size,
                  "Practical size of an effect, times what the catalogue calls detectable")
      .check(above_zero())
      .capture_default_str();
}

}  // namespace

void setup_plan(const Command& app) {
  auto options = std::make_shared<PlanCommand>();
  const Command command = app.add_subcommand(
      "plan",
      "Plan the next drive: the tour that decides between effects which recordings cannot tell "
      "apart, or that shows every effect of a new robot");
  add_model_recordings(command, options->input, false);
  add_plan_options(command, *options);
  add_new_robot_options(command, *options);
  command
      .add_option("--out", options->out,
                  "Write the waypoints (CSV), which simulate --plan drives, and beside them the "
                  "same as GeoJSON")
      .type_name("FILE");
  command.footer(
      "A drive goes from landmark to landmark by routes that were driven: at one of three speeds,\n"
      "bending or not, with whole turns on the spot either way, with rests, and with the loads\n"
      "that were driven, as far as these tell the rivals apart. Exit status 1: no drive within\n"
      "the limits has the wished power.");
  command.callback([options] { run_plan(*options); });
}

}  // namespace trussmap::app
