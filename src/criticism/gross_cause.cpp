// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/gross_cause.hpp"

#include "criticism/candidates.hpp"
#include "criticism/effect_strength.hpp"
#include "criticism/fewest_constants.hpp"
#include "criticism/refits.hpp"
#include "criticism/score_test.hpp"
#include "criticism/small_causes.hpp"
#include "effects/steering.hpp"
#include "fit/fit_state.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostMeasurements = 20000;

bool moves_ahead(Channel channel) {
  return channel == Channel::travel || channel == Channel::advance || channel == Channel::wheels ||
         channel == Channel::sideways;
}

bool acts_on_drive(Channel channel) {
  return moves_ahead(channel) || channel == Channel::turn || channel == Channel::rotate ||
         channel == Channel::difference || channel == Channel::drift ||
         wheel_of(channel).has_value() || effects::is_of_steered_drive(channel);
}

/// Without coefficients.
std::vector<Effect> causes_for(const ModelFit& given, const ScoreTest& tests, bool scale) {
  const fitting::FitState& fit = *given.state;
  const bool gyro = odometry::has_gyro(fit.recordings);
  std::vector<Effect> result;
  for (const Candidate& one : candidates_for(fit, tests.context())) {
    const effects::CatalogueRecord* record = record_of(one);
    const Channel channel = one.effect.channel;
    if (record == nullptr || !one.family.empty() || record->entry.of_covariate()) continue;
    if (!acts_on_drive(channel)) continue;
    if (gyro && channel == Channel::drift) continue;  // its bias is what drifts
    if (moves_ahead(channel) && !scale) continue;
    if (!tests.is_present(one.effect)) result.push_back(one.effect);
  }
  return result;
}

/// Nothing where it cannot be fitted, or leaves much. Without a gate: far from the best fit what is
/// right contradicts all others.
std::optional<ModelFit> fitted_alone(const std::vector<DrivenRecording>& recordings,
                                     const ModelFit& given, const Effect& effect) {
  Model model = given.model;
  model.effects.push_back(effect);
  FitOptions open = given.options;
  open.gate.reset();
  const auto found = if_possible<ModelFit>([&] { return fit_model(recordings, model, open); });
  if (!found || found->chi2 > kLittleLeft * std::max(1, found->dof)) return std::nullopt;
  if (!found->effects.back().not_fitted.empty()) return std::nullopt;
  return if_possible<ModelFit>([&] { return fit_model(recordings, found->model, given.options); });
}

/// From nothing, then from a quarter more and less of the motion: a fit from nothing may be lost.
std::optional<ModelFit> fitted_from_starts(const std::vector<DrivenRecording>& recordings,
                                           const ModelFit& given, const ScoreTest& tests,
                                           Effect effect) {
  constexpr double kStart = 0.25;
  std::optional<ModelFit> fit = fitted_alone(recordings, given, effect);
  const bool gain = effect.channel == Channel::turn || effect.channel == Channel::travel;
  if (fit || !gain || effect.shape.size() != 1) return fit;
  const std::vector<double> largest = tests.test({effect}).front().largest;
  if (largest.empty() || !(largest.front() > 0.0)) return fit;
  for (const double start : {kStart, -kStart}) {
    effect.coefficients = {start / largest.front()};
    if (fit = fitted_alone(recordings, given, effect); fit) return fit;
  }
  return fit;
}

/// A factor of -1: wheels exchanged, one that counts backwards, all of them.
std::vector<Effect> wrong_signs(const Robot& robot) {
  constexpr double kOther = -2.0;
  std::vector<Effect> result{catalogue_effect("wheelbase", {kOther})};
  if (robot.drive == DriveKind::differential) {
    result.push_back(wheel_of_other_size(Channel::left, kOther));
    result.push_back(wheel_of_other_size(Channel::right, kOther));
  }
  result.push_back(catalogue_effect("wheel scale", {kOther}));
  return result;
}

/// What the rest does not show is no error of the drive: a compass that a building turns.
bool is_of_compass_alone(std::vector<DrivenRecording> recordings, const ModelFit& given) {
  constexpr int kFewest = 50;      // dof that would show it
  constexpr double kShare = 0.25;  // of those with a compass
  if (std::ranges::none_of(recordings, [](const auto& one) { return one.drive.has_compass(); })) {
    return false;
  }
  for (DrivenRecording& one : recordings) one.drive.heading.clear();
  const auto rest =
      if_possible<ModelFit>([&] { return fit_model(recordings, given.model, given.options); });
  return rest && rest->dof > std::max<double>(kFewest, kShare * given.dof) &&
         rest->chi2 < kLittleLeft * rest->dof;
}

double cost_of(const ModelFit& fit) {
  constexpr double kPerCoefficient = 4.0;  // of chi^2
  const Effect& effect = fit.model.effects.back();
  return chi2_of_all(fit) + kPerCoefficient * static_cast<double>(effect.shape.size());
}

}  // namespace

std::optional<ModelFit> gross_cause(const std::vector<DrivenRecording>& recordings,
                                    const ModelFit& given, bool scale) {
  const fitting::FitState& state = *given.state;
  if (given.chi2 < kGrossMisfit * std::max(1, given.dof)) return std::nullopt;
  if (state.problem.measurements.size() > kMostMeasurements) return std::nullopt;
  if (is_of_compass_alone(recordings, given)) return std::nullopt;
  const ScoreTest tests(state);
  for (const Effect& wrong : wrong_signs(given.model.robot)) {
    if (tests.is_present(wrong)) continue;
    // Nothing else does what it does.
    if (std::optional<ModelFit> fit = fitted_alone(recordings, given, wrong)) return fit;
  }
  std::optional<ModelFit> best;
  for (const Effect& cause : causes_for(given, tests, scale)) {
    std::optional<ModelFit> fit = fitted_from_starts(recordings, given, tests, cause);
    if (fit && (!best || cost_of(*fit) < cost_of(*best))) best = std::move(fit);
  }
  return best;
}

}  // namespace trussmap::criticism
