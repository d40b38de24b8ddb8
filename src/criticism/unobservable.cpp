// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/unobservable.hpp"

#include "fit/fit_state.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {

bool hidden_by_misfit(const Tested& one) {
  const double prior_sd =
      facts_of(one.candidate.effect.channel).prior_sd * fitting::kLargestUncertainty;
  for (std::size_t k = 0; k < one.score.share.size(); ++k) {
    if (one.score.largest[k] > 0.0 && one.score.share[k] > fitting::kLeastShare &&
        one.score.largest[k] < prior_sd * std::sqrt(one.score.information[k])) {
      return true;
    }
  }
  return false;
}

Unobservable why_unobservable(const Tested& one, const estimation::RecordingProblem& problem) {
  const auto& measurements = problem.measurements;
  Unobservable result{one.candidate.effect};
  result.positions =
      std::any_of(measurements.begin(), measurements.end(), estimation::is_in_map_frame);
  const Score& score = one.score;
  const bool never = std::all_of(score.largest.begin(), score.largest.end(),
                                 [](double most) { return most == 0.0; });
  const bool nothing = std::all_of(score.share.begin(), score.share.end(),
                                   [](double share) { return share < fitting::kLeastShare; });
  result.why = never                          ? Unseen::never_happens
               : nothing && !result.positions ? Unseen::in_the_map
               : nothing                      ? Unseen::absorbed
                                              : Unseen::too_small;
  return result;
}

}  // namespace trussmap::criticism
