// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/quantity_cells.hpp"

#include "trussmap/table.hpp"

#include <fmt/format.h>

namespace trussmap::report {

std::vector<std::string> quantity_cells(const Estimate& estimate) {
  const QuantityText text = quantity_text(estimate.value, estimate.standard_error);
  return {text.value, text.error.empty() ? "" : "\u00b1 " + text.error};
}

std::string with_error(double value, double standard_error) {
  const QuantityText text = quantity_text(value, standard_error);
  return text.error.empty() ? text.value : fmt::format("{} \u00b1 {}", text.value, text.error);
}

std::vector<std::string> sigma_heading() {
  return {"runs within (expected)", "1 sigma", "2 sigma", "3 sigma"};
}

std::vector<std::vector<std::string>> sigma_rows(const StatedNoise& stated) {
  std::vector<std::vector<std::string>> rows;
  for (const SigmaCount& count : stated.counts) {
    std::vector<std::string>& row = rows.emplace_back(1, count.coordinates);
    for (std::size_t k = 0; k < count.inside.size(); ++k) {
      row.push_back(fmt::format("{} ({:.1f})", count.inside[k], count.expected[k]));
    }
  }
  return rows;
}

}  // namespace trussmap::report
