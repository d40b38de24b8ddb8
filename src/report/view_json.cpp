// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/view_json.hpp"

#include "report/effect_parts.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/wording.hpp"
#include "wording/explanations.hpp"

namespace trussmap::report {

using nlohmann::ordered_json;

ordered_json effect_view(const Effect& effect) {
  ordered_json result = {{"id", effect.name},
                         {"name", name_in_words(effect)},
                         {"formula", formula_of(effect)},
                         {"part", part_name(part_of(effect))},
                         {"channel", name_of(effect.channel)},
                         {"does", facts_of(effect.channel).does_what},
                         {"shape", texts_of(effect.shape)}};
  if (const CatalogueEntry* entry = wording::usual_entry(effect)) {
    result["cause"] = entry->cause;
    result["remedy"] = entry->remedy;
  }
  return result;
}

ordered_json chart_view(const plot::Chart& chart) {
  return ordered_json::parse(plot::chart_json(chart));
}

ordered_json millimetres(const std::optional<HeldOutMetrics>& metrics) {
  return metrics ? ordered_json(1e3 * metrics->arrival_rms) : ordered_json(nullptr);
}

std::string safe_text(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace trussmap::report
