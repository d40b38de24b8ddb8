// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_lifting.hpp"

#include "linalg/block_system.hpp"
#include "pose_graph/pose_graph_chain.hpp"
#include "pose_graph/pose_graph_gauge.hpp"

#include <cmath>
#include <complex>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace trussmap::pose_graph {
namespace {

constexpr int kRank = 3;
constexpr int kMostSteps = 1000;
constexpr int kLook = 25;               // steps between two looks at whether the search may end
constexpr double kLeastGain = 1e-9;     // relative decrease per step at which to stop
constexpr double kHoldingWeight = 1e4;  // of a half-held pose, relative to its own stiffness
constexpr double kFirstSpread = 0.5;    // of the random part at the beginning

using Lifted = Eigen::Matrix<double, Eigen::Dynamic, kRank>;  // rows: real, imaginary parts
using Column2 = Eigen::Matrix<double, 2, 1>;

/// Multiplication by the complex number (x, y).
Matrix2 times(double x, double y) {
  return (Matrix2() << x, -y, y, x).finished();
}

/// Information per coordinate: that of the mean variance where there is one.
double isotropic(const Matrix2& information) {
  const double trace = information.trace();
  return trace > 0.0 ? 2.0 * std::max(information.determinant(), 0.0) / trace : 0.0;
}

class Lifting {
 public:
  Lifting(const PoseGraph& graph, const std::vector<std::uint8_t>& held,
          const std::vector<int>& order)
      : graph_(graph), held_(held), pairs_(pairs_of(graph)), system_(sizes(), pairs_, order) {
    load_.setZero(system_.unknowns());
    int pair = 0;
    for (const PoseEdge& edge : graph.pose_edges) add(edge, pair++);
    for (const PointEdge& edge : graph.point_edges) add(edge, pair++);
    for (const DisplacementEdge& edge : graph.displacement_edges) add(edge, pair++);
    hold_halves();
    const Eigen::VectorXd diagonal = system_.diagonal();
    system_.set_diagonal((1.0 + 1e-9) * diagonal +
                         Eigen::VectorXd::Constant(diagonal.size(), 1e-12 * diagonal.maxCoeff()));
    system_.factorise();
    system_.set_diagonal(diagonal);
  }

  std::vector<Pose> solve(std::uint64_t seed,
                          const std::function<bool(const std::vector<Pose>&)>& enough) {
    Lifted Y = begin(seed);
    Lifted gradient = riemannian_gradient(Y);
    Lifted direction;
    double cost = cost_of(Y);
    double slope_before = 0.0;
    Lifted gradient_before = gradient;
    for (int step = 0; step < kMostSteps; ++step) {
      const Lifted preconditioned = tangent(Y, system_.solve(gradient));
      const double slope = gradient.cwiseProduct(preconditioned).sum();
      if (!(slope > 0.0)) break;
      if (step == 0) {
        direction = -preconditioned;
      } else {  // Polak-Ribiere, restarted where it would lead back
        const double change = preconditioned.cwiseProduct(gradient - gradient_before).sum();
        const double beta = std::max(0.0, change / slope_before);
        direction = tangent(Y, Lifted(beta * direction)) - preconditioned;
        if (direction.cwiseProduct(gradient).sum() >= 0.0) direction = -preconditioned;
      }
      const double before = cost;
      if (!advance(Y, direction, cost)) break;
      if (before - cost <= kLeastGain * (std::abs(cost) + 1e-12)) break;
      if ((step + 1) % kLook == 0 && enough(round(Y))) break;
      gradient_before = gradient;
      slope_before = slope;
      gradient = riemannian_gradient(Y);
    }
    return round(Y);
  }

 private:
  static std::vector<linalg::NodePair> pairs_of(const PoseGraph& graph) {
    std::vector<linalg::NodePair> pairs;
    for (const PoseEdge& e : graph.pose_edges) pairs.push_back({e.from, e.to});
    for (const PointEdge& e : graph.point_edges) pairs.push_back({e.pose, e.point});
    for (const DisplacementEdge& e : graph.displacement_edges) pairs.push_back({e.from, e.to});
    return pairs;
  }

  [[nodiscard]] std::vector<int> sizes() const {
    std::vector<int> result;
    for (std::size_t v = 0; v < held_.size(); ++v) {
      const bool pose = is_pose(graph_.vertices[v]);
      const std::uint8_t whole = pose ? estimation::held_all : estimation::held_position;
      result.push_back((held_[v] & whole) == whole ? 0 : (pose ? 4 : 2));
    }
    return result;
  }

