// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// The stiffness method for a pin-jointed plane truss: plain structural mechanics, no robots.
//
//        f_j ->  o j
//               /         bar force at j: B (u_j - u_i), at i the opposite
//              / B          B      2x2 stiffness of the bar in map axes          force/m
//             /             u      displacement of a joint                       m
//     i o----'              f      load on a joint
//     /////  support        K u = f + reactions,  K = sum over bars of [B -B; -B B]
//
// A bar resists the displacement of its ends against each other both along its axis and across
// it (axial and rotational spring), so a connected truss held at one joint is determined. A bar
// carries the force B (u_j - u_i) at joint j and the opposite at i.
//
// Strain energy of the deformation: 1/2 sum (u_j - u_i)' B (u_j - u_i) = 1/2 u' K u.
// Cost: one sparse Cholesky factorisation (two unknowns per free joint), by CHOLMOD; where it takes
// 200 multiplications per joint or more by our frontal kernel, which is 1.3 times as fast there.
//
// How stiff a bar is, where it stands for something measured, is at the end.
#pragma once

#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct Bar {
  int i = 0;                            ///< joint
  int j = 0;                            ///< joint, not i
  Matrix2 stiffness = Matrix2::Zero();  ///< B, symmetric, in map axes
};

/// A joint held at a given displacement (zero = fixed).
struct Support {
  int joint = 0;
  Vector2 displacement = Vector2::Zero();  ///< m
};

struct Load {
  int joint = 0;
  Vector2 force = Vector2::Zero();
};

struct Deflection {
  std::vector<Vector2> displacements;  ///< per joint, m
  std::vector<Vector2> reactions;      ///< per joint: K u - f; zero at free joints
  std::vector<Vector2> bar_forces;     ///< per bar: B (u_j - u_i), the force it exerts through j
  double strain_energy = 0.0;          ///< 1/2 u' K u
};

/// A joint that nothing holds: its part of the truss has no support, or its bars leave it free to
/// slide. The message speaks of "joint N"; callers who know better names use joint().
class UnsupportedJoint : public SolveError {
 public:
  UnsupportedJoint(int joint, const std::string& why)
      : SolveError("joint " + std::to_string(joint) + " " + why), joint_(joint), why_(why) {}
  [[nodiscard]] int joint() const { return joint_; }
  /// "can still slide: …", without the joint.
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  int joint_;
  std::string why_;
};

/// Displacements under loads and imposed displacements. Joints are 0 ... joints-1; a joint may
/// carry several loads (they add up) but one support. Throws std::invalid_argument on indices out
/// of range, UnsupportedJoint where the problem is undetermined.
[[nodiscard]] Deflection solve_truss(int joints, const std::vector<Bar>& bars,
                                     const std::vector<Support>& supports,
                                     const std::vector<Load>& loads);

/// A truss held by nothing, under loads of which only the part that does not move it as a whole is
/// applied (each connected part's mean load is taken off); the displacement of least norm.
[[nodiscard]] Deflection solve_floating_truss(int joints, const std::vector<Bar>& bars,
                                              const std::vector<Load>& loads);

/// The 4x4 stiffness matrix of one bar, degrees of freedom (u_ix, u_iy, u_jx, u_jy).
[[nodiscard]] Eigen::Matrix4d bar_matrix(const Matrix2& stiffness);

// ----------------------------------------
// How stiff a bar is, given how unsure the route is that it stands for.
//
//   C       covariance of one traversal of the route (mean over traversals), map axes   m^2
//   theta   orientation of the bar                                                      rad
//   t       number of traversals
//   C'      R(theta)' C R(theta): x' along the bar, y' across it                        m^2
//
// mean_error       B = R diag(t/dx, t/dy) R',  dx = sqrt(2/pi C'_11), dy = sqrt(2/pi C'_22)
//                  Golfarelli, Maio & Rizzi (1998), section 3.1: stiffness = 1/mean error.
//                  C'_12 is dropped.                                                    1/m
// variance         B = t C^-1, off-diagonal kept: stiffness = 1/variance, the weights of least
//                  squares; strain energy is then half of chi squared.                  1/m^2
//
// What was measured as a single number, with variance v, is a spring: a length, or an angle (then
// with an arm L, which weighs it beside lengths: the length of a bar that it turns, or less).
//
// mean_error       k = t L / sqrt(2/pi v)                                   1/m; of angles m/rad
// variance         k = t / v                                                1/m^2; 1/rad^2
//
// A law is a small value: pass it where bars are made.

enum class StiffnessLaw { mean_error, variance };

/// 2x2 stiffness of a bar in map axes. Throws std::invalid_argument unless C is positive definite
/// (for `printed`: positive along and across the bar) and t > 0.
[[nodiscard]] Matrix2 bar_stiffness(StiffnessLaw law, const Matrix2& covariance, double orientation,
                                    double traversals);

/// Stiffness of a spring for a number of this variance; `arm`: L, 1 for lengths. Throws
/// std::invalid_argument unless all are above 0.
[[nodiscard]] double spring_stiffness(StiffnessLaw law, double variance, double traversals,
                                      double arm = 1.0);

}  // namespace trussmap
