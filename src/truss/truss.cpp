// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/truss.hpp"

#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"
#include "truss/truss_system.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

// From so many multiplications per joint on our frontal kernel is at least 1.3 times as fast as
// CHOLMOD, below it is not, and of few joints CHOLMOD is the faster one. A square grid has as many
// from 900 joints on, a town's streets from 80 000 (bench/truss_bench.cpp, figures in
// bench/README.md).
constexpr double kFrontalPays = 200.0;

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

std::vector<linalg::NodePair> ends_of(const std::vector<Bar>& bars) {
  std::vector<linalg::NodePair> ends;
  ends.reserve(bars.size());
  for (const Bar& bar : bars) ends.push_back({bar.i, bar.j});
  return ends;
}

void require_supports(int joints, const std::vector<linalg::NodePair>& ends,
                      const std::vector<Support>& supports) {
  const std::vector<int> part = linalg::connected_parts(joints, ends);
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

}  // namespace

Eigen::Matrix4d bar_matrix(const Matrix2& stiffness) {
  Eigen::Matrix4d K;
  K << stiffness, -stiffness, -stiffness, stiffness;
  return K;
}

Deflection solve_truss(int joints, const std::vector<Bar>& bars,
                       const std::vector<Support>& supports, const std::vector<Load>& loads) {
  check_bars(joints, bars);
  std::vector<bool> held(idx(joints), false);
  std::vector<Vector2> imposed(idx(joints), Vector2::Zero());
  for (const Support& support : supports) {
    check_joint(support.joint, joints);
    const auto joint = idx(support.joint);
    if (held[joint]) throw std::invalid_argument("a joint has two supports");
    held[joint] = true;
    imposed[joint] = support.displacement;
  }
  const std::vector<Vector2> forces = summed(joints, loads);
  const std::vector<linalg::NodePair> ends = ends_of(bars);
  require_supports(joints, ends, supports);

  const linalg::Elimination plan = linalg::plan_elimination(joints, ends);
  const bool large = plan.multiplications >= kFrontalPays * joints;
  truss::TrussSystem K(held, ends, plan.order,
                       large ? linalg::Kernel::frontal : linalg::Kernel::cholmod);
  std::vector<Vector2> on_free = forces;
  for (std::size_t k = 0; k < bars.size(); ++k) {
    const Bar& bar = bars[k];
    K.add_bar(static_cast<int>(k), bar.stiffness);
    // f_f - K_fs u_s: a held joint pulls at its neighbours.
    if (held[idx(bar.j)]) on_free[idx(bar.i)] += bar.stiffness * imposed[idx(bar.j)];
    if (held[idx(bar.i)]) on_free[idx(bar.j)] += bar.stiffness * imposed[idx(bar.i)];
  }
  K.factorise();
  Deflection result;
  result.displacements = K.solve(on_free);
  for (const Support& support : supports) {
    result.displacements[idx(support.joint)] = support.displacement;
  }
  complete(result, bars, forces);
  return result;
}

Deflection solve_floating_truss(int joints, const std::vector<Bar>& bars,
                                const std::vector<Load>& loads) {
  check_bars(joints, bars);
  const std::vector<int> part = linalg::connected_parts(joints, ends_of(bars));
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
