// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where each landmark was found, time after time, and by how much that usually differs.
#pragma once

#include "check/findings.hpp"

#include <cstddef>
#include <map>
#include <string_view>
#include <vector>

namespace trussmap::check {

/// Where one landmark was.
struct Visit {
  double t = 0.0;    ///< s
  double way = 0.0;  ///< m driven until then
  Vector2 place = Vector2::Zero();
  bool seen = false;    ///< from afar
  std::size_t row = 0;  ///< of the sightings
};
using Visits = std::map<std::string_view, std::vector<Visit>>;

/// Of all landmarks whose sightings tell a place, each in order of time; those within `pass` m of
/// the way are one. Places are the truth's where that is trusted, else the track's.
[[nodiscard]] Visits visits_of(const Checked& checked, const Track& track, bool by_truth,
                               double pass);

/// By how much returns to a landmark may miss it.
struct UsualMiss {
  bool known = false;  ///< else too few return
  double off = 0.0;    ///< m, and
  double share = 0.0;  ///< of the way in between

  [[nodiscard]] double allowed(const Visit& a, const Visit& b) const;
};
/// Several times the medians, and no less than robots are often off.
[[nodiscard]] UsualMiss usual_miss(const Visits& visits, bool by_truth);

/// Single sightings under another landmark's name; of all visits, none taken together.
void check_wrong_labels(Checked& checked, const Visits& visits, const UsualMiss& usual);

/// What is beyond it so far that it is another place.
inline constexpr double kOtherPlace = 1.5;  // times what is allowed

}  // namespace trussmap::check
