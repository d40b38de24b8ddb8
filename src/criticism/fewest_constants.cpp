// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/fewest_constants.hpp"

#include "criticism/calibrated_start.hpp"
#include "criticism/candidates.hpp"
#include "criticism/effect_strength.hpp"
#include "criticism/refits.hpp"
#include "statistics/median.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace trussmap::criticism {
namespace {

bool is_motion(Channel channel) {
  return channel == Channel::travel || channel == Channel::turn || channel == Channel::sideways;
}

/// Larger wheels make all that is driven larger alike: one constant instead of two or three.
ModelFit with_wheel_scale(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                          std::size_t first) {
  const effects::CatalogueRecord* scale = effects::find_record("wheel scale");
  std::vector<Effect> effects(fit.model.effects.begin(),
                              fit.model.effects.begin() + static_cast<std::ptrdiff_t>(first));
  std::vector<double> factors;
  for (std::size_t k = first; k < fit.model.effects.size(); ++k) {
    const Effect& one = fit.model.effects[k];
    if (is_motion(one.channel)) {
      factors.push_back(one.coefficients.front());
    } else {
      effects.push_back(one);
    }
  }
  if (factors.size() < 2 || scale == nullptr) return fit;
  effects.push_back(catalogue_effect(scale->entry));
  effects.back().coefficients = {statistics::median(factors)};
  const std::optional<ModelFit> one = refit_by(recordings, fit, std::move(effects));
  if (!one || !does_as_well(*one, fit, factors.size() - 1)) return fit;
  return *one;
}

/// What one wheel of another size may be told as, all at once.
bool is_of_one_wheel(Channel channel) {
  return channel == Channel::difference || channel == Channel::wheels || is_motion(channel);
}

/// One wheel of another size is a ratio, a scale and a turning at once: one constant instead of
/// them, or of all, where a fit with it does as well.
std::optional<ModelFit> with_one_wheel(const std::vector<DrivenRecording>& recordings,
                                       const ModelFit& fit, std::size_t first) {
  const std::vector<Effect>& all = fit.model.effects;
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  const auto ratio = std::find_if(begin, all.end(), [](const Effect& one) {
    return one.channel == Channel::difference && one.is_constant();
  });
  const auto told = std::count_if(begin, all.end(),
                                  [](const Effect& one) { return is_of_one_wheel(one.channel); });
  if (ratio == all.end() || told < 2) return std::nullopt;
  const double right = ratio->coefficients.front();
  std::vector<Effect> others;
  std::copy_if(begin, all.end(), std::back_inserter(others),
               [](const Effect& one) { return !is_of_one_wheel(one.channel); });
  const auto with = [&](const std::vector<Effect>& beside, Effect wheel) {
    std::vector<Effect> effects(all.begin(), begin);
    effects.insert(effects.end(), beside.begin(), beside.end());
    effects.push_back(std::move(wheel));
    return refit_by(recordings, fit, std::move(effects));
  };
  std::vector<std::vector<Effect>> rests{{}};
  if (!others.empty()) rests.push_back(others);
  for (const std::vector<Effect>& rest : rests) {
    for (const Effect& wheel :
         {wheel_of_other_size(Channel::right, right), wheel_of_other_size(Channel::left, -right)}) {
      std::optional<ModelFit> one = with(rest, wheel);
      if (one && does_as_well(*one, fit, all.size() - first - rest.size() - 1)) return one;
    }
  }
  return std::nullopt;
}

/// A gross ratio of the wheels beside a gross scale of both is two wheels of other sizes, each by
/// itself: "half as large again as the left" would be said of wheels of the stated size.
ModelFit with_each_wheel(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                         std::size_t first) {
  std::vector<Effect> effects = fit.model.effects;
  const auto found = [&](Channel channel) {
    return std::find_if(effects.begin() + static_cast<std::ptrdiff_t>(first), effects.end(),
                        [channel](const Effect& one) { return one.channel == channel; });
  };
  const auto ratio = found(Channel::difference);
  const auto scale = found(Channel::wheels);
  if (ratio == effects.end() || scale == effects.end() || !is_gross(*ratio) || !is_gross(*scale)) {
    return fit;
  }
  const double half = 0.5 * ratio->coefficients.front();
  const double both = scale->coefficients.front();
  *ratio = wheel_of_other_size(Channel::left, both - half);
  *scale = wheel_of_other_size(Channel::right, both + half);
  return refit_by(recordings, fit, std::move(effects)).value_or(fit);
}

}  // namespace

Effect wheel_of_other_size(Channel wheel, double g) {
  return {wheel == Channel::left ? "left wheel" : "right wheel", wheel, {"1"}, {g}};
}

ModelFit with_fewest(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                     std::size_t first) {
  if (std::optional<ModelFit> one = with_one_wheel(recordings, fit, first)) return *std::move(one);
  return with_each_wheel(recordings, with_wheel_scale(recordings, fit, first), first);
}

}  // namespace trussmap::criticism
