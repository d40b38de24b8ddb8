// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "truss/truss.hpp"

#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

constexpr double kLeastCondition = 1e-14;

void check_joint(int joint, int joints) {
  if (joint < 0 || joint >= joints) {
    throw std::invalid_argument("joint " + std::to_string(joint) + " is not among the truss's " +
                                std::to_string(joints));
  }
}

void check_bars(int joints, const std::vector<Bar>& bars) {
  for (const Bar& bar : bars) {
    check_joint(bar.i, joints);
    check_joint(bar.j, joints);
    if (bar.i == bar.j) throw std::invalid_argument("a bar joins a joint to itself");
  }
}

std::vector<int> connected_parts(int joints, const std::vector<Bar>& bars) {
  std::vector<NodePair> pairs;
  pairs.reserve(bars.size());
  for (const Bar& bar : bars) pairs.push_back({bar.i, bar.j});
  return trussmap::connected_parts(joints, pairs);
}

void require_supports(int joints, const std::vector<Bar>& bars,
                      const std::vector<Support>& supports) {
  const std::vector<int> part = connected_parts(joints, bars);
  std::vector<bool> held(idx(joints), false);
  for (const Support& support : supports) {
    held[idx(part[idx(support.joint)])] = true;
  }
  for (int joint = 0; joint < joints; ++joint) {
    if (!held[idx(part[idx(joint)])]) {
      throw UnsupportedJoint(joint, "is tied to no support");
    }
  }
}

Eigen::VectorXd stacked(const std::vector<Vector2>& vectors) {
  Eigen::VectorXd result(2 * static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    result.segment<2>(2 * static_cast<Eigen::Index>(k)) = vectors[k];
  }
  return result;
}

/// Forces, reactions and energy that go with the displacements.
void complete(Deflection& deflection, const std::vector<Bar>& bars,
              const std::vector<Vector2>& forces) {
  deflection.reactions.assign(forces.size(), Vector2::Zero());
  deflection.bar_forces.reserve(bars.size());
  for (const Bar& bar : bars) {
    const auto i = idx(bar.i);
    const auto j = idx(bar.j);
    const Vector2 strain = deflection.displacements[j] - deflection.displacements[i];
    const Vector2 force = bar.stiffness * strain;
    deflection.bar_forces.push_back(force);
    deflection.strain_energy += 0.5 * strain.dot(force);
    deflection.reactions[j] += force;
    deflection.reactions[i] -= force;
  }
  for (std::size_t k = 0; k < forces.size(); ++k) deflection.reactions[k] -= forces[k];
}

std::vector<Vector2> summed(int joints, const std::vector<Load>& loads) {
  std::vector<Vector2> forces(idx(joints), Vector2::Zero());
  for (const Load& load : loads) {
    check_joint(load.joint, joints);
    forces[idx(load.joint)] += load.force;
  }
  return forces;
}

/// Factorises K over the free joints and solves; the free joint that can slide is named.
Eigen::VectorXd solve_free(const std::vector<Bar>& bars, const std::vector<int>& unknown,
                           const std::vector<int>& free_joints, const Eigen::VectorXd& rhs) {
  const SparseMatrix K = assemble(bars, unknown, static_cast<int>(free_joints.size()));
  SparseCholesky cholesky(Ordering::amd);
  cholesky.analyse(K);
  try {
    cholesky.factorise(K);
  } catch (const NotPositiveDefinite& failure) {
    throw UnsupportedJoint(free_joints[idx(failure.column() / 2)],
                           "can still slide: its bars do not hold it");
  }
  Eigen::VectorXd u = cholesky.solve(rhs);
  const Eigen::VectorXd residual = rhs - K.selfadjointView<Eigen::Lower>() * u;
  if (cholesky.reciprocal_condition() < kLeastCondition || !u.allFinite()) {
    Eigen::Index worst = 0;
    u.cwiseAbs().maxCoeff(&worst);
    throw UnsupportedJoint(free_joints[idx(worst / 2)], "can still slide: its bars hardly hold it");
  }
  u += cholesky.solve(residual);  // one step of refinement, for stiffnesses of many magnitudes
  return u;
}

}  // namespace

Eigen::Matrix4d bar_matrix(const Matrix2& stiffness) {
  Eigen::Matrix4d K;
  K << stiffness, -stiffness, -stiffness, stiffness;
  return K;
}

