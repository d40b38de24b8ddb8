// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A grammar of formulas for what stands out and no catalogue has: of a channel, simplest first.
//
//   power       sqrt(abs(u))             u^2 and abs(u) are among the plain candidates
//   harmonics   sin 4 heading, cos 4 heading                 once and twice are
//   product     u*v                      what a robot carries, how fast it drives and turns, time
//   threshold   max(0, u-c)              steps at c are
//   saturation  u/(c+u)                  half of the most at c
//   decay       exp(-t/T), 1-exp(-t/T)   what warms up, or wears in
//   line        a*x+b*y > c              the edge between two floors
//   wave        sin, cos of kx*x+ky*y    across the floor
//
// Constants (c, T, an angle, a wave's length) are tried at many values, a family each, as those of
// places are. Forms of one variable share one belief among them, so do products, so do those of the
// floor.
#pragma once

#include "criticism/candidates.hpp"

#include <vector>

namespace trussmap::criticism {

/// What formulas are made of: what a drive's rows hold, and where they were. Keeps a reference.
class FormulaGrammar {
 public:
  FormulaGrammar(const fitting::FitState& fit, const fitting::ShapeContext& context);

  /// Whether formulas are sought in the channel at all: those of the robot's motion, its compass
  /// and gyro.
  [[nodiscard]] static bool speaks_of(Channel channel);
  /// All of a channel; empty where it does not speak of it.
  [[nodiscard]] std::vector<Candidate> of(Channel channel) const;

 private:
  /// A variable, as formulas write it.
  struct Term {
    std::string text;      ///< "speed", "abs(turn_rate)", "(temperature_C-20)"
    std::string size;      ///< the same, never below 0; empty where it is
    std::string variable;  ///< that it speaks of
    double least = 0.0;    ///< of the size
    double most = 0.0;
    bool covariate = false;
  };
  void add_term(const std::string& name, const fitting::ShapeContext& context, bool covariate);

  void add_powers(Channel channel, std::vector<Candidate>& all) const;
  void add_products(Channel channel, std::vector<Candidate>& all) const;
  void add_saturations(Channel channel, std::vector<Candidate>& all) const;
  void add_decays(Channel channel, std::vector<Candidate>& all) const;
  void add_planes(Channel channel, std::vector<Candidate>& all) const;

  std::vector<Term> terms_;
  double duration_ = 0.0;  ///< s
  Vector2 middle_ = Vector2::Zero();
  double reach_ = 0.0;  ///< m, half of the floor's diagonal
};

}  // namespace trussmap::criticism
