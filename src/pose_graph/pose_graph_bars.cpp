// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What each bar adds to chi^2, forces and stiffness: the inner loop of the adjustment.
#include "estimation/held_unknowns.hpp"
#include "pose_graph/pose_graph_system.hpp"

#include <cmath>
#include <numbers>

namespace trussmap::pose_graph {
namespace {

/// wrap_angle, quick where there is nothing to wrap.
double wrapped(double angle) {
  return std::abs(angle) < std::numbers::pi ? angle : wrap_angle(angle);
}

}  // namespace

template <bool kEquations>
double PoseGraphSystem::evaluate(const std::vector<Pose>& estimates) {
  for (std::size_t v = 0; v < estimates.size(); ++v) {
    directions_[v] = {std::cos(estimates[v].heading), std::sin(estimates[v].heading)};
  }
  double chi2 = 0.0;
  int pair = 0;
  for (const Bar3& bar : pose_bars_) chi2 += add_bar<kEquations>(bar, pair++, estimates);
  for (const Bar2& bar : vector_bars_) chi2 += add_bar<kEquations>(bar, pair++, estimates);
  return chi2;
}

template <bool kEquations>
double PoseGraphSystem::add_bar(const Bar3& bar, int pair, const std::vector<Pose>& estimates) {
  const Pose& from = estimates[idx(bar.from)];
  const Pose& to = estimates[idx(bar.to)];
  const Direction near = directions_[idx(bar.from)];
  const double c = near.cos * bar.cos - near.sin * bar.sin;
  const double s = near.sin * bar.cos + near.cos * bar.sin;
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double ex = c * dx + s * dy - bar.x;
  const double ey = c * dy - s * dx - bar.y;
  const double et = wrapped(to.heading - from.heading - bar.heading);
  const double ux = bar.xx * ex + bar.xy * ey + bar.xt * et;
  const double uy = bar.xy * ex + bar.yy * ey + bar.yt * et;
  const double ut = bar.xt * ex + bar.yt * ey + bar.tt * et;
  if constexpr (kEquations) {
    const double fx = c * ux - s * uy;
    const double fy = s * ux + c * uy;
    add_force(bar.to, Eigen::Vector3d(fx, fy, ut));
    add_force(bar.from, Eigen::Vector3d(-fx, -fy, dy * fx - dx * fy - ut));
    const double mx = bar.xx * c - bar.xy * s;
    const double my = bar.xy * c - bar.yy * s;
    const double nx = bar.xx * s + bar.xy * c;
    const double ny = bar.xy * s + bar.yy * c;
    Matrix3 B;
    B(0, 0) = c * mx - s * my;
    B(0, 1) = B(1, 0) = c * nx - s * ny;
    B(1, 1) = s * nx + c * ny;
    B(0, 2) = B(2, 0) = c * bar.xt - s * bar.yt;
    B(1, 2) = B(2, 1) = s * bar.xt + c * bar.yt;
    B(2, 2) = bar.tt;
    add_stiffness(bar, pair, B, dx, dy);
  }
  return ex * ux + ey * uy + et * ut;
}

/// T' B T, B and -T' B into their places; the lever is q = (-dy, dx).
void PoseGraphSystem::add_stiffness(const Bar3& bar, int pair, Matrix3& B, double dx, double dy) {
  Matrix3 lever = B;
  lever.row(2) += dx * B.row(1) - dy * B.row(0);
  Matrix3 near_block = lever;
  near_block.col(2) += dx * lever.col(1) - dy * lever.col(0);
  Matrix3 coupling = -lever;
  if ((pinned_[idx(bar.from)] | pinned_[idx(bar.to)]) != estimation::held_nothing) {
    mask(bar.from, near_block);
    mask(bar.to, B);
    for (int k = 0; k < 3; ++k) {
      if (estimation::is_held(pinned_[idx(bar.from)], k)) coupling.row(k).setZero();
      if (estimation::is_held(pinned_[idx(bar.to)], k)) coupling.col(k).setZero();
    }
  }
  normal_.add_diagonal(bar.from, near_block);
  normal_.add_diagonal(bar.to, B);
  normal_.add_coupling(pair, coupling);
}

template <bool kEquations>
double PoseGraphSystem::add_bar(const Bar2& bar, int pair, const std::vector<Pose>& estimates) {
  const Pose& from = estimates[idx(bar.from)];
  const Pose& to = estimates[idx(bar.to)];
  const Direction near = bar.from_pose ? directions_[idx(bar.from)] : Direction{};
  const double c = near.cos;
  const double s = near.sin;
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double ex = c * dx + s * dy - bar.x;
  const double ey = c * dy - s * dx - bar.y;
  const double ux = bar.xx * ex + bar.xy * ey;
  const double uy = bar.xy * ex + bar.yy * ey;
  if constexpr (kEquations) {
    const Vector2 f(c * ux - s * uy, s * ux + c * uy);
    Matrix2 A;
    A << c, s, -s, c;
    const Matrix2 omega = (Matrix2() << bar.xx, bar.xy, bar.xy, bar.yy).finished();
    Matrix2 B = A.transpose() * omega * A;
    const bool far_pinned = (pinned_[idx(bar.to)] & estimation::held_position) != 0;
    const bool near_pinned = (pinned_[idx(bar.from)] & estimation::held_position) != 0;
    if (bar.from_pose) {
      Eigen::Matrix<double, 3, 2> lever;
      lever.topRows<2>() = B;
      lever.row(2) = dx * B.row(1) - dy * B.row(0);
      Matrix3 near_block;
      near_block.leftCols<2>() = lever;
      near_block.col(2) = dx * lever.col(1) - dy * lever.col(0);
      Eigen::Matrix<double, 3, 2> coupling = -lever;
      if (near_pinned) coupling.topRows<2>().setZero();
      if ((pinned_[idx(bar.from)] & estimation::held_heading) != 0) coupling.row(2).setZero();
      mask(bar.from, near_block);
      normal_.add_diagonal(bar.from, near_block);
      if (!far_pinned) normal_.add_coupling(pair, coupling);
      add_force(bar.from, Eigen::Vector3d(-f.x(), -f.y(), dy * f.x() - dx * f.y()));
    } else {
      normal_.add_diagonal(bar.from, B);
      normal_.add_coupling(pair, Matrix2(-B));
      add_force(bar.from, Vector2(-f));
    }
    normal_.add_diagonal(bar.to, B);
    add_force(bar.to, f);
  }
  return ex * ux + ey * uy;
}

/// Empties the rows and columns of what is pinned.
template <int N>
void PoseGraphSystem::mask(int vertex, Eigen::Matrix<double, N, N>& diagonal) const {
  for (int k = 0; k < N; ++k) {
    if (!estimation::is_held(pinned_[idx(vertex)], k)) continue;
    diagonal.row(k).setZero();
    diagonal.col(k).setZero();
  }
}

void PoseGraphSystem::add_force(int vertex, const Eigen::Vector3d& force) {
  if (normal_.size(vertex) > 0) gradient_.segment<3>(normal_.offset(vertex)) += force;
}

void PoseGraphSystem::add_force(int vertex, const Vector2& force) {
  if (normal_.size(vertex) > 0) gradient_.segment<2>(normal_.offset(vertex)) += force;
}

template double PoseGraphSystem::evaluate<true>(const std::vector<Pose>&);
template double PoseGraphSystem::evaluate<false>(const std::vector<Pose>&);

double PoseGraphSystem::strain_energy(const std::vector<Pose>& estimates,
                                      const Eigen::VectorXd& displacement) const {
  const auto at = [&](int vertex) {
    Eigen::Vector3d u = Eigen::Vector3d::Zero();
    const int size = normal_.size(vertex);
    if (size > 0) u.head(size) = displacement.segment(normal_.offset(vertex), size);
    return u;
  };
  // dX_j - T dX_i, its position part turned into the measurement's axes.
  const auto strain = [&](int from, int to, double angle) {
    const Vector2 d = estimates[idx(to)].position() - estimates[idx(from)].position();
    const Eigen::Vector3d u = at(from);
    Eigen::Vector3d e = at(to) - u;
    e.head<2>() -= quarter_turn(d) * u.z();
    e.head<2>() = rotation(angle).transpose() * e.head<2>();
    return e;
  };
  double energy = 0.0;
  for (const Bar3& bar : pose_bars_) {
    const Eigen::Vector3d e =
        strain(bar.from, bar.to, estimates[idx(bar.from)].heading + bar.heading);
    const Matrix3 omega =
        (Matrix3() << bar.xx, bar.xy, bar.xt, bar.xy, bar.yy, bar.yt, bar.xt, bar.yt, bar.tt)
            .finished();
    energy += e.dot(omega * e);
  }
  for (const Bar2& bar : vector_bars_) {
    const double angle = bar.from_pose ? estimates[idx(bar.from)].heading : 0.0;
    const Vector2 e = strain(bar.from, bar.to, angle).head<2>();
    energy += bar.xx * e.x() * e.x() + 2.0 * bar.xy * e.x() * e.y() + bar.yy * e.y() * e.y();
  }
  return energy;
}

}  // namespace trussmap::pose_graph
