// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tables without a header: "column 1", "column 2". What their columns are the values alone tell,
// and not much: two neighbours that grow alike may be wheels. The others are listed, for who knows
// them.
#include "logs/named_fields.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::logs {
namespace {

bool is_unnamed(const NamedFacts& field) {
  constexpr std::string_view kName = "column ";
  const std::string_view path = field.path;
  return path.starts_with(kName) && path.size() > kName.size() &&
         path.find_first_not_of("0123456789", kName.size()) == std::string_view::npos;
}

/// What two wheels of one robot have in common: both go on and on, and as far.
bool grow_alike(const LogFieldFacts& a, const LogFieldFacts& b) {
  constexpr double kFactor = 2.0;
  constexpr double kBack = 0.05;  // share of the rows in which a wheel goes back
  const auto alike = [](double one, double other) {
    const double ratio = std::abs(one) / std::abs(other);
    return one * other != 0.0 && ratio < kFactor && ratio > 1.0 / kFactor;
  };
  const auto goes_on = [](const LogFieldFacts& one) {
    const double back =
        static_cast<double>(one.last > one.first ? one.decreases : one.different - one.decreases);
    return is_cumulative(one) && back <= kBack * static_cast<double>(one.values);
  };
  return a.values == b.values && goes_on(a) && goes_on(b) && alike(a.total_step, b.total_step) &&
         alike(a.last - a.first, b.last - b.first);
}

}  // namespace

std::optional<std::pair<const NamedFacts*, const NamedFacts*>> unnamed_wheels(
    const FreeFields& fields) {
  const NamedFacts* before = nullptr;
  for (const NamedFacts& one : fields.all()) {
    if (!fields.is_free(one) || one.facts->is_text || !is_unnamed(one)) continue;
    if (before != nullptr && before->file == one.file && grow_alike(*before->facts, *one.facts)) {
      return std::pair(before, &one);
    }
    before = &one;
  }
  return std::nullopt;
}

void list_unnamed(const FreeFields& fields, MapText& text) {
  bool any = false;
  for (const NamedFacts& one : fields.all()) {
    if (!fields.is_free(one) || !is_unnamed(one)) continue;
    if (!any) {
      text.blank();
      text.comment(
          "The table has no header. What else is in it, for [yaw_rate], [heading], [fixes],");
      text.comment(
          "[truth], [odometry], [[sightings]] (field = \"column 3\", x = \"column 4\", ...):");
    }
    any = true;
    const LogFieldFacts& facts = *one.facts;
    const std::string where = one.file.empty() ? "" : one.file + ": ";
    if (facts.is_text) {
      text.comment(fmt::format("  {}{}: texts, the first \"{}\"", where, one.path, facts.example));
      continue;
    }
    const double step = facts.total_step / std::max(1.0, static_cast<double>(facts.values) - 1.0);
    text.comment(fmt::format("  {}{}: {:.6g} to {:.6g}{}, by {:.2g} from row to row", where,
                             one.path, facts.least, facts.largest,
                             facts.is_whole ? ", whole numbers" : "", step));
  }
}

}  // namespace trussmap::logs
