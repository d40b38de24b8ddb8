// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap apply: where the robot was, by a model.
#include "bag_output.hpp"
#include "commands.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "terminal.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"
#include "trussmap/write_files.hpp"

#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct ApplyCommand {
  std::string recording;
  ModelRecordingsOptions input;
  std::string out;
  std::string tum;
  std::string kitti;
  std::string mcap;
  std::optional<double> epoch;
  bool adjusted = false;
};

std::vector<TimedPose> adjusted(const Session& session) {
  FitOptions how = session.options.fit;
  how.fit_effects = false;
  const ModelFit fit = fit_model(session.rows.recordings, session.model, how);
  for (const std::string& warning : fit.warnings) fmt::print("{}", warning_text(warning));
  for (const std::string& one : fit.left_out) fmt::print("left out: {}\n", one);
  return adjusted_poses(fit);
}

void run_apply(ApplyCommand options) {
  if (options.out.empty() && options.tum.empty() && options.kitti.empty() && options.mcap.empty()) {
    throw UsageError("apply: nothing to write, expected --out, --tum, --kitti or --mcap");
  }
  if (options.epoch && options.mcap.empty()) throw UsageError("apply: --epoch goes with --mcap");
  options.input.recordings = {options.recording};
  const Session session = read_session(options.input, true);
  for (const std::string& one : unfitted_in_words(session.model)) {
    fmt::print("{}", warning_text(one));
  }
  const std::vector<TimedPose> poses =
      options.adjusted ? adjusted(session)
                       : dead_reckoned_poses(session.rows.recordings.front(), session.model);
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, std::string text) {
    if (name.empty()) return;
    files.emplace_back(name, std::move(text));
    names.push_back(name);
  };
  add(options.out, format_poses(poses));
  add(options.tum, format_tum(poses));
  add(options.kitti, format_kitti(poses));
  std::int64_t epoch = 0;
  if (!options.mcap.empty()) {
    BagOptions how;
    how.epoch = epoch_of(options.epoch);
    Bag bag = format_odometry_bag(poses, options.adjusted, how);
    add(options.mcap, std::move(bag.bytes));
    epoch = bag.epoch;
  }
  write_files(files);
  fmt::print("{}", poses_text(poses, options.adjusted));
  fmt::print("written: {}\n", fmt::join(names, ", "));
  print_epoch(epoch);
  if (!options.adjusted) {
    fmt::print("{}", lasting_noise_text(session.model.noise, style_of(stdout)));
  }
}

}  // namespace

void setup_apply(const Command& app) {
  auto options = std::make_shared<ApplyCommand>();
  options->input.gate = kAdjustmentGate;
  options->input.every = 0.0;
  const Command command = app.add_subcommand(
      "apply", "Write where the robot was, by a model: dead reckoned or adjusted poses");
  command.add_option("RECORDING", options->recording, "Folder with drive.csv")
      .required()
      .type_name("");
  command
      .add_option("--model", options->input.model,
                  "Model (TOML), with the coefficients of its effects")
      .type_name("FILE")
      .required();
  command.add_option("--out", options->out, "Write t,x,y,heading and covariances (CSV)")
      .type_name("FILE");
  command.add_option("--tum", options->tum, "Write the same as a TUM trajectory").type_name("FILE");
  command
      .add_option("--kitti", options->kitti,
                  "Write the same as a KITTI trajectory: no times, axes as ours (x ahead, z up)")
      .type_name("FILE");
  command
      .add_option("--mcap", options->mcap,
                  "Write the same as a bag for ROS 2 and Foxglove: /odometry/corrected "
                  "(nav_msgs/Odometry)")
      .type_name("FILE");
  add_epoch(command, options->epoch, "With --mcap: ");
  command.add_flag("--adjusted", options->adjusted,
                   "By everything that was measured, in the map's frame, instead of dead reckoned");
  command
      .add_option("--without", options->input.without,
                  "With --adjusted: do not use the survey, the truth, fixes, or loops")
      .delimiter(',')
      .check(one_of({"survey", "truth", "fixes", "loops"}))
      .type_name("WHAT,...");
  command
      .add_option("--gate", options->input.gate,
                  "With --adjusted: sightings, fixes and loops that the others contradict by more "
                  "standard deviations are left out (0: none)")
      .check(zero_or_more())
      .capture_default_str();
  command.footer(
      "One pose at the start of the drive and one at the end of every row. Dead reckoned: by the\n"
      "wheels, the compass and the model's effects alone, in the axes of the robot as it starts.");
  command.callback([options] { run_apply(*options); });
}

}  // namespace trussmap::app
