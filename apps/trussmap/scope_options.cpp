// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "scope_options.hpp"

#include "option_checks.hpp"

namespace trussmap::app {

RefinementScope ScopeOptions::scope() const {
  using Kind = RefinementScope::Kind;
  RefinementScope scope;
  scope.groups = !no_groups;
  if (eta == "all") {
    scope.kind = Kind::all;
  } else if (eta == "estimated") {
    scope.kind = Kind::estimated;
  } else if (eta != "auto") {
    scope.kind = Kind::nearest;
    scope.eta = std::stoi(eta);
  }
  return scope;
}

std::optional<StiffnessLaw> ScopeOptions::stiffness_law() const {
  if (law.empty()) return std::nullopt;
  return law == "variance" ? StiffnessLaw::variance : StiffnessLaw::mean_error;
}

void add_scope_options(const Command& command, ScopeOptions& options) {
  command
      .add_option(
          "--eta", options.eta,
          "Landmarks that a refinement of the elastic methods lets come to equilibrium: the "
          "N nearest, and then groups of landmarks at every scale; all; estimated before "
          "each correction; or auto: all up to some 10^4 landmarks, then 50")
      .type_name("N|all|estimated|auto")
      .check(eta_text())
      .capture_default_str();
  command.add_flag("--no-groups", options.no_groups,
                   "With --eta N: the N nearest landmarks alone, as in the paper");
  command
      .add_option("--law", options.law,
                  "Stiffness of the method elastic: 1/mean error, the paper's, or 1/variance")
      .check(one_of({"mean-error", "variance"}));
}

}  // namespace trussmap::app
