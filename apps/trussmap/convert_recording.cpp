// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "convert_recording.hpp"

#include "bag_output.hpp"
#include "option_checks.hpp"
#include "private_folder.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

/// The model that is given, else the one beside the recording.
Model model_for(const fs::path& folder, const std::string& given) {
  if (!given.empty()) return read_model(given);
  const fs::path beside = folder / "model.toml";
  if (fs::exists(beside)) return read_model(beside);
  fmt::print("{}", warning_text("no model.toml in " + folder.string() +
                                ": dead reckoned by a wheelbase of 0.34 m and default noise; "
                                "--model says which"));
  return {};
}

/// That the bag with its map gives a recording again, where it has what ties a drive to a place: a
/// bag has no loops.
void require_readable_bag(const fs::path& in, const Recording& recording, const Bag& bag) {
  if (recording.sightings.empty() && recording.fixes.empty() && recording.truth.empty()) return;
  const PrivateFolder folder;
  const fs::path file = folder.path() / "bag.mcap";
  const fs::path map = folder.path() / "map.toml";
  write_files({{file, bag.bytes}, {map, bag.map}});
  try {
    const LogRecording back = read_log_recording(file, map);
    static_cast<void>(
        recording_folder("", back.recording, "", {{"model.toml", format_model(back.model)}}));
  } catch (const InputError& error) {
    throw InputError(
        in.string(), 0,
        "makes a bag that could not be read again: " + folder.without_it(error.what()));
  }
}

}  // namespace

void add_convert_recording(const Command& command, ConvertRecordingOptions& options) {
  command
      .add_option("--model", options.model,
                  "Of a recording to a bag: the robot and its noise (TOML), for /odom and "
                  "covariances; the folder's model.toml if left out")
      .type_name("FILE");
  command
      .add_option("--wheel-radius", options.wheel_radius,
                  "Of a recording to a bag: radius of the wheels [m]; /joint_states has travel / "
                  "radius")
      .check(above_zero())
      .capture_default_str();
  add_epoch(command, options.epoch, "Of a recording to a bag: ");
}

bool is_recording_to_bag(const fs::path& in, const fs::path& out) {
  return out.extension() == ".mcap" && fs::exists(in / "drive.csv");
}

void convert_recording(const fs::path& in, const fs::path& out, const fs::path& map,
                       const ConvertRecordingOptions& options) {
  const Recording recording = read_recording(in);
  BagOptions how;
  how.wheel_radius = options.wheel_radius;
  how.epoch = epoch_of(options.epoch);
  const Bag bag = format_recording_bag(recording, model_for(in, options.model), how);
  require_readable_bag(in, recording, bag);
  NamedContents files{{out, bag.bytes}};
  if (!map.empty()) {
    files.emplace_back(map, "# Reads " + out.filename().string() + " back.\n\n" + bag.map);
  }
  write_files(files);
  fmt::print("converted: the recording {} to the bag {}\n\n", in.string(), out.string());
  print_bag(bag);
  if (map.empty()) {
    fmt::print("\nTo read it back, write its map.toml as well: --map FILE\n");
  } else {
    fmt::print("\nRead it back: trussmap convert {} FOLDER --map {}\n", out.string(), map.string());
  }
  fmt::print("Look at it: Foxglove, or ros2 bag play {}\n", out.string());
}

}  // namespace trussmap::app
