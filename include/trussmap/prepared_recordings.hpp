// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings as compare, fit, diagnose and discover take them: what of them counts as independent
// measurements.
//
//   recordings, model --prepare_recordings--> recordings, notes on what is left out and why
//
//   frames   where sightings come in dense frames, one frame in so long as their errors last
//            (lasting_errors, fit_model.hpp); of very many sightings, so few that they are kEnough,
//            or one frame in a second
//   survey   points that contradict a map made of such frames without the survey
//
// Both are of the model: an effect that it lacks makes errors last, and they no longer do once it
// is in. So they are judged again for a model with other effects (prepared_again); whoever judges
// the same model judges it by the same rows.
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/gate.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// The gate of gate.hpp, kModelGate, as long as few measurements are beyond it. `gate` in standard
/// deviations; 0: none.
[[nodiscard]] FitOptions gated_fit(double gate = kModelGate);

/// Sightings, of dense frames: of more, every fit takes longer, and the wheels between the frames
/// tell the rest.
inline constexpr std::size_t kEnough = 12000;

/// What of recordings' sightings a model is judged by.
struct UsedSightings {
  std::size_t used = 0;
  std::size_t all = 0;
  double every = 0.0;  ///< s, of which one frame is used; 0: all are

  [[nodiscard]] bool thinned() const { return used < all; }
};

struct PreparedRecordings {
  std::vector<DrivenRecording> recordings;
  std::vector<std::string> notes;  ///< what of the recordings is not used, and why
  UsedSightings sightings;
  /// What a model may use; nullptr where no model is asked what to use.
  std::shared_ptr<const std::vector<DrivenRecording>> whole = nullptr;
  std::size_t recorded = 0;  ///< sightings that there are
  double pace = 0.0;         ///< s, of which `whole` has one frame; 0: it has all
  FitOptions fit;            ///< by which that is judged

  /// Whether with another model there could be more than are used.
  [[nodiscard]] bool could_be_more() const;
};

/// Thinned out. `every`: s between frames of sightings; 0: all;
/// absent: as long as their errors are found to last, and few enough. Throws like fit_model.
[[nodiscard]] PreparedRecordings prepare_recordings(std::vector<DrivenRecording> recordings,
                                                    const Model& model, const FitOptions& fit,
                                                    std::optional<double> every = {});
[[nodiscard]] inline PreparedRecordings prepare_recordings(std::vector<Recording> recordings,
                                                           const Model& model,
                                                           const FitOptions& fit,
                                                           std::optional<double> every = {}) {
  return prepare_recordings(with_wheels(std::move(recordings), model.robot), model, fit, every);
}

/// The same recordings as another model of the same robot has them; where no model is asked, as
/// they are. Throws like fit_model.
[[nodiscard]] PreparedRecordings prepared_again(const PreparedRecordings& prepared,
                                                const Model& model);

/// Whether the same is used of both, which are of the same recordings.
[[nodiscard]] bool use_the_same(const PreparedRecordings& one, const PreparedRecordings& other);

}  // namespace trussmap
