// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/recording_limits.hpp"

#include "io/csv.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <cmath>

namespace trussmap::io {
namespace {

/// Absent, or one that can be.
bool is_wrong_sd(double sd) {
  return !std::isnan(sd) && !(sd > 0.0);
}

}  // namespace

void SourceLine::expect(const char* what, double value, double largest) const {
  if (std::abs(value) <= largest) return;
  throw InputError(
      file_, line_,
      text::joined(what, " is ", std::isnan(value) ? "no number" : text::shortest_text(value),
                   ", expected a number of at most ", csv_number(largest), " in size"));
}

void SourceLine::expect_last_row(const Drive& drive) const {
  const std::size_t row = drive.rows() - 1;
  expect("time", drive.t[row], kLargestTime);
  if (row > 0 && !(drive.t[row] > drive.t[row - 1])) {
    throw InputError(file_, line_,
                     text::joined("time ", csv_number(drive.t[row]), " follows on ",
                                  csv_number(drive.t[row - 1]), ", expected a later time"));
  }
  if (!drive.left.empty()) expect("the left wheel's travel", drive.left[row], kLargestTravel);
  if (!drive.right.empty()) expect("the right wheel's travel", drive.right[row], kLargestTravel);
  for (const Covariate& one : drive.covariates) {
    expect(("column " + one.name).c_str(), one.values[row], kLargestTravel);
  }
}

void SourceLine::expect(const Sighting& sighting) const {
  expect("time", sighting.t, kLargestTime);
  if (!std::isnan(sighting.range)) expect("the range", sighting.range, kLargestRange);
  if (!std::isnan(sighting.bearing)) expect("the bearing", sighting.bearing, kLargestAngle);
}

void SourceLine::expect(const TruthRow& truth) const {
  expect("time", truth.t, kLargestTime);
  expect("x", truth.x, kLargestPosition);
  expect("y", truth.y, kLargestPosition);
  expect("the heading", truth.heading, kLargestAngle);
}

void SourceLine::expect(const SurveyPoint& point) const {
  expect("x", point.x, kLargestPosition);
  expect("y", point.y, kLargestPosition);
  if (!std::isnan(point.sd)) expect("the standard deviation", point.sd, kLargestPosition);
}

void SourceLine::expect(const Fix& fix) const {
  expect("time", fix.t, kLargestTime);
  expect("x", fix.x, kLargestPosition);
  expect("y", fix.y, kLargestPosition);
}

void SourceLine::expect(const Loop& loop) const {
  expect("time t", loop.t, kLargestTime);
  expect("time t2", loop.t2, kLargestTime);
  expect("dx", loop.dx, kLargestPosition);
  expect("dy", loop.dy, kLargestPosition);
  expect("dtheta", loop.dtheta, kLargestAngle);
  if (is_wrong_sd(loop.sd) || is_wrong_sd(loop.sd_heading)) {
    throw InputError(file_, line_, "a standard deviation is not more than 0, expected one");
  }
}

}  // namespace trussmap::io
