// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/constants_first.hpp"

#include "criticism/explanations.hpp"
#include "criticism/look_alikes.hpp"
#include "criticism/refits.hpp"
#include "drive/slow_covariates.hpp"
#include "trussmap/held_out.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace trussmap::criticism {

void put_constants_first(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                         GrossConstants constants, const DiagnoseOptions& options,
                         DiagnosisRun& run) {
  Diagnosis& result = run.result;
  ModelFit given = fit;
  if (result.under) {
    constants.fit = result.under->fit;
    const Noise& noise = constants.fit.model.noise;
    if (!(noise == fit.model.noise)) given = refit_under(recordings, fit, noise);
    result.under = std::make_shared<const FitWithNoise>(FitWithNoise{given, result.under->noise});
  }
  const bool others = result.verdict == Diagnosis::Verdict::missing;
  if (!others) {
    result.with_missing = validation::metrics_of(result.held_out);
  }
  // Beside legs that no model with the constants can be judged by there is nothing to compare with.
  if (!result.held_out.legs.empty()) {
    result.held_out = predict_held_out(recordings, given, options.legs);
  }
  std::vector<Finding> first = findings_of(recordings, given, constants, options.legs);
  result.verdict = Diagnosis::Verdict::missing;
  result.objection = Objection::none;
  result.missing = first.front().effect.name;
  result.p_value = first.front().p_adjusted;
  result.chi2 = given.chi2;
  result.dof = given.dof;
  result.coefficients = given.coefficients;
  result.next_drive.reset();
  if (const LookAlike* rival = closest_rival(first.front().look_alikes)) {
    result.next_drive = {first.front().effect, rival->effect, drive::slow_covariates(recordings)};
  }
  std::vector<Candidate> candidates;
  for (const Finding& one : first) {
    candidates.emplace_back();
    candidates.back().effect = one.effect;
  }
  std::erase_if(result.unobservable, [&first](const Unobservable& one) {
    return std::any_of(first.begin(), first.end(), [&one](const Finding& finding) {
      return find_among(one.effect, finding.look_alikes) != nullptr;  // that is said already
    });
  });
  std::vector<std::vector<LookAlike>> rivals;
  rivals.reserve(first.size());
  for (const Finding& one : first) rivals.push_back(one.look_alikes);
  for (Finding& other : result.findings) {
    if (other.status != Status::cannot_tell && other.status != Status::absent) continue;
    other.status = status_beside(other.effect, rivals).value_or(other.status);
  }
  std::vector<ExplainingEffect> certain;
  for (const Finding& one : first) {
    certain.push_back({one.effect, one.sd, {}});
    for (const LookAlike& rival : one.look_alikes) {
      if (!rival.told_apart()) certain.back().otherwise.push_back(rival.effect.name);
    }
  }
  // What else is missing may be too large for sets to be told.
  if (!others) result.explanations.sets.push_back({{}, 0.0, 1.0, 0.0, true});
  if (!result.explanations.sets.empty()) put_before(result.explanations, certain);
  result.findings.insert(result.findings.begin(), first.begin(), first.end());
  run.candidates.insert(run.candidates.begin(), candidates.begin(), candidates.end());
  run.gross = std::move(constants);
}

}  // namespace trussmap::criticism
