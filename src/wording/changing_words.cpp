// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/number_text.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// An effect of one coefficient in its own words, else a factor.
std::string size_text(const ChangingCoefficient& change, double value, double sd) {
  if (change.effect.coefficients.size() > 1) {
    return fmt::format("it is {} +- {} times what it is throughout", text::fixed_text(value, 2),
                       text::fixed_text(sd, 2));
  }
  Effect sized = change.effect;
  sized.coefficients = {value};
  return in_words(sized, {sd});
}

std::string step_text(const ChangingCoefficient& change) {
  const std::string of = change.session_name.empty() ? std::string() : " of " + change.session_name;
  const std::string when =
      change.between
          ? "from the start" + of + " on"
          : fmt::format("at t = {} s{} ({} to {} s)", text::fixed_text(change.t, 0), of,
                        text::fixed_text(change.earliest, 0), text::fixed_text(change.latest, 0));
  return fmt::format("{} changes {}: before, {}; after, {}", name_in_words(change.effect), when,
                     size_text(change, change.before, change.before_sd),
                     size_text(change, change.after, change.after_sd));
}

std::string walk_text(const ChangingCoefficient& change) {
  const auto by_value = [](const CoursePart& a, const CoursePart& b) { return a.value < b.value; };
  auto [least, most] = std::minmax_element(change.course.begin(), change.course.end(), by_value);
  const bool rises = least < most;
  const CoursePart& first = rises ? *least : *most;
  const CoursePart& then = rises ? *most : *least;
  const bool several = change.course.back().session > 0;
  const auto when = [several](const CoursePart& part) {
    return text::fixed_text(0.5 * (part.from + part.until), 0) + " s" +
           (several ? fmt::format(" of recording {}", part.session + 1) : "");
  };
  return fmt::format("{} wanders while driving: at t = {}, {}; at t = {}, {}",
                     name_in_words(change.effect), when(first),
                     size_text(change, first.value, first.sd), when(then),
                     size_text(change, then.value, then.sd));
}

}  // namespace

std::string in_words(const ChangingCoefficient& change) {
  std::string text =
      change.form == ChangingCoefficient::Form::step ? step_text(change) : walk_text(change);
  constexpr std::size_t kNamed = 3;
  for (std::size_t k = 0; k < std::min(kNamed, change.goes_with.size()); ++k) {
    text += (k == 0 ? "; it goes with " : " or ") + change.goes_with[k];
  }
  return text;
}

}  // namespace trussmap
