// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A truss whose elements have shapes at rest: where joints lie otherwise, elements are strained and
// pull. Plain structural mechanics, no robots.
//
//   bar         1/2 (d - w)' B (d - w)     d = p_j - p_i, w its shape at rest [m], B 2x2
//   length      1/2 k (s - |d|)^2          an axial spring: s its length at rest [m]
//   direction   1/2 k (a - angle(d))^2     fastened to the ground: a at rest [rad]
//
//                   o k
//                  /
//     i o----->o j' angle c               corner: angle from direction i->j to direction j->k
//
//   corner      1/2 k (c - (angle(p_k - p_j) - angle(p_j - p_i)))^2
//
// Angles differ by (-pi, pi]. Joint 0 is held. Bars alone make the energy quadratic in the
// positions. An element with two joints in one place has no direction: it does not pull there.
//
// All that changes between begin() and commit() can be taken back.
#pragma once

#include "geometry/index.hpp"
#include "trussmap/planar.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace trussmap::truss {

struct Element {
  enum class Kind : std::uint8_t { bar, length, direction, corner };
  Kind kind = Kind::bar;
  std::array<int, 3> joints{-1, -1, -1};  ///< i, j and, of a corner, k
  Matrix2 B = Matrix2::Zero();            ///< of a bar: symmetric, map axes
  Vector2 w = Vector2::Zero();            ///< of a bar: shape at rest, m
  double k = 0.0;                         ///< of the others: stiffness
  double rest = 0.0;                      ///< of the others: m or rad

  [[nodiscard]] int count() const { return kind == Kind::corner ? 3 : 2; }
};

[[nodiscard]] Element bar_element(int i, int j, const Matrix2& B, const Vector2& w);
[[nodiscard]] Element length_element(int i, int j, double k, double length);
[[nodiscard]] Element direction_element(int i, int j, double k, double angle);
[[nodiscard]] Element corner_element(int i, int j, int k, double stiffness, double angle);

/// An element where its joints are: up to three joints, a force and a stiffness between each two.
struct Tangent {
  std::array<Vector2, 3> force;                     ///< on each joint, minus the energy's gradient
  std::array<std::array<Matrix2, 3>, 3> stiffness;  ///< Gauss-Newton
};

class ElasticTruss {
 public:
  int add_joint(const Vector2& position);
  int add_element(const Element& element);
  /// Its joints stay the same.
  void set_element(int number, const Element& element);
  void move(int joint, const Vector2& to);
  /// Where the joint was all along, told by somebody who knew: no move, and not taken back.
  void place(int joint, const Vector2& at) noexcept { positions_[idx(joint)] = at; }

  void begin() noexcept;
  void commit() noexcept { begin(); }
  void roll_back() noexcept;

  [[nodiscard]] int joints() const { return static_cast<int>(positions_.size()); }
  [[nodiscard]] int elements() const { return static_cast<int>(elements_.size()); }
  [[nodiscard]] const Vector2& position(int joint) const { return positions_[idx(joint)]; }
  [[nodiscard]] const std::vector<Vector2>& positions() const { return positions_; }
  [[nodiscard]] const Element& element(int number) const { return elements_[idx(number)]; }
  [[nodiscard]] const std::vector<int>& elements_at(int joint) const { return at_[idx(joint)]; }

  /// Joints moved since begin(), each with where it was at first; may name a joint twice.
  [[nodiscard]] const std::vector<std::pair<int, Vector2>>& moved() const { return moved_; }

  /// Asks memory for all that is at some joints at once: in a large truss none of it is in the
  /// cache, and one after the other these are some hundred waits.
  void fetch(const std::vector<int>& joints) const noexcept;

  [[nodiscard]] double energy(int number) const;
  /// Of all elements.
  [[nodiscard]] double energy() const;
  [[nodiscard]] Tangent tangent(int number) const;

 private:
  std::vector<Vector2> positions_;
  std::vector<Element> elements_;
  std::vector<std::vector<int>> at_;  ///< per joint: its elements

  int joints_then_ = 0;
  int elements_then_ = 0;
  std::vector<std::pair<int, Vector2>> moved_;
  std::vector<std::pair<int, Element>> changed_;
};

/// When a truss with elements other than bars has come close enough to equilibrium.
struct Enough {
  int rounds = 60;    ///< linearisations at most
  double gain = 0.0;  ///< the last one was to gain so little, as a share of the energy
};

/// A scalar element's strain (rest - present, wrapped) and its present value's gradient, per joint.
struct Strain {
  double value = 0.0;
  std::array<Vector2, 3> gradient;
};
[[nodiscard]] Strain strain_of(const ElasticTruss& truss, const Element& element);

}  // namespace trussmap::truss
