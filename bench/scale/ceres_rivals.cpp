// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "ceres_rivals.hpp"

#include "geometry/index.hpp"

#include <ceres/ceres.h>
#include <ceres/version.h>
#include <cmath>

#include <Eigen/Cholesky>

namespace trussmap::bench {
namespace {

/// By rows, as Ceres wants them.
template <int Rows, int Columns>
void store(const Eigen::Matrix<double, Rows, Columns>& matrix, double* to) {
  for (int r = 0; r < Rows; ++r) {
    for (int c = 0; c < Columns; ++c) *to++ = matrix(r, c);
  }
}

/// sqrt(B) (p_j - p_i - z)
class Displacement : public ceres::SizedCostFunction<2, 2, 2> {
 public:
  Displacement(const Vector2& measured, const Matrix2& information)
      : measured_(measured), root_(information.llt().matrixU()) {}

  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const Vector2 off(p[1][0] - p[0][0] - measured_.x(), p[1][1] - p[0][1] - measured_.y());
    store<2, 1>(root_ * off, residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) store<2, 2>(-root_, jacobians[0]);
    if (jacobians[1] != nullptr) store<2, 2>(root_, jacobians[1]);
    return true;
  }

 private:
  Vector2 measured_;
  Matrix2 root_;
};

/// sqrt(Omega) t2v(Z^-1 (X_i^-1 X_j))
class RelativePose : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit RelativePose(const PoseEdge& edge)
      : measured_(edge.measured), root_(edge.information.llt().matrixU()) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const double angle = x[0][2] + measured_.heading;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double cz = std::cos(measured_.heading);
    const double sz = std::sin(measured_.heading);
    const double dx = x[1][0] - x[0][0];
    const double dy = x[1][1] - x[0][1];
    Eigen::Vector3d e;
    e[0] = c * dx + s * dy - (cz * measured_.x + sz * measured_.y);
    e[1] = -s * dx + c * dy - (-sz * measured_.x + cz * measured_.y);
    e[2] = std::remainder(x[1][2] - x[0][2] - measured_.heading, 2.0 * 3.14159265358979323846);
    store<3, 1>(root_ * e, residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Matrix3 J;
      J << -c, -s, -s * dx + c * dy, s, -c, -c * dx - s * dy, 0.0, 0.0, -1.0;
      store<3, 3>(root_ * J, jacobians[0]);
    }
    if (jacobians[1] != nullptr) {
      Matrix3 J;
      J << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
      store<3, 3>(root_ * J, jacobians[1]);
    }
    return true;
  }

 private:
  Pose measured_;
  Matrix3 root_;
};

ceres::Solver::Options usual_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 500;
  return options;
}

/// Stops once the cost is low enough.
class CloseEnough : public ceres::IterationCallback {
 public:
  explicit CloseEnough(double cost) : cost_(cost) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    return summary.cost <= cost_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  double cost_;
};

}  // namespace

std::string ceres_version() {
  return CERES_VERSION_STRING;
}

double fit_with_ceres(const Grid& grid, Stages& stages) {
  std::vector<Vector2> positions = grid.about;
  ceres::Problem problem;
  for (const RawMeasurement& one : grid.measurements) {
    problem.AddResidualBlock(new Displacement(one.displacement, one.information), nullptr,
                             positions[idx(one.i)].data(), positions[idx(one.j)].data());
  }
  problem.SetParameterBlockConstant(positions.front().data());
  stages.end("insert");
  ceres::Solver::Summary summary;
  ceres::Solve(usual_options(), &problem, &summary);
  stages.end("solve");
  return 2.0 * summary.final_cost;
}

double fit_with_ceres(const PoseGraph& graph, double optimum, double tolerance, Stages& stages) {
  std::vector<Eigen::Vector3d> poses;
  poses.reserve(graph.vertices.size());
  for (const GraphVertex& vertex : graph.vertices) {
    poses.emplace_back(vertex.estimate->x, vertex.estimate->y, vertex.estimate->heading);
  }
  ceres::Problem problem;
  for (const PoseEdge& edge : graph.pose_edges) {
    problem.AddResidualBlock(new RelativePose(edge), nullptr, poses[idx(edge.from)].data(),
                             poses[idx(edge.to)].data());
  }
  problem.SetParameterBlockConstant(poses.front().data());
  ceres::Solver::Options options = usual_options();
  options.function_tolerance = 1e-12;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  CloseEnough close_enough(0.5 * optimum * (1.0 + tolerance));
  options.callbacks.push_back(&close_enough);
  stages.end("insert");
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  stages.end("solve");
  return 2.0 * summary.final_cost;
}

}  // namespace trussmap::bench
