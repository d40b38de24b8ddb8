// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A factor of the drive that is sought from nothing, and is large: about the map without it least
// squares may lose their way. That shows (a fit with one coefficient more is no worse than one
// without it), and the same is tried from factors of some size.
#include "effects/wheel_factors.hpp"
#include "fit/fit_stages.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace trussmap::fitting {
namespace {

constexpr double kStartSizes[] = {-0.25, 0.25, -0.6, 1.0};

bool is_factor(Channel channel) {
  return effects::is_wheel_factor(channel) || channel == Channel::steer_gain;
}

bool is_from_nothing(const Effect& effect) {
  return std::all_of(effect.coefficients.begin(), effect.coefficients.end(),
                     [](double one) { return one == 0.0; });
}

/// Its place among the effects, where there is one such factor alone.
std::optional<std::size_t> sought_factor(const Model& model, const FitterOptions& options) {
  std::optional<std::size_t> place;
  if (!options.fit_effects || options.near != nullptr) return place;
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    const Effect& one = model.effects[e];
    const bool sought = is_factor(one.channel) && one.is_constant() && is_from_nothing(one);
    if (!sought || one.per_session) continue;
    if (place) return std::nullopt;
    place = e;
  }
  return place;
}

/// It may not be fitted where it is lost, for it seems to tell nothing there.
bool is_lost(const Fitting& fitted, std::size_t factor, const FitterOptions& options) {
  if (!is_gross_misfit(fitted.fit)) return false;
  const std::optional<UnfittedCoefficient>& unfitted = fitted.not_fitted[factor].front();
  if (unfitted) return unfitted->why != NotFitted::undetermined;
  const bool worse =
      fitted.chi2_without && chi2_of_all(fitted.fit.adjustment, options) > *fitted.chi2_without;
  return worse || !fitted.fit.settled;
}

/// The best of those from factors of some size, where it is fitted; the first that leaves no gross
/// misfit is good enough.
std::optional<Fitting> from_other_sizes(const std::vector<DrivenRecording>& recordings, Model model,
                                        std::size_t factor, const FitterOptions& options) {
  std::optional<Fitting> best;
  for (const double size : kStartSizes) {
    model.effects[factor].coefficients = {size};
    try {
      Fitting next = fit_from(recordings, model, options);
      if (next.not_fitted[factor].front()) continue;
      if (best &&
          chi2_of_all(best->fit.adjustment, options) <= chi2_of_all(next.fit.adjustment, options)) {
        continue;
      }
      best = std::move(next);
      if (!is_gross_misfit(best->fit)) break;
    } catch (const SolveError&) {
      continue;
    }
  }
  return best;
}

}  // namespace

FitState fit_recordings(const std::vector<DrivenRecording>& recordings, const Model& model,
                        const FitterOptions& options) {
  const std::optional<std::size_t> factor = sought_factor(model, options);
  if (!factor) return fit_from(recordings, model, options).fit;
  std::optional<Fitting> found;
  try {
    found = fit_from(recordings, model, options);
    if (!is_lost(*found, *factor, options)) return std::move(found->fit);
  } catch (const SolveError&) {
    std::optional<Fitting> other = from_other_sizes(recordings, model, *factor, options);
    if (!other || is_gross_misfit(other->fit)) throw;
    return std::move(other->fit);
  }
  std::optional<Fitting> other = from_other_sizes(recordings, model, *factor, options);
  const bool better = other && chi2_of_all(other->fit.adjustment, options) <
                                   chi2_of_all(found->fit.adjustment, options);
  return std::move((better ? other : found)->fit);
}

}  // namespace trussmap::fitting