  /// A held vertex's (y, p), p alone for a point.
  [[nodiscard]] Eigen::VectorXd constant(int vertex) const {
    const GraphVertex& v = graph_.vertices[idx(vertex)];
    const Pose at = v.estimate.value_or(Pose{});
    if (!is_pose(v)) return at.position();
    return Eigen::Vector4d(std::cos(at.heading), std::sin(at.heading), at.x, at.y);
  }

  /// Adds weight |a_i v_i + a_j v_j - c|^2, v the vertices' unknowns.
  template <int Ni, int Nj>
  void add_row(int pair, int i, int j, const Eigen::Matrix<double, 2, Ni>& a_i,
               const Eigen::Matrix<double, 2, Nj>& a_j, Column2 c, double weight) {
    if (system_.size(i) == 0) c -= a_i * constant(i);
    if (system_.size(j) == 0) c -= a_j * constant(j);
    system_.add_diagonal<Ni>(i, weight * a_i.transpose() * a_i);
    system_.add_diagonal<Nj>(j, weight * a_j.transpose() * a_j);
    system_.add_coupling<Ni, Nj>(pair, weight * a_i.transpose() * a_j);
    if (system_.size(i) > 0) {
      load_.segment<Ni>(system_.offset(i)) += weight * a_i.transpose() * c;
    }
    if (system_.size(j) > 0) {
      load_.segment<Nj>(system_.offset(j)) += weight * a_j.transpose() * c;
    }
  }

  void add(const PoseEdge& edge, int pair) {
    using Row = Eigen::Matrix<double, 2, 4>;
    const Matrix2 I = Matrix2::Identity();
    const Matrix2 O = Matrix2::Zero();
    const Row turn_i = (Row() << -rotation(edge.measured.heading), O).finished();
    const Row turn_j = (Row() << I, O).finished();
    add_row<4, 4>(pair, edge.from, edge.to, turn_i, turn_j, Column2::Zero(),
                  heading_information(edge));
    const Row shift_i = (Row() << -times(edge.measured.x, edge.measured.y), -I).finished();
    const Row shift_j = (Row() << O, I).finished();
    add_row<4, 4>(pair, edge.from, edge.to, shift_i, shift_j, Column2::Zero(),
                  isotropic(edge.information.topLeftCorner<2, 2>()));
  }

  void add(const PointEdge& edge, int pair) {
    using Row = Eigen::Matrix<double, 2, 4>;
    const Row shift =
        (Row() << -times(edge.measured.x(), edge.measured.y()), -Matrix2::Identity()).finished();
    add_row<4, 2>(pair, edge.pose, edge.point, shift, Matrix2::Identity(), Column2::Zero(),
                  isotropic(edge.information));
  }

  void add(const DisplacementEdge& edge, int pair) {
    add_row<2, 2>(pair, edge.from, edge.to, -Matrix2::Identity(), Matrix2::Identity(),
                  edge.measured, isotropic(edge.information));
  }

  /// A pose whose heading or position alone is held is drawn to it strongly.
  void hold_halves() {
    const Eigen::VectorXd diagonal = system_.diagonal();
    for (int v = 0; v < static_cast<int>(held_.size()); ++v) {
      if (system_.size(v) != 4 || held_[idx(v)] == estimation::held_nothing) continue;
      const Eigen::Vector4d at = constant(v);
      const bool heading = (held_[idx(v)] & estimation::held_heading) != 0;
      const int offset = system_.offset(v);
      Eigen::Vector4d weights = kHoldingWeight * diagonal.segment<4>(offset);
      (heading ? weights.tail<2>() : weights.head<2>()).setZero();
      system_.add_diagonal<4>(v, weights.asDiagonal());
      load_.segment<4>(offset) += weights.cwiseProduct(at);
    }
  }

  [[nodiscard]] bool is_free_pose(int vertex) const { return system_.size(vertex) == 4; }

  /// The free minimum of F, its headings made unit vectors and shaken in the added dimensions.
  Lifted begin(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Lifted Y = Lifted::Zero(system_.unknowns(), kRank);
    Eigen::VectorXd flat = load_;
    system_.solve_in_place(flat);
    Y.col(0) = flat;
    for (int v = 0; v < static_cast<int>(held_.size()); ++v) {
      if (!is_free_pose(v)) continue;
      auto y = Y.block<2, kRank>(system_.offset(v), 0);
      const double length = y.norm();
      if (length > 0.0) y /= length;
      for (int c = 0; c < kRank; ++c) {
        for (int r = 0; r < 2; ++r) y(r, c) += kFirstSpread * normal(random);
      }
      y /= y.norm();
    }
    return Y;
  }

