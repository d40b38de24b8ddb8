// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/effect_columns.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"

#include <stdexcept>

namespace trussmap {

Model read_model(const std::filesystem::path& file, const std::vector<Recording>& recordings) {
  Model model = read_model(file);
  if (model.effects.empty()) return model;
  std::vector<fitting::SessionPath> paths;
  paths.reserve(recordings.size());
  std::vector<DrivenRecording> driven;
  driven.reserve(recordings.size());
  for (const Recording& recording : recordings) {
    driven.push_back(with_wheels(recording, model.robot));
    paths.push_back({Pose(), dead_reckoned_path(driven.back().drive, model.robot, model.noise)});
  }
  const fitting::ShapeContext context(driven, model.robot, paths);
  // One effect after the other, so that the one at fault is known by its line.
  for (const Effect& effect : model.effects) {
    try {
      static_cast<void>(fitting::effect_columns({effect}, context));
    } catch (const std::invalid_argument& error) {
      throw InputError(file.string(), effect.line, error.what());
    }
  }
  return model;
}

}  // namespace trussmap
