// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map's truss as a map builder drives it on: joints are landmarks, by the same numbers, and after
// a route's averages have changed the map is relaxed within a scope.
//
//   nearest      the eta landmarks nearest to the route's middle come to equilibrium, all others
//                held; then, scale by scale, the nearest groups of landmarks, each moved, turned
//                and sheared as one. Of a truss of bars at every scale, by sums
//                (scale_sums.hpp); where there are lengths, corners or directions, landmark by
//                landmark and so up to kMostMembers of them at a scale
//   all          the equilibrium of the whole (truss/equilibrium.hpp)
//   automatic    all, up to kMostExact landmarks; beyond, nearest at every scale
//   estimated    nearest, eta by a bound: round the route, ring by ring of neighbours, until
//
//                  F / (sum of the stiffnesses of elements that leave the piece)
//
//                is below a tenth of what the stiffest of them yields to its own uncertainty; F the
//                force that is out of balance at the route's ends. No more than F crosses a cut.
//
// Every step is a minimisation over a subspace: the energy of the whole never rises.
#pragma once

#include "map/nearest_landmarks.hpp"
#include "map/scale_groups.hpp"
#include "map/scale_sums.hpp"
#include "truss/elastic_truss.hpp"
#include "truss/equilibrium.hpp"
#include "truss/relaxation.hpp"
#include "trussmap/map_builder.hpp"

#include <utility>
#include <vector>

namespace trussmap::map {

/// Landmarks up to which `automatic` is `all`: a correction takes a millisecond or two there.
inline constexpr int kMostExact = 10000;

class MapMechanics {
 public:
  MapMechanics(const RefinementScope& scope, StiffnessLaw law) : scope_(scope), law_(law) {}

  void set_scope(const RefinementScope& scope) { scope_ = scope; }

  /// Its joints may lie where they were last looked at: see position().
  [[nodiscard]] const truss::ElasticTruss& truss() const { return truss_; }

  /// Whether landmarks may have moved with their groups, unseen.
  [[nodiscard]] bool groups_move() const { return !sums_.empty(); }
  /// Where a landmark is now.
  [[nodiscard]] Vector2 position(int landmark) const {
    return sums_.empty() ? truss_.position(landmark) : sums_.position(truss_, landmark);
  }
  /// Of all elements.
  [[nodiscard]] double energy() const;
  /// What happened since begin(), m.
  struct Moves {
    int landmarks = 0;  ///< by more than 1e-12 m
    double largest = 0.0;
  };
  [[nodiscard]] Moves moves() noexcept;

  /// Makes the changes of `call`, all or, where it throws, none; then commit().
  template <typename Call>
  void change(const Call& call) {
    begin();
    try {
      call();
    } catch (...) {
      roll_back();
      throw;
    }
  }
  /// Lets the spatial index and the groups follow what has moved.
  void commit() noexcept;

  /// Reached from an earlier landmark; -1: the first.
  int add_landmark(const Vector2& position, int from);
  int add_element(const truss::Element& element);
  void set_element(int number, const truss::Element& element);
  void move(int landmark, const Vector2& to);
  /// All landmarks in the truss are where they are now: before much is moved by itself.
  void settle() noexcept;

  /// After the route between two landmarks has changed. Returns how many landmarks, or members of
  /// groups, were let free. Throws SolveError where stiffnesses span too many magnitudes.
  int relax(int i, int j);
  /// The whole comes to equilibrium, whatever the scope.
  void relax_all();

  /// The landmarks nearest to a point, in ascending order.
  [[nodiscard]] std::vector<int> nearest(const Vector2& to, int count) const {
    return sums_.empty() ? index_.nearest(truss_.positions(), to, count)
                         : sums_.nearest(truss_, to, count);
  }

  /// The landmarks that a refinement of the route between two lets free, the first one and the
  /// route's ends among them: all, the nearest, or as many as are estimated to move. Ascending.
  [[nodiscard]] std::vector<int> members(int i, int j) const;

  /// Displacements of all landmarks under loads: landmarks, and the force on each. Throws
  /// SolveError, as the next two do, where stiffnesses span too many magnitudes.
  [[nodiscard]] std::vector<Vector2> displacements(
      const std::vector<std::pair<int, Vector2>>& loads);
  /// What a pull of two landmarks apart does to the vector between them.
  [[nodiscard]] Matrix2 flexibility_between(int i, int j);
  /// Per landmark, the first one held.
  [[nodiscard]] std::vector<Matrix2> flexibilities() const;

  /// Throws SolveError where a landmark came to lie nowhere since begin().
  void require_finite() const;

 private:
  void begin() noexcept {
    truss_.begin();
    sums_.begin();
    touched_ = 0;
    at_rest_ = false;
  }
  void roll_back() noexcept;
  [[nodiscard]] bool exact() const;
  int relax_nearest(int i, int j);
  [[nodiscard]] int estimated_eta(int i, int j) const;
  void relax_scales(int i, int j, const Vector2& middle);
  [[nodiscard]] std::vector<int> nearest_groups(int level, int i, int j,
                                                const Vector2& middle) const;
  int relax_members(int level, const std::vector<int>& groups);
  void touch_moved() noexcept;
  void element_changed(int number);
  void grow_groups();

  RefinementScope scope_;
  StiffnessLaw law_;
  truss::ElasticTruss truss_;
  bool at_rest_ = false;  ///< all came to equilibrium since begin()
  truss::Relaxation relaxation_;
  truss::Equilibrium equilibrium_;
  NearestLandmarks index_;
  std::vector<int> from_;  ///< per landmark
  ScaleGroups groups_;     ///< of the first grouped_ landmarks and tied_ elements
  int grouped_ = 0;
  int tied_ = 0;
  ScaleSums sums_;             ///< of the truss, while it is relaxed by groups
  std::size_t touched_ = 0;    ///< of the truss's moves: known to the sums
  int others_ = 0;             ///< elements other than bars
  std::vector<char> counted_;  ///< per landmark, of moves()
};

}  // namespace trussmap::map
