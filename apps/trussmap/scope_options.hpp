// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --eta, --no-groups and --law: what a refinement of an elastic map does.
#pragma once

#include "commands.hpp"
#include "trussmap/map_builder.hpp"

#include <optional>
#include <string>

namespace trussmap::app {

struct ScopeOptions {
  std::string eta = "auto";
  bool no_groups = false;
  std::string law;  ///< "" for the method's own

  [[nodiscard]] RefinementScope scope() const;
  [[nodiscard]] std::optional<StiffnessLaw> stiffness_law() const;
  /// Whether any was given.
  [[nodiscard]] bool given() const { return eta != "auto" || no_groups || !law.empty(); }
};

void add_scope_options(const Command& command, ScopeOptions& options);

}  // namespace trussmap::app
