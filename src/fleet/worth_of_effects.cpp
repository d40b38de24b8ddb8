// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fleet/worth_of_effects.hpp"

#include "statistics/distributions.hpp"

#include <algorithm>

namespace trussmap::fleet {
namespace {

/// The days' sums of these effects' columns alone.
struct Part {
  std::vector<ColumnSums> days;
  std::vector<double> phi;                     ///< each day's dispersion with all effects
  std::vector<std::vector<Eigen::Index>> own;  ///< columns of each effect
};

Part part_of(const std::vector<const ColumnSums*>& days, const std::vector<FleetBlock>& effects) {
  Part part;
  std::vector<Eigen::Index> all;
  for (const FleetBlock& effect : effects) {
    std::vector<Eigen::Index> places;
    for (const Eigen::Index column : effect.columns) {
      places.push_back(static_cast<Eigen::Index>(all.size()));
      all.push_back(column);
    }
    part.own.push_back(std::move(places));
  }
  for (const ColumnSums* day : days) {
    part.days.push_back({day->g(all), day->S(all, all), day->whole(all), day->chi2, day->dof});
    ColumnSums after = part.days.back();
    for (const std::vector<Eigen::Index>& one : part.own) after.sweep(one);
    part.phi.push_back(after.dispersion());
  }
  return part;
}

struct Explained {
  double chi2 = 0.0;
  int dof = 0;
};

Explained explained(const Part& part, const std::vector<bool>& kept) {
  Explained sum;
  for (std::size_t d = 0; d < part.days.size(); ++d) {
    ColumnSums after = part.days[d];
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (kept[k]) after.sweep(part.own[k]);
    }
    sum.chi2 += (part.days[d].chi2 - after.chi2) / part.phi[d];
    sum.dof += part.days[d].dof - after.dof;
  }
  return sum;
}

}  // namespace

double worth_of_effects(const std::vector<const ColumnSums*>& days,
                        const std::vector<FleetBlock>& effects, double level) {
  const Part part = part_of(days, effects);
  std::vector<bool> kept(effects.size(), true);
  Explained with = explained(part, kept);
  for (;;) {
    double least = 0.0;
    double penalties = 0.0;
    std::size_t worst = effects.size();
    Explained best;
    for (std::size_t k = 0; k < effects.size(); ++k) {
      if (!kept[k]) continue;
      kept[k] = false;
      const Explained without = explained(part, kept);
      kept[k] = true;
      const int dof = with.dof - without.dof;
      const double penalty = dof > 0 ? statistics::chi2_quantile(1.0 - level, dof) : 0.0;
      const double gain = with.chi2 - without.chi2 - penalty;
      penalties += penalty;
      if (dof > 0 && gain >= least) continue;
      least = std::min(least, gain);
      worst = k;
      best = without;
    }
    if (worst == effects.size()) return with.chi2 - penalties;
    kept[worst] = false;
    with = best;
  }
}

}  // namespace trussmap::fleet
