// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a diagnosis tries: the whole catalogue, and every channel against every variable.
//
//   catalogue     as it stands; one per covariate, one per place and radius, one per threshold
//   line          u                   sense       sign(u)
//   magnitude     |u|                 square      u^2
//   step          1 beyond c          threshold   max(0, u - c)
//   curve         four bells over u; of the heading: two harmonics; of the floor: bells all over it
//   with heading  u sin, u cos of the heading
//   bell, disc    a place
//
// Forms with shape parameters (a place, a threshold) are tried at many values; the best member
// of such a family stands for it, refined, and the number tried is counted.
#pragma once

#include "criticism/score_test.hpp"
#include "effects/catalogue_record.hpp"

#include <string>
#include <vector>

namespace trussmap::criticism {

enum class Form {
  catalogue,
  line,
  sense,
  magnitude,
  square,
  step,
  threshold,
  curve,
  with_heading,
  place,
  formula  ///< formulas.hpp: sought beside what was found
};

/// Where a search for a shape parameter goes.
struct SearchRange {
  double step = 0.0;  ///< between the members tried
  double least = 0.0;
  double most = 0.0;
};

/// How parameters come into the pattern: "{name}" each, or
///
///   line   angle of its normal, how far beyond the pivot it is, m     {a}*x+{b}*y>{c}
///   wave   angle in which it goes, its length, m                      {kx}*x+{ky}*y
///
/// so that one may be sought without the other.
enum class Writing { as_they_are, line, wave };

struct Candidate {
  Effect effect;  ///< without coefficients
  Form form = Form::catalogue;
  std::string variable;  ///< what it goes with: "speed", "payload_kg", "place", ""
  /// Candidates of the same family (not empty) differ in `parameters` alone.
  std::string family;
  std::vector<std::string> pattern;        ///< shapes, "{x}" and so on for the parameters
  std::vector<ShapeParameter> parameters;  ///< of the shapes
  std::vector<SearchRange> search;         ///< one per parameter
  Writing writing = Writing::as_they_are;
  Vector2 pivot = Vector2::Zero();  ///< m, of a line
  /// Log of the belief in it before any data, against a catalogue effect's.
  double log_prior = 0.0;
};

/// All of them for these recordings. What the recordings cannot have (a compass effect without a
/// compass) is not among them.
[[nodiscard]] std::vector<Candidate> candidates_for(const fitting::FitState& fit,
                                                    const fitting::ShapeContext& context);

/// What the catalogue knows of it; nullptr of a free form.
[[nodiscard]] const effects::CatalogueRecord* record_of(const Candidate& candidate);

/// The same candidate with other parameters, its name and shapes made anew. They are numbers of few
/// digits: a search cannot tell finer ones apart.
[[nodiscard]] Candidate with_parameters(const Candidate& candidate,
                                        const std::vector<double>& values);

/// The candidate with parameters near its own that explain the most (itself, where it has none).
[[nodiscard]] Candidate refined(const ScoreTest& tests, const Candidate& candidate);

}  // namespace trussmap::criticism