  [[nodiscard]] Lifted slope(const Lifted& Y) const {
    Lifted G = system_.matrix().selfadjointView<Eigen::Lower>() * Y;
    G.col(0) -= load_;
    return G;
  }

  [[nodiscard]] double cost_of(const Lifted& Y) const {
    const Lifted QY = system_.matrix().selfadjointView<Eigen::Lower>() * Y;
    return 0.5 * Y.cwiseProduct(QY).sum() - load_.dot(Y.col(0));
  }

  [[nodiscard]] Lifted riemannian_gradient(const Lifted& Y) const { return tangent(Y, slope(Y)); }

  /// Takes off what would change the length of a y.
  [[nodiscard]] Lifted tangent(const Lifted& Y, Lifted V) const {
    for (int v = 0; v < static_cast<int>(held_.size()); ++v) {
      if (!is_free_pose(v)) continue;
      const auto y = Y.block<2, kRank>(system_.offset(v), 0);
      auto u = V.block<2, kRank>(system_.offset(v), 0);
      u -= y.cwiseProduct(u).sum() * y;
    }
    return V;
  }

  /// Along the direction as far as it pays, at most its own length.
  bool advance(Lifted& Y, const Lifted& direction, double& cost) const {
    double length = 1.0;
    for (int halving = 0; halving < 20; ++halving, length *= 0.5) {
      Lifted next = Y + length * direction;
      for (int v = 0; v < static_cast<int>(held_.size()); ++v) {
        if (is_free_pose(v)) next.block<2, kRank>(system_.offset(v), 0).normalize();
      }
      const double there = cost_of(next);
      if (there < cost) {
        Y = std::move(next);
        cost = there;
        return true;
      }
    }
    return false;
  }

  /// Back to the plane: the part of every y along their principal common direction.
  [[nodiscard]] std::vector<Pose> round(const Lifted& Y) const {
    using Complex = std::complex<double>;
    using Small = Eigen::Matrix<Complex, kRank, kRank>;
    const auto complex_row = [&Y](int at) {
      Eigen::Matrix<Complex, 1, kRank> row;
      for (int c = 0; c < kRank; ++c) row(c) = Complex(Y(at, c), Y(at + 1, c));
      return row;
    };
    Small gram = Small::Zero();
    for (int v = 0; v < static_cast<int>(held_.size()); ++v) {
      if (!is_free_pose(v)) continue;
      const Eigen::Matrix<Complex, 1, kRank> y = complex_row(system_.offset(v));
      gram += y.adjoint() * y;
    }
    const Eigen::SelfAdjointEigenSolver<Small> eigen(gram);
    Eigen::Matrix<Complex, kRank, 1> u = eigen.eigenvectors().col(kRank - 1);
    // The world's own direction is the first axis: what lies along it must stay as it is.
    if (std::abs(u(0)) > 1e-12) u *= std::conj(u(0)) / std::abs(u(0));

    std::vector<Pose> result(held_.size());
    for (std::size_t k = 0; k < held_.size(); ++k) {
      const int v = static_cast<int>(k);
      if (system_.size(v) == 0) {
        result[k] = graph_.vertices[k].estimate.value_or(Pose{});
        continue;
      }
      const bool pose = is_pose(graph_.vertices[k]);
      const int at = system_.offset(v);
      const Complex p = (complex_row(pose ? at + 2 : at) * u)(0);
      result[k] = {p.real(), p.imag(), pose ? std::arg((complex_row(at) * u)(0)) : 0.0};
      const Pose held = graph_.vertices[k].estimate.value_or(Pose{});
      if (pose && (held_[k] & estimation::held_heading) != 0) result[k].heading = held.heading;
      if (pose && (held_[k] & estimation::held_position) != 0)
        result[k] = {held.x, held.y, result[k].heading};
    }
    return result;
  }

  const PoseGraph& graph_;
  const std::vector<std::uint8_t>& held_;
  std::vector<linalg::NodePair> pairs_;
  linalg::BlockSystem system_;
  Eigen::VectorXd load_;  ///< of the first dimension; what is held lies in it
};

}  // namespace

std::vector<Pose> solve_lifted(const PoseGraph& graph, const std::vector<std::uint8_t>& held,
                               const std::vector<int>& order, std::uint64_t seed,
                               const std::function<bool(const std::vector<Pose>&)>& enough) {
  return Lifting(graph, held, order).solve(seed, enough);
}

}  // namespace trussmap::pose_graph