SparseMatrix assemble(const std::vector<Bar>& bars, const std::vector<int>& unknown,
                      int free_joints) {
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(10 * bars.size());
  const auto add_block = [&entries](int row, int column, const Matrix2& block) {
    for (int c = 0; c < 2; ++c) {
      for (int r = 0; r < 2; ++r) {
        if (2 * row + r >= 2 * column + c) {
          entries.emplace_back(2 * row + r, 2 * column + c, block(r, c));
        }
      }
    }
  };
  for (const Bar& bar : bars) {
    const int i = unknown[idx(bar.i)];
    const int j = unknown[idx(bar.j)];
    if (i >= 0) add_block(i, i, bar.stiffness);
    if (j >= 0) add_block(j, j, bar.stiffness);
    if (i >= 0 && j >= 0) add_block(std::max(i, j), std::min(i, j), -bar.stiffness);
  }
  const Eigen::Index unknowns = 2 * static_cast<Eigen::Index>(free_joints);
  SparseMatrix K(unknowns, unknowns);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

Deflection solve_truss(int joints, const std::vector<Bar>& bars,
                       const std::vector<Support>& supports, const std::vector<Load>& loads) {
  check_bars(joints, bars);
  std::vector<int> unknown(idx(joints), 0);
  Deflection result;
  result.displacements.assign(idx(joints), Vector2::Zero());
  for (const Support& support : supports) {
    check_joint(support.joint, joints);
    const auto joint = idx(support.joint);
    if (unknown[joint] < 0) throw std::invalid_argument("a joint has two supports");
    unknown[joint] = -1;
    result.displacements[joint] = support.displacement;
  }
  require_supports(joints, bars, supports);
  std::vector<int> free_joints;
  for (int joint = 0; joint < joints; ++joint) {
    if (unknown[idx(joint)] < 0) continue;
    unknown[idx(joint)] = static_cast<int>(free_joints.size());
    free_joints.push_back(joint);
  }
  const std::vector<Vector2> forces = summed(joints, loads);

  if (!free_joints.empty()) {
    // f_f - K_fs u_s: a held joint pulls at its neighbours.
    std::vector<Vector2> rhs(free_joints.size());
    for (std::size_t k = 0; k < free_joints.size(); ++k) {
      rhs[k] = forces[idx(free_joints[k])];
    }
    for (const Bar& bar : bars) {
      const int i = unknown[idx(bar.i)];
      const int j = unknown[idx(bar.j)];
      const Vector2& u_i = result.displacements[idx(bar.i)];
      const Vector2& u_j = result.displacements[idx(bar.j)];
      if (i >= 0 && j < 0) rhs[idx(i)] += bar.stiffness * u_j;
      if (j >= 0 && i < 0) rhs[idx(j)] += bar.stiffness * u_i;
    }
    const Eigen::VectorXd u = solve_free(bars, unknown, free_joints, stacked(rhs));
    for (std::size_t k = 0; k < free_joints.size(); ++k) {
      result.displacements[idx(free_joints[k])] = u.segment<2>(2 * static_cast<Eigen::Index>(k));
    }
  }
  complete(result, bars, forces);
  return result;
}

Deflection solve_floating_truss(int joints, const std::vector<Bar>& bars,
                                const std::vector<Load>& loads) {
  check_bars(joints, bars);
  const std::vector<int> part = connected_parts(joints, bars);
  const auto part_of = [&part](std::size_t joint) { return idx(part[joint]); };
  const auto n = idx(joints);
  std::vector<Vector2> forces = summed(joints, loads);

  std::vector<double> size(n, 0.0);
  std::vector<Vector2> sum(n, Vector2::Zero());
  for (std::size_t joint = 0; joint < n; ++joint) {
    size[part_of(joint)] += 1.0;
    sum[part_of(joint)] += forces[joint];
  }
  std::vector<Load> balanced;
  std::vector<Support> grounds;  // any one joint of each part; taken back below
  for (std::size_t joint = 0; joint < n; ++joint) {
    balanced.push_back(
        {static_cast<int>(joint), forces[joint] - sum[part_of(joint)] / size[part_of(joint)]});
    if (part_of(joint) == joint) grounds.push_back({static_cast<int>(joint), Vector2::Zero()});
  }
  Deflection result = solve_truss(joints, bars, grounds, balanced);

  std::vector<Vector2> mean(n, Vector2::Zero());
  for (std::size_t joint = 0; joint < n; ++joint) {
    mean[part_of(joint)] += result.displacements[joint] / size[part_of(joint)];
  }
  for (std::size_t joint = 0; joint < n; ++joint) {
    result.displacements[joint] -= mean[part_of(joint)];
  }
  return result;
}

}  // namespace trussmap
