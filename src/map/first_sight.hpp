// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// First-sight correction: a loop closes on a landmark met before, and the routes driven since the
// last settled landmark share out the disagreement.
//
//   k --B_1-- o --B_2-- o --B_3-- a --B_n-- b'        b' where dead reckoning puts b
//                                           : u       u = p_b - p_b', imposed on the chain's end
//                                           b         p_b: where the map has it
//
// The chain is held at k, displaced by u at its end. Bars in series carry the same force, so with
// S_i the sum of the compliances B^-1 from k up to landmark i: u_i = S_i S_n^-1 u. No system to
// solve. Golfarelli, Maio & Rizzi (1998), section 3.2, with the closing route in the chain.
//
// Legs in the robot's own axes know their direction by the corner with the leg before. Turning at a
// corner, phi, carries all that comes after about it:
//
//   u_i = sum_{e < i} (S_e lambda + phi_e J (p_i - p_e)),  phi_e = c_e lambda . J (p_n - p_e)
//
// S_e a bar's compliance, c_e a corner's, J the quarter turn, and lambda the force at the end for
// which u_n = u: with all c_e = 0 the chain above.
//
// Which landmark is k:  b itself if it is on the chain (closed polygonal); else the landmark of
// the chain on which the loop that holds b hangs; else the chain's start (open polygonal). A new
// route between two settled landmarks closes a chain of one bar: nothing moves.
#pragma once

#include "trussmap/planar.hpp"

#include <utility>
#include <vector>

namespace trussmap::map {

/// Displacements of the joints along a chain held at its start, the end displaced by `imposed`:
/// one per bar, the last equal to `imposed`. `stiffnesses`: 2x2, symmetric positive definite, in
/// map axes, in order. Throws std::invalid_argument on an empty chain.
[[nodiscard]] std::vector<Vector2> chain_displacements(const std::vector<Matrix2>& stiffnesses,
                                                       const Vector2& imposed);

/// A leg of a chain whose directions hang on one another.
struct TurningLeg {
  Vector2 from = Vector2::Zero();        ///< where it begins, m
  Matrix2 compliance = Matrix2::Zero();  ///< S_e, map axes
  double turning = 0.0;                  ///< c_e, of the corner where it begins
};

/// The same of a chain with corners that yield; `end`: where the last leg ends, m. Zero where
/// nothing yields in the direction of `imposed`.
[[nodiscard]] std::vector<Vector2> turning_displacements(const std::vector<TurningLeg>& legs,
                                                         const Vector2& end,
                                                         const Vector2& imposed);

/// The chain of routes not yet corrected, and where settled loops hang. A call that throws leaves
/// it as it was.
class OpenChain {
 public:
  OpenChain() = default;

  /// As landmarks() and roots() were.
  OpenChain(std::vector<int> chain, std::vector<int> roots)
      : chain_(std::move(chain)), root_(std::move(roots)) {}

  /// Makes room for landmarks 0 ... count - 1: no other call with these will fail.
  void reserve(int count);

  struct Closing {
    std::vector<int> landmarks;  ///< k, then the chain's landmarks up to the last before b
    bool closed = false;         ///< closed polygonal: k is b
  };

  /// The robot stands on a settled landmark.
  void restart(int landmark);

  /// A new route a -> b to a landmark never met.
  void append(int a, int b);

  /// A new route a -> b to a landmark met before: the polygonal that closes. Does not change the
  /// chain; settle() does, once the displacements are known.
  [[nodiscard]] Closing closing(int a, int b) const;
  void settle(const Closing& closing, int b) noexcept;

  [[nodiscard]] const std::vector<int>& landmarks() const { return chain_; }

  /// Per landmark what its loop hangs on, -1: nothing; landmarks beyond its end: nothing.
  [[nodiscard]] const std::vector<int>& roots() const { return root_; }

 private:
  [[nodiscard]] int above(int landmark) const;
  [[nodiscard]] int top_of(int landmark) const;

  std::vector<int> chain_;
  std::vector<int> root_;  ///< settled landmark -> what its loop hangs on, or above it; else -1
};

}  // namespace trussmap::map
