// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "scope_options.hpp"

#include "option_checks.hpp"

namespace trussmap::app {

RefinementScope ScopeOptions::scope() const {
  using Kind = RefinementScope::Kind;
  RefinementScope scope;
  if (no_groups && eta == "all") {
    throw UsageError("--no-groups and --eta all contradict each other: expected --eta N");
  }
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
          "How far a correction reaches (methods elastic and elastic-printed): the N landmarks "
          "nearest to the route come to equilibrium, and then groups of landmarks round them, at "
          "every scale; all; estimated: N by a bound, before each correction; or auto: all up "
          "to some 10^4 landmarks, then 50")
      .type_name("N|all|estimated|auto")
      .check(eta_text())
      .capture_default_str();
  command.add_flag("--no-groups", options.no_groups,
                   "With --eta N or estimated: these landmarks alone, as in the paper");
  command
      .add_option("--law", options.law,
                  "How stiff a route is (method elastic): 1/mean error, the paper's law, which is "
                  "the default, or 1/variance, which weighs as least squares do")
      .check(one_of({"mean-error", "variance"}));
}

}  // namespace trussmap::app
