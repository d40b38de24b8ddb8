// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What results of fits have in common.
#pragma once

#include "inputs.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/pages.hpp"

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace trussmap::python {

/// A page's section, made when it is first asked for and then kept: it costs about as much as the
/// result itself.
class LazySection {
 public:
  [[nodiscard]] std::string html(const std::function<Page()>& make) const;

 private:
  struct Kept {
    std::mutex mutex;
    std::optional<std::string> html;
  };
  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
};

/// Budgets as rows of horizon, rms and the shares.
[[nodiscard]] pybind11::list budget_rows(const std::vector<NoiseBudget>& budget);
/// What was found of each source, a dict each.
[[nodiscard]] pybind11::list noise_rows(const FittedNoise& noise);

/// The one of these names; ValueError, listing them, on another.
[[noreturn]] void no_table(const std::string& what, const std::vector<std::string>& tables);

}  // namespace trussmap::python
