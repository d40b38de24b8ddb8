// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "recording/well_formed.hpp"

#include "text/number_text.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace trussmap {
namespace {

[[noreturn]] void refuse(const Recording& recording, const std::string& what) {
  throw std::invalid_argument("recording \"" + recording.name + "\": " + what);
}

void require_rows(const Recording& recording, const std::string& name,
                  const std::vector<double>& column) {
  if (column.size() == recording.drive.rows()) return;
  refuse(recording, joined("column ", name, " of the drive has ", column.size(), " rows, expected ",
                           recording.drive.rows(), " as t has"));
}

void require_finite(const Recording& recording, const std::string& name,
                    const std::vector<double>& column) {
  for (std::size_t row = 0; row < column.size(); ++row) {
    if (std::isfinite(column[row])) continue;
    refuse(recording,
           joined("column ", name, " of the drive is not finite in row ", row, ", counted from 0"));
  }
}

void require_drive(const Recording& recording) {
  const Drive& drive = recording.drive;
  require_finite(recording, "t", drive.t);
  for (std::size_t row = 1; row < drive.rows(); ++row) {
    if (drive.t[row] > drive.t[row - 1]) continue;
    refuse(recording, joined("t of the drive does not increase in row ", row, ", counted from 0"));
  }
  require_rows(recording, "left", drive.left);
  require_finite(recording, "left", drive.left);
  require_rows(recording, "right", drive.right);
  require_finite(recording, "right", drive.right);
  if (drive.has_compass()) require_rows(recording, "heading", drive.heading);
  for (const Covariate& one : drive.covariates) {
    require_rows(recording, one.name, one.values);
    require_finite(recording, one.name, one.values);
  }
}

/// In order of time, and within the drive but for a row's rounding of the clock.
template <typename Rows>
void require_times(const Recording& recording, const char* name, const Rows& rows) {
  const Drive& drive = recording.drive;
  if (rows.empty()) return;
  if (drive.rows() == 0) refuse(recording, joined("has ", name, " and no drive"));
  const double slack = drive.duration(0);
  double last = drive.start() - slack;
  for (const auto& row : rows) {
    if (!(row.t >= last)) {
      refuse(recording, joined(name, " are not in order of time from the drive's start on, at t = ",
                               short_text(row.t), " s"));
    }
    last = row.t;
  }
  if (last > drive.t.back() + slack) {
    refuse(recording,
           joined("of the ", name, " that of t = ", short_text(last),
                  " s comes after the drive, which ends at ", short_text(drive.t.back()), " s"));
  }
}

void require_pairs(const Recording& recording) {
  for (const Sighting& one : recording.sightings) {
    if (std::isnan(one.range) == std::isnan(one.bearing)) continue;
    refuse(recording, joined("the sighting of ", one.landmark, " at t = ", short_text(one.t),
                             " s has a ", std::isnan(one.range) ? "bearing" : "range",
                             " alone, "
                             "expected both or neither"));
  }
}

}  // namespace

void require_well_formed(const Recording& recording) {
  require_drive(recording);
  require_times(recording, "sightings", recording.sightings);
  require_times(recording, "truth rows", recording.truth);
  require_pairs(recording);
}

void require_well_formed(const std::vector<Recording>& recordings) {
  for (const Recording& one : recordings) require_well_formed(one);
}

}  // namespace trussmap
