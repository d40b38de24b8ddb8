// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which arrivals a builder leaves out, when it cannot know what comes.
//
//   d^2    squared misfit of an arrival at a known landmark, in the standard deviations of leg and
//          map together: chi^2 with 2 degrees of freedom where all is as believed
//   s^2    the median of the last d^2 (of eight at least) over that of chi^2, at least 1
//   out    where d > gate s
//
// A wrong landmark stands out among its neighbours in time. A systematic error does not: with it
// all d grow alike, and s with them, so that nothing goes, and what went before comes back.
#pragma once

#include <deque>

namespace trussmap::map {

class ArrivalGate {
 public:
  /// Standard deviations; infinity: everything is let in.
  explicit ArrivalGate(double gate) : gate_(gate) {}

  [[nodiscard]] bool lets_in(double squared_misfit) const;
  void remember(double squared_misfit);

  /// s.
  [[nodiscard]] double scale() const { return scale_; }
  void set_gate(double gate) { gate_ = gate; }

  /// The misfits that s rests on, in the order in which they came.
  [[nodiscard]] const std::deque<double>& remembered() const { return last_; }

 private:
  double gate_;
  double scale_ = 1.0;
  std::deque<double> last_;
};

}  // namespace trussmap::map
