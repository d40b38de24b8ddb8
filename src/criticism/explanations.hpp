// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which sets of effects explain the legs about equally well, and how likely each effect is among
// what is missing (Explanations, trussmap/diagnose.hpp).
//
// Sets differ by their classes of look-alikes: the probability of one is the sum over members.
// Where fits tell a finding from its look-alikes (LookAlike::behind) that counts in place of what
// the tests make of them to first order.
#pragma once

#include "criticism/diagnosis.hpp"
#include "criticism/score_test.hpp"
#include "criticism/weighed_sets.hpp"
#include "trussmap/diagnose.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace trussmap::criticism {

/// One that is named missing.
struct NamedEffect {
  std::size_t tested = 0;  ///< place among all
  std::vector<LookAlike> look_alikes;
  Effect effect;           ///< as estimated beside the others
  std::vector<double> sd;  ///< of its coefficients
};

/// What speaks besides the tested candidates for being weighed: products of what the findings'
/// channels go with, and of what is carried with how fast it is driven and turned.
[[nodiscard]] std::vector<Tested> interactions(const std::vector<Tested>& tested,
                                               const std::vector<NamedEffect>& named,
                                               const fitting::FitState& fit,
                                               const ScoreTest& tests);

/// Of what the ground's tests leave; none where nothing is named.
[[nodiscard]] Explanations explanations_of(const std::vector<Tested>& tested,
                                           const std::vector<NamedEffect>& named,
                                           const SetGround& ground);

/// Gives a diagnosis its explanations, about the fit with what is missing where there is one: rows
/// are linear there; none where even with that chi^2 is thrice its degrees of freedom, for then the
/// larger effects come first. What may be part of an explanation is not called absent. `fit`:
/// without; `about`: the tests of the fit with it, or without where there is none.
void explain(Diagnosis& diagnosis, const SearchedEffects& searched, const ModelFit& fit,
             const std::optional<ModelFit>& with, const ScoreTest& about);

/// Effects that belong to every set, put before the others.
void put_before(Explanations& explanations, const std::vector<ExplainingEffect>& certain);

}  // namespace trussmap::criticism
