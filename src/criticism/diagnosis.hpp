// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A diagnosis (trussmap/diagnose.hpp) with what a further search needs of it.
#pragma once

#include "criticism/candidates.hpp"
#include "criticism/gross_constants.hpp"
#include "criticism/tested_candidate.hpp"
#include "trussmap/diagnose.hpp"
#include "validation/held_out_legs.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace trussmap::criticism {

/// What a search has asked of.
struct SearchedEffects {
  std::vector<Tested> tested;
  std::vector<std::size_t> missing;  ///< their places among these
  Eigen::MatrixXd events;            ///< projected columns of events that came first
};

struct DiagnosisRun {
  Diagnosis result;
  std::vector<Candidate> candidates;  ///< one per finding
  /// Constants that explain most, the first findings; all others are about the fit with them.
  std::optional<GrossConstants> gross;
  SearchedEffects searched;
};

/// Held-out legs that are worked out already, of the fit with this state.
struct KnownLegs {
  std::shared_ptr<const fitting::FitState> of = nullptr;
  std::shared_ptr<const validation::HeldOutLegs> legs = nullptr;
};

/// `stated`: the noise that the user's model has, which the fit's may differ from by now.
[[nodiscard]] DiagnosisRun run_diagnosis(const std::vector<DrivenRecording>& recordings,
                                         const ModelFit& fit, const Noise& stated,
                                         const DiagnoseOptions& options,
                                         const KnownLegs& known = {});

}  // namespace trussmap::criticism
