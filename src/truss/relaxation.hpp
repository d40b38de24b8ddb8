// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Relaxation: some joints of a truss come to equilibrium, all others held.
//
//   minimise the strain energy over   u_v = sum_m c_m(v) q_m(block of v)
//
//   u   displacement of a free joint                                       m
//   q   unknowns: two numbers per mode of a block
//   c   (1): every free joint a block of its own, or joints moved together; (1, x, y): joints of a
//       block moved, turned, stretched and sheared together, x and y their places in it
//
// Each step solves the block system that the elements at the free joints make there. It is exact
// where these are bars; other elements are linearised, and the step is halved until the energy of
// the elements at the free joints has fallen. A truss's energy never rises by it. What nothing
// holds stays where it is.
#pragma once

#include "linalg/band_cholesky.hpp"
#include "truss/elastic_truss.hpp"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace trussmap::truss {

struct FreeJoint {
  int joint = -1;
  int block = 0;                                       ///< 0, 1, ...
  Eigen::Vector3d c = Eigen::Vector3d(1.0, 0.0, 0.0);  ///< the first `modes` of them count
};

class Relaxation {
 public:
  /// `modes`: 1 or 3. Joint 0 and repeated joints must not be among the free ones. What throws is
  /// for want of memory, and leaves moves to the truss to roll back.
  void relax(ElasticTruss& truss, const std::vector<FreeJoint>& free, int modes,
             const Enough& enough = {});

 private:
  void look_up(const ElasticTruss& truss, const std::vector<FreeJoint>& free);
  void forget(const std::vector<FreeJoint>& free) noexcept;
  void order_blocks(const ElasticTruss& truss, const std::vector<FreeJoint>& free);
  [[nodiscard]] double energy(const ElasticTruss& truss) const;
  struct Share;
  int shares_of(const Element& element, const std::vector<FreeJoint>& free, int modes,
                const std::array<Vector2, 3>* gradient, std::array<Share, 3>& shares) const;
  void add_bar(const Element& bar, const Vector2& force, const Share& a, const Share& b, int modes);
  void add_scalar(double k, double strain, const Share& a, const Share& b, int modes);
  void assemble(const ElasticTruss& truss, const std::vector<FreeJoint>& free, int modes);
  [[nodiscard]] bool step(ElasticTruss& truss, const std::vector<FreeJoint>& free, int modes,
                          double enough);

  std::vector<int> place_;     ///< per joint of the truss: its place among the free ones, or -1
  std::vector<char> touched_;  ///< per element of the truss: in elements_
  std::vector<int> elements_;  ///< at free joints
  bool linear_ = true;         ///< all of them are bars
  std::vector<int> rank_;      ///< per block: its place in the system
  int band_ = 0;               ///< of blocks
  linalg::BandMatrix K_;
  Eigen::VectorXd f_;
  std::vector<Vector2> before_;
};

}  // namespace trussmap::truss
