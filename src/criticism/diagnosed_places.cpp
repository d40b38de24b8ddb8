// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/diagnosed_places.hpp"

#include "criticism/driven_variables.hpp"
#include "criticism/place_fields.hpp"
#include "criticism/place_scores.hpp"
#include "criticism/refits.hpp"
#include "fit/fit_state.hpp"

#include <algorithm>
#include <utility>

namespace trussmap::criticism {
namespace {

/// What is missing, as a field would meet it.
struct MissingByPlace {
  std::vector<Effect> others;   ///< that no field can be
  std::vector<Effect> patches;  ///< what few numbers say: a circle, an edge, a wave
  bool curves = false;          ///< what is a field but by name
};

MissingByPlace missing_by_place(const Diagnosis& result) {
  constexpr std::size_t kFew = 2;
  MissingByPlace found;
  for (const Finding& one : result.findings) {
    if (one.joint.empty()) continue;
    Effect effect = one.effect;
    effect.coefficients.clear();
    if (!goes_with_only(effect, {"x", "y"})) {
      found.others.push_back(std::move(effect));
    } else if (effect.shape.size() <= kFew && !effect.per_session) {
      found.patches.push_back(std::move(effect));
    } else {
      found.curves = true;
    }
  }
  return found;
}

std::vector<FieldOfPlaces> fields_of(const fitting::FitState& fit, const ScoreTest& tests,
                                     const std::vector<Effect>& patches, double level) {
  const auto scores = place_scores(fit, tests, patches);
  return scores ? place_fields(*scores, level) : std::vector<FieldOfPlaces>();
}

}  // namespace

void tell_places(const std::vector<DrivenRecording>& recordings, const ModelFit& stated,
                 const ModelFit& fit, const std::optional<ModelFit>& with, const ScoreTest& about,
                 Diagnosis& result) {
  const double level = std::min(kFieldLevel, result.level);
  const MissingByPlace missing = missing_by_place(result);
  const bool by_place = missing.curves || !missing.patches.empty();
  std::optional<ModelFit> between;  // with what no field can be
  if (by_place && !missing.others.empty()) {
    between = if_fitted_with(recordings, fit, missing.others);
    if (!between) return;
  }
  const ModelFit& beside_all = with ? *with : fit;
  const auto fields = [&](const ModelFit& one) {
    return fields_of(*one.state, &one == &beside_all ? about : ScoreTest(*one.state),
                     missing.patches, level);
  };
  result.places = fields(between ? *between : by_place ? fit : beside_all);
  if (!result.places.empty() && missing.others.empty() &&
      !(stated.model.noise == fit.model.noise)) {
    for (FieldOfPlaces& plain : fields(stated)) {
      const auto same = std::ranges::find(result.places, plain.channel, &FieldOfPlaces::channel);
      if (same != result.places.end()) *same = std::move(plain);
    }
  }
  const bool field = std::ranges::any_of(result.places, &FieldOfPlaces::is_field);
  if (!field || result.verdict != Diagnosis::Verdict::nothing_missing) return;
  result.verdict = Diagnosis::Verdict::unexplained_misfit;
  result.objection = Objection::place;
}

}  // namespace trussmap::criticism
