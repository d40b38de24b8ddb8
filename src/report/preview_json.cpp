// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"
#include "report/page_words.hpp"
#include "report/view_json.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/wording.hpp"
#include "trussmap/workbench.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

using nlohmann::ordered_json;

plot::Chart chart_of(const EffectPreview& preview) {
  const EffectEvidence& evidence = preview.evidence;
  std::vector<plot::NamedCurve> rivals;
  for (std::size_t k = 0; k < evidence.rivals.size() && k < evidence.response.rivals.size(); ++k) {
    rivals.push_back({name_in_words(evidence.rivals[k]), evidence.response.rivals[k]});
  }
  const std::string name = name_in_words(evidence.estimate.effect);
  return plot::response_chart(
      "plot", "The error against its cause",
      "Dots with 95 % intervals: this error as the recordings show it, beside "
      "what else the model has. The line: " +
          name + (rivals.empty() ? "." : "; dashed: what it is set against."),
      evidence.response, name, rivals);
}

/// How a duel ends.
std::string duel_verdict(const Effect& effect, const Effect& rival, double behind) {
  if (std::abs(behind) >= kToldApart) {
    return fmt::format("All measurements together speak for {} (chi\u00b2 better by {:.0f}).",
                       name_in_words(behind > 0.0 ? effect : rival), std::abs(behind));
  }
  const std::string drive = separating_drive(effect, rival, {});
  return "These recordings cannot tell the two apart." +
         (drive.empty() ? std::string() : " To tell them apart: " + drive + ".");
}

ordered_json rivals_json(const EffectPreview& preview) {
  ordered_json list = ordered_json::array();
  const std::vector<Effect>& rivals = preview.evidence.rivals;
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    const bool predicted = k < preview.rivals_predicted.size();
    list.push_back({{"name", name_in_words(rivals[k])},
                    {"leaves_mm", predicted ? millimetres(preview.rivals_predicted[k]) : nullptr},
                    {"verdict", duel_verdict(preview.evidence.estimate.effect, rivals[k],
                                             preview.rivals_behind.at(k))}});
  }
  return list;
}

}  // namespace

std::string preview_json(const EffectPreview& preview, double arrival_rms) {
  const EffectEvidence& evidence = preview.evidence;
  const Effect& effect = evidence.estimate.effect;
  ordered_json result = effect_view(effect);
  result["seen"] = preview.dof > 0;
  result["words"] = preview.dof > 0
                        ? sized_in_words(evidence)
                        : "These recordings do not show it: map, poses or what the model "
                          "has already absorb it.";
  result["now_mm"] = 1e3 * arrival_rms;
  result["leaves_mm"] = millimetres(preview.predicted);
  result["chi2_less"] = preview.score;
  result["dof"] = preview.dof;
  result["p"] = chance_text(preview.p_value);
  result["rivals"] = rivals_json(preview);
  result["chart"] = evidence.response.bins.empty() && evidence.response.curve.empty()
                        ? ordered_json(nullptr)
                        : chart_view(chart_of(preview));
  return safe_text(result);
}

std::string explanation_json(const Effect& effect) {
  const Explanation explanation = explanation_of(effect);
  ordered_json result = effect_view(effect);
  result["explanation"] = {
      {"does", explanation.does}, {"look", explanation.look}, {"drive", explanation.drive}};
  result["unusual"] = explanation.unusual;
  result["drawing"] = effect_drawing(effect);
  return safe_text(result);
}

}  // namespace trussmap
