// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/process_moments.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::estimation {
namespace {

Lag correlated(double x) {
  if (x <= 0.0) return {};
  constexpr double kShort = 1e-2;
  const double lost = -std::expm1(-x);
  // Of a short lag all digits would cancel: a series, to 1e-11.
  const double mean =
      x < kShort
          ? x * (2.0 / 3.0 - x * (0.5 - x * (7.0 / 30.0 - x * (1.0 / 12.0 - x * 31.0 / 1260.0))))
          : (2.0 * (x - lost) - lost * lost) / (x * x);
  return {1.0 - lost, lost / x, -std::expm1(-2.0 * x), lost * lost / x, mean};
}

Lag walked(double lag) {
  return {1.0, 1.0, lag, 0.5 * lag, lag / 3.0};
}

}  // namespace

bool goes_with_distance(ProcessKind process) {
  return process == ProcessKind::correlated_in_distance || process == ProcessKind::walk_in_distance;
}

bool is_walk(ProcessKind process) {
  return is_chain(process) && !is_correlated(process);
}

Lag lag_of(ProcessKind process, double lag, double length) {
  lag = std::max(lag, 0.0);
  return is_correlated(process) ? correlated(lag / length) : walked(lag);
}

ProcessMoments process_moments(const std::vector<SegmentRow>& rows, const std::vector<Vector4>& c,
                               ProcessKind process, double length, bool at_ends) {
  constexpr double kSame = 1e-12;  // of a lag: rows mostly last equally long, but for rounding
  ProcessMoments at;
  double last = -1.0;
  Lag lag;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double elapsed =
        goes_with_distance(process) ? std::abs(rows[row].path) : rows[row].duration;
    if (!(std::abs(elapsed - last) <= kSame * elapsed)) {
      lag = lag_of(process, elapsed, length);
      last = elapsed;
    }
    const Vector4& own = c[row];
    if (!at_ends) {
      at.by_start += lag.mean_keep * at.keep * own;
      at.uu += lag.mean_keep * (at.uw * own.transpose() + own * at.uw.transpose()) +
               (lag.mean_keep * lag.mean_keep * at.ww + lag.mean) * own * own.transpose();
      at.uw = (lag.keep * (at.uw + lag.mean_keep * at.ww * own) + lag.both * own).eval();
    } else {
      at.uw *= lag.keep;
    }
    at.ww = lag.keep * lag.keep * at.ww + lag.end;
    at.keep *= lag.keep;
    if (at_ends) {
      at.by_start += at.keep * own;
      at.uu += at.uw * own.transpose() + own * at.uw.transpose() + at.ww * own * own.transpose();
      at.uw += at.ww * own;
    }
  }
  return at;
}

}  // namespace trussmap::estimation
