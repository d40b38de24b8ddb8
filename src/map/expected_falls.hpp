// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// By how much the summed variance of all landmarks falls when elements of a truss are measured
// once more.
//
//   P      covariance of the landmarks: flexibility of the truss with stiffness 1/variance     m^2
//   G      gradients of what is measured, a column each (of a bar two: its vector)
//   R      its variances: 1/stiffness, of a bar B^-1
//   D      P G: displacements under each gradient as a load                                    m^2
//   S      R + G' D: variance of what is measured, by the map and by itself
//
//   P becomes P - D S^-1 D', so that its trace falls by tr(S^-1 D' D)
//
// Aligned: D without what moves or turns the map as a whole, of which it knows nothing.
#pragma once

#include "map/map_mechanics.hpp"

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace trussmap::map {

class ExpectedFalls {
 public:
  /// Of a truss with stiffness 1/variance.
  ExpectedFalls(MapMechanics& mechanics, bool aligned);

  /// Of all of these together, each with the stiffness of what measures it. Throws SolveError where
  /// the truss's stiffnesses span too many magnitudes.
  double of(const std::vector<truss::Element>& measured);

 private:
  using Load = std::vector<std::pair<int, Vector2>>;  // joint, force
  using Key =
      std::tuple<std::array<int, 3>, truss::Element::Kind, int>;  // and which of its numbers
  struct Column {
    Load gradient;
    Eigen::VectorXd displacement;  ///< of all joints
    Eigen::VectorXd counted;       ///< the part of it that the sum of variances counts
  };

  [[nodiscard]] std::vector<Load> gradients(const truss::Element& one) const;
  const Column& column(const Key& key, const Load& gradient);
  [[nodiscard]] Eigen::VectorXd within_the_map(Eigen::VectorXd displacement) const;

  MapMechanics& mechanics_;
  bool aligned_;
  Eigen::VectorXd turn_;  ///< of all joints about their middle, of length 1
  std::map<Key, Column> columns_;
};

}  // namespace trussmap::map
