// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Findings and their look-alikes, each added to the model and fitted: which of them is taken, and
// whether it predicts and reckons as well as the model before.
#pragma once

#include "criticism/candidates.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/held_out.hpp"
#include "validation/dead_reckoned_horizons.hpp"
#include "validation/held_out_legs.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace trussmap::criticism {

inline constexpr double kDecisive = 6.0;      ///< of chi^2
inline constexpr double kNoWorse = 1.05;      ///< of the error before
inline constexpr double kBeyondChance = 1.5;  ///< standard errors

/// A finding, added and fitted.
struct Trial {
  Candidate candidate;
  ModelFit fit;
  std::optional<HeldOut> held_out = std::nullopt;  ///< once asked for; no legs where untold
  std::shared_ptr<const validation::HeldOutLegs> legs = nullptr;
};

/// The winner and those of its look-alikes that explain nearly as much, by their place among the
/// findings.
[[nodiscard]] std::vector<std::size_t> contenders(const std::vector<Finding>& findings,
                                                  std::size_t at);

[[nodiscard]] bool was_fitted(const ModelFit& fit);

/// Of the trial that is taken: the winner's look-alikes, itself among them where another is
/// taken. Those that were tried are as far behind as their fits are.
[[nodiscard]] std::vector<LookAlike> rivals_of(const std::vector<Trial>& trials, std::size_t taken,
                                               const Finding& winner);

/// Than before, of the held-out legs, and beyond what chance makes of so few.
[[nodiscard]] bool predicts_worse(const HeldOut& before, Trial& trial,
                                  const std::vector<DrivenRecording>& recordings,
                                  const LegOptions& legs);

/// chi^2 decides where it can, else held-out legs where they do beyond chance, else the order of
/// the diagnosis.
[[nodiscard]] std::size_t best_of(std::vector<Trial>& trials,
                                  const std::vector<DrivenRecording>& recordings,
                                  const LegOptions& legs);

}  // namespace trussmap::criticism
