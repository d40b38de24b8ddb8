// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "umbmark_output.hpp"

#include "json_values.hpp"
#include "trussmap/texts.hpp"

#include <cmath>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

ordered_json solution_json(const SquareRound& round, SquareMethod method) {
  const SquareSolution& found = method == SquareMethod::exact ? round.exact : round.formulas;
  const SquareCorrections sum = corrections_after(round, method);
  const auto interval = [](const Estimate& estimate) {
    const Interval at = confidence_interval(estimate);
    return ordered_json{at.low, at.high};
  };
  return {{"alpha_rad", found.alpha.value},
          {"beta_rad", found.beta.value},
          {"E_d", found.diameter_ratio.value},
          {"E_b", found.wheelbase_ratio.value},
          {"c_left", sum.left_factor.value},
          {"c_right", sum.right_factor.value},
          {"wheelbase_m", sum.wheelbase.value},
          {"E_max_syst_m", round.clusters.largest_offset.value},
          {"sem_m", round.clusters.sem},
          {"second_round_worthwhile", round.clusters.second_round_worthwhile},
          {"sd_alpha_rad", found.alpha.standard_error},
          {"sd_beta_rad", found.beta.standard_error},
          {"sd_E_d", found.diameter_ratio.standard_error},
          {"sd_E_b", found.wheelbase_ratio.standard_error},
          {"sd_c_left", sum.left_factor.standard_error},
          {"sd_c_right", sum.right_factor.standard_error},
          {"sd_wheelbase_m", sum.wheelbase.standard_error},
          {"sd_E_max_syst_m", round.clusters.largest_offset.standard_error},
          {"interval95_E_d", interval(found.diameter_ratio)},
          {"interval95_E_b", interval(found.wheelbase_ratio)},
          {"total_E_d", sum.errors.diameter_ratio},
          {"total_E_b", sum.errors.wheelbase_ratio},
          {"total_E_s", sum.errors.scale}};
}

ordered_json headings_json(const SquareHeadings& headings) {
  ordered_json out;
  const auto add = [&out](const std::string& name, const Estimate& value) {
    out[name] = value.value;
    out["sd_" + name] = value.standard_error;
  };
  add("cw_rad", headings.cw);
  add("ccw_rad", headings.ccw);
  out["E_theta_max_rad"] = headings.largest;
  add("alpha_rad", headings.alpha);
  add("beta_rad", headings.beta);
  add("E_d", headings.diameter_ratio);
  add("E_b", headings.wheelbase_ratio);
  add("alpha_excess_rad", headings.alpha_excess);
  add("beta_excess_rad", headings.beta_excess);
  out["p_value"] = number_or_null(headings.p_value);
  return out;
}

ordered_json alone_json(const std::vector<PathAlone>& paths) {
  ordered_json list = ordered_json::array();
  for (const PathAlone& one : paths) {
    list.push_back({{"path", one.path},
                    {"end_m", one.tuned.error_before},
                    {"tuned_wheelbase_ratio", one.tuned.wheelbase_ratio},
                    {"end_tuned_m", one.tuned.error_after},
                    {"square_cw_tuned_m", one.tuned.square_cw},
                    {"square_ccw_tuned_m", one.tuned.square_ccw}});
  }
  return list;
}

ordered_json round_json(const SquareRound& round) {
  ordered_json out = solution_json(round, SquareMethod::formulas);
  out["exact"] = solution_json(round, SquareMethod::exact);
  const auto centre = [](const SampleMean& mean) {
    return ordered_json{{"runs", mean.count},
                        {"x_m", mean.mean.x()},
                        {"y_m", mean.mean.y()},
                        {"sd_x_m", std::sqrt(mean.covariance(0, 0))},
                        {"sd_y_m", std::sqrt(mean.covariance(1, 1))}};
  };
  out["cw"] = centre(round.clusters.cw);
  out["ccw"] = centre(round.clusters.ccw);
  out["alpha_x_rad"] = round.angles.alpha_x.value;
  out["alpha_y_rad"] = round.angles.alpha_y.value;
  out["beta_x_rad"] = round.angles.beta_x.value;
  out["beta_y_rad"] = round.angles.beta_y.value;
  out["driven_with"] = {{"wheelbase_m", round.setup.wheelbase},
                        {"c_left", round.in_force.left_factor()},
                        {"c_right", round.in_force.right_factor()}};
  out["residual_m"] = round.consistency.residual;
  out["contradiction_p_value"] = number_or_null(round.consistency.p_value);
  out["E_s"] = round.setup.scale.value;
  out["sd_E_s"] =
      round.setup.scale.dof > 0.0 ? ordered_json(round.setup.scale.standard_error) : nullptr;
  out["headings"] = round.headings ? headings_json(*round.headings) : nullptr;
  out["verdict"] = square_verdict(round);
  out["warnings"] = round.doubts;
  return out;
}

}  // namespace

nlohmann::ordered_json umbmark_json(const std::vector<SquareRound>& rounds, SquareMethod method,
                                    const std::vector<PathAlone>& alone) {
  ordered_json out = round_json(rounds.back());
  out["solution"] = method == SquareMethod::exact ? "exact" : "formulas";
  out["rounds"] = ordered_json::array();
  for (const SquareRound& round : rounds) out["rounds"].push_back(round_json(round));
  if (!alone.empty()) out["alone"] = alone_json(alone);
  return out;
}

}  // namespace trussmap::app
