// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Headings first: what makes a pose graph hard is that angles wrap; all else is nearly linear.
//
//   z_e       heading difference measured by edge e = (i, j)                     rad
//   kappa_e   information on it                                                  1/rad^2
//   k_e       whole turns: theta_j - theta_i - z_e = 2 pi k_e + a small residual
//
// Once the k_e are known, headings are a linear least-squares problem,
//   min sum kappa_e (theta_j - theta_i - z_e - 2 pi k_e)^2
// (Carlone, Aragues, Castellanos & Bona, "A linear approximation for graph-based simultaneous
// localization and mapping", 2011). Only the k_e round closed loops matter: the *windings*. Two
// estimates with the same windings nearly always lie in the basin of the same minimum, so comparing
// windings tells cheaply whether a second descent could find anything new.
//
// The chordal relaxation needs no k_e: unit vectors u are freed of their length,
//   min sum kappa_e |u_j - R(z_e) u_i|^2
// (Martinec & Pajdla, 2007; Carlone, Tron, Daniilidis & Dellaert, 2015).
#pragma once

#include "linalg/block_system.hpp"
#include "trussmap/pose_graph.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace trussmap::pose_graph {

class HeadingSystem {
 public:
  /// `order`: of elimination, of all vertices. Where nothing holds the headings of a connected
  /// part, its first pose's is held.
  HeadingSystem(const PoseGraph& graph, const std::vector<std::uint8_t>& held,
                const std::vector<int>& order);

  /// Headings by least squares with the whole turns nearest to `estimates`; positions untouched.
  [[nodiscard]] std::vector<Pose> fit(const std::vector<Pose>& estimates);

  /// Headings by the chordal relaxation; held ones are taken from `estimates`.
  [[nodiscard]] std::vector<Pose> relax(const std::vector<Pose>& estimates);

  /// Whole turns of each edge, made independent of whole turns of single headings.
  [[nodiscard]] std::vector<int> windings(const std::vector<Pose>& estimates) const;

 private:
  struct Link {
    int from, to;
    double measured, information;
  };
  struct Branch {
    int link;
    bool forwards;
  };

  void span(const PoseGraph& graph, const std::vector<std::uint8_t>& held);
  [[nodiscard]] linalg::BlockSystem lay_out(int size) const;

  std::vector<Link> links_;              ///< edges with heading information
  std::vector<linalg::NodePair> pairs_;  ///< of the links
  std::vector<bool> fixed_;              ///< per vertex: heading not to be found here
  std::vector<int> order_;
  std::vector<Branch> tree_;  ///< a spanning forest, roots first
  std::optional<linalg::BlockSystem> angles_;
};

}  // namespace trussmap::pose_graph
