// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "tolerance_option.hpp"

#include "option_checks.hpp"

#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

/// m; nothing where it is none.
std::optional<double> length_of(std::string_view text) {
  double unit = 1.0;
  for (const auto& [name, metres] :
       {std::pair<std::string_view, double>{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}}) {
    if (!text.ends_with(name)) continue;
    text.remove_suffix(name.size());
    unit = metres;
    break;
  }
  while (text.ends_with(' ')) text.remove_suffix(1);
  const std::optional<double> number = finite_number(text);
  if (!number || !(*number > 0.0) || *number > 1e9) return std::nullopt;
  return *number * unit;
}

}  // namespace

void add_tolerance(const Command& command, std::string& tolerance) {
  command
      .add_option("--tolerance", tolerance,
                  "How far off legs that no fit has seen may end (root mean square): 20mm, 2cm, "
                  "0.02m. Beyond it the exit status is 1")
      .type_name("LENGTH")
      .check({[](const std::string& text) {
                return length_of(text)
                           ? std::string()
                           : "'" + text + "' is no length above 0, expected 20mm, 2cm or 0.02m";
              },
              ""});
}

std::optional<Tolerance> judged(const std::string& tolerance, const HeldOut& held_out) {
  if (tolerance.empty()) return std::nullopt;
  if (held_out.legs.empty()) {
    throw UsageError("--tolerance judges by held-out legs, and these recordings have none");
  }
  return Tolerance{*length_of(tolerance), held_out.arrival_rms, held_out.legs.size()};
}

Page with_tolerance(const Page& page, const std::optional<Tolerance>& tolerance) {
  return tolerance ? trussmap::with_tolerance(page, *tolerance) : page;
}

void end_by(const std::optional<Tolerance>& tolerance) {
  if (!tolerance) return;
  fmt::print("\n{}\n", in_words(*tolerance));
  if (!tolerance->passed()) throw AnswerIsNo();
}

}  // namespace trussmap::app
