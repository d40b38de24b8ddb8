// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Diagnose, add, fit, and again, while that is justified.
//
//   diagnose --> winner and its look-alikes, each fitted --> the best of them is added
//      ^                                                          |
//      '---- earlier effects: places and thresholds sought anew, <'
//            those that are no longer significant dropped
//
// Among look-alikes chi^2 decides where it can, else the error of held-out legs, else the order of
// the diagnosis. Every step's held-out figures are over the same legs.
#pragma once

#include "criticism/diagnosis.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// One line of the error ladder.
struct DiscoveryStep {
  std::optional<Effect> added;  ///< none: the model given
  std::vector<std::string> dropped;
  double chi2 = 0.0;
  int dof = 0;
  HeldOut held_out;
  double predicted_chi2 = 0.0;  ///< decrease that the diagnosis promised
  HeldOutMetrics predicted;     ///< held-out figures that it promised
  std::vector<LookAlike> look_alikes;
};

struct Discovery {
  std::vector<DiscoveryStep> steps;  ///< the first is the model given
  ModelFit fit;                      ///< of the model found
  std::string stopped;               ///< why
  bool consistent = true;
  Diagnosis first;  ///< of the model given
  Diagnosis last;   ///< of the model found
};

struct DiscoveryOptions {
  DiagnosisOptions diagnosis;
  std::size_t most_effects = 6;
  /// Told before each part of the work.
  std::function<void(const std::string&)> progress = {};
};

/// Throws like fit_model.
[[nodiscard]] Discovery discover(const std::vector<Recording>& recordings, const Model& model,
                                 const DiscoveryOptions& options = {});

}  // namespace trussmap
