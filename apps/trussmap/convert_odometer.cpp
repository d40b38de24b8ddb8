// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "convert_odometer.hpp"

#include "option_checks.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

/// What goes along with a recording: its model, where it has one.
NamedTexts model_beside(const fs::path& folder) {
  const fs::path file = folder / "model.toml";
  if (!fs::exists(file)) return {};
  return {{"model.toml", format_model(read_model(file))}};
}

}  // namespace

void add_convert_odometer(const Command& command, ConvertOdometerOptions& options) {
  command
      .add_option("--second-odometer", options.second,
                  "IN is a recording's folder, and DIR has drive.csv and model.toml of another "
                  "odometer on the same robot (encoder wheels that drive nothing, a camera's "
                  "odometry as wheels): OUT is IN with its motions as loops.csv, for calibrate")
      .type_name("DIR");
  command
      .add_option("--every", options.every,
                  "Of a second odometer: how long each of its motions lasts at least [s]")
      .check(above_zero())
      .capture_default_str();
}

void convert_odometer(const fs::path& in, const fs::path& out,
                      const ConvertOdometerOptions& options) {
  const fs::path second = options.second;
  if (!fs::exists(second / "model.toml")) {
    throw InputError((second / "model.toml").string(), 0,
                     "is missing, expected the second odometer's wheelbase and noise there");
  }
  Recording recording = read_recording(in, true);
  const std::size_t before = recording.loops.size();
  try {
    const std::vector<Loop> motions =
        second_odometer_loops(read_recording(second, true), read_model(second / "model.toml"),
                              recording.drive, options.every);
    recording.loops.insert(recording.loops.end(), motions.begin(), motions.end());
  } catch (const std::invalid_argument& error) {
    throw InputError((second / "drive.csv").string(), 0, error.what());
  }
  write_recording(out, recording, "with the motions of the second odometer " + second.string(),
                  model_beside(in));
  fmt::print("converted: {} with the second odometer {} to the recording {}\n\n", in.string(),
             second.string(), out.string());
  fmt::print("  {:>7} motions of {} s and more in loops.csv\n", recording.loops.size() - before,
             options.every);
  if (before > 0) fmt::print("  {:>7} loops were there before\n", before);
}

}  // namespace trussmap::app
