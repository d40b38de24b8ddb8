// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/quantity_cells.hpp"

#include "trussmap/table.hpp"

namespace trussmap {

std::vector<std::string> quantity_cells(const Estimate& estimate) {
  const QuantityText text = quantity_text(estimate.value, estimate.standard_error);
  return {text.value, text.error.empty() ? "" : "\u00b1 " + text.error};
}

}  // namespace trussmap
