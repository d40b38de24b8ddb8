// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fit_warnings.hpp"

#include "estimation/kinds/kinds.hpp"
#include "estimation/student_tails.hpp"
#include "text/number_text.hpp"

#include <iterator>
#include <set>
#include <string_view>

namespace trussmap::fitting {
namespace {

/// "sightings or fixes", in the order of the kinds.
std::string kinds_left_out(const FitState& fit) {
  std::set<std::string_view> out;
  for (const int k : fit.adjustment.left_out) {
    out.insert(fit.problem.measurements[idx(k)].kind->facts().several);
  }
  std::string text;
  for (const estimation::MeasurementKind* kind : estimation::kinds::all()) {
    const std::string_view several = kind->facts().several;
    if (out.erase(several) > 0) text.append(text.empty() ? "" : " or ").append(several);
  }
  return text;
}

std::string left_out_warning(const FitState& fit, const std::optional<std::size_t>& with_missing) {
  const bool one = fit.adjustment.left_out.size() == 1;
  std::string text = one ? text::joined("one of the ", kinds_left_out(fit), " was left out")
                         : text::joined(fit.adjustment.left_out.size(), " ", kinds_left_out(fit),
                                        " were left out");
  if (!with_missing) return text;
  if (one && *with_missing == 0) return text + "; with what is missing added it fits";
  return text + (*with_missing == 0 ? "; with what is missing added all of them fit"
                                    : text::joined("; with what is missing added ", *with_missing,
                                                   " still would be"));
}

}  // namespace

std::vector<std::string> fit_warnings(const FitState& fit, const FitAnswers& answers) {
  constexpr double kImplausible = 1e-6;
  const estimation::RecordingAdjustment& adjustment = fit.adjustment;
  std::vector<std::string> warnings;
  if (!adjustment.converged) {
    warnings.push_back(text::joined("no minimum was reached in ", adjustment.iterations,
                                    " iterations: the map is not the best one"));
  }
  if (adjustment.p_value < kImplausible && !answers.misfit) {
    warnings.push_back(text::joined("chi^2 = ", text::fixed_text(adjustment.chi2, 1),
                                    " is too large for ", adjustment.dof,
                                    " degrees of freedom: the model's noise is too small, "
                                    "an effect is missing, or sightings are wrong"));
  }
  if (!adjustment.left_out.empty()) {
    warnings.push_back(left_out_warning(fit, answers.left_out_with_missing));
  }
  for (const NoiseProcess& one : fit.model.noise.processes) {
    if (!(one.tails > 0.0) || estimation::has_used_tails(one)) continue;
    warnings.push_back(text::joined("the tails of the noise ", name_of(one.channel), ", ",
                                    name_of(one.process),
                                    " are not used: only white noise of sightings has them"));
  }
  if (!fit.settled) {
    warnings.push_back(text::joined("shapes and path did not settle in ", fit.rounds,
                                    " rounds; the last still moved ", fit.still_moving));
  }
  std::ranges::move(estimation::mirror_warnings(fit.problem, adjustment),
                    std::back_inserter(warnings));
  return warnings;
}

}  // namespace trussmap::fitting
