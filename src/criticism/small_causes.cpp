// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/small_causes.hpp"

#include "criticism/calibrated_start.hpp"
#include "criticism/candidates.hpp"
#include "criticism/effect_strength.hpp"
#include "criticism/refits.hpp"
#include "criticism/response.hpp"
#include "criticism/score_test.hpp"
#include "criticism/tested_candidate.hpp"
#include "drive/steered_motion.hpp"
#include "effects/channel_record.hpp"
#include "fit/fit_state.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr double kSmallShare = 0.05;  // of the motion
constexpr std::size_t kFew = 3;
constexpr double kWorthwhile = 0.5;  // of what noise does not explain
constexpr int kManyDof = 50;         // fewer tell of constants alone

/// By what a test estimates.
bool is_small(const Effect& effect, const fitting::ShapeContext& context) {
  if (effect.is_constant() && is_far_place(effect.channel, effect.coefficients.front())) {
    return false;
  }
  const effects::ChannelRecord& record = effects::record_of(effect.channel);
  if (record.wheel_pattern == nullptr || record.reading) return true;
  const EffectRange g = range_of(effect, context);
  return std::max(-g.least, g.most) < kSmallShare;
}

/// As a fit of the right model does: what leaves more is perhaps the trace of another error.
bool leaves_nothing(double chi2, int dof) {
  constexpr double kChance = 1e-3;
  return statistics::chi2_p_value(chi2, dof) > kChance;
}

bool leaves_little(double chi2, int dof) {
  return chi2 < kLittleLeft * std::max(1, dof);
}

struct FewCauses {
  std::vector<Effect> effects;
  bool small = true;
};

/// Those that promise to leave little, each found beside the ones before it; none where no few do.
FewCauses promising_causes(const ModelFit& given) {
  ScoreTest tests(*given.state);
  std::vector<Candidate> candidates = candidates_for(*given.state, tests.context());
  std::erase_if(candidates, [](const Candidate& one) { return !one.family.empty(); });
  FewCauses result;
  double left = given.chi2;
  while (!leaves_nothing(left, given.dof) && result.small && result.effects.size() < kFew) {
    Effect best;
    double most = 0.0;
    visit_scores(tests, candidates, Resolution::quick, [&](std::size_t k, const Score& score) {
      if (score.score <= most) return;
      most = score.score;
      best = candidates[k].effect;
      best.coefficients = score.coefficients;
    });
    // One more that takes little of what is left is not its cause.
    if (most < kWorthwhile * (left - given.dof)) break;
    const bool small = is_small(best, tests.context());
    if (!small && !result.effects.empty()) break;  // large ones together say nothing
    if (!small && best.is_constant()) break;       // it may have better words
    result.small = small;
    left -= most;
    best.coefficients.clear();
    tests.condition_on(tests.columns(best));
    result.effects.push_back(std::move(best));
  }
  if (!leaves_little(left, given.dof)) result.effects.clear();
  return result;
}

}  // namespace

ExplainedBy explained_by(const std::vector<DrivenRecording>& recordings, const ModelFit& given) {
  // Where a steered robot's wheels are looks like a lever arm.
  const bool steers = drive::has_steering(given.model.robot);
  if (steers || given.dof < kManyDof) return ExplainedBy::nothing_small;
  const FewCauses causes = promising_causes(given);
  if (causes.effects.empty()) return ExplainedBy::nothing_small;
  const std::optional<ModelFit> fit = if_fitted_with(recordings, given, causes.effects);
  if (!fit || !leaves_little(chi2_of_all(*fit), fit->dof)) return ExplainedBy::nothing_small;
  const bool all = causes.small && leaves_nothing(chi2_of_all(*fit), fit->dof);
  return all ? ExplainedBy::small_ones : ExplainedBy::few;
}

}  // namespace trussmap::criticism
