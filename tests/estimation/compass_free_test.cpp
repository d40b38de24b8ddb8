// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tours without a compass: the heading is chained from route to route, and everything adjusted at
// once, landmarks and one heading per route driven (tests/reference/errata.md, C.4).
//
// 5x5 mesh, 1 m, Euler walks, seeds 1 to 200. Per route: heading change off by 0.03 rad, direction
// of travel by 0.015 rad, stretch by 5 % (means of absolute values; Gaussian). The first heading
// is known. The reference is a mean over 20 seeds, and wanders by the scatter of such means.
#include "geometry/index.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/simulation.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::compass_free_test {
namespace {

const double kToSigma = std::sqrt(std::numbers::pi / 2.0);  // mean absolute value -> sd
const double kHeadingChange = 0.03 * kToSigma;              // rad
const double kWobble = 0.015 * kToSigma;                    // rad
const double kStretch = 0.05 * kToSigma;

/// Stretch, orientation [rad], position [m].
using Errors = Eigen::Array3d;

/// Vertices: the mesh's landmarks, then a pose per route driven, which stands where it began and
/// looks along it.
PoseGraph graph_of(const Mesh& mesh, const std::vector<int>& walk, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  PoseGraph graph;
  const int landmarks = static_cast<int>(mesh.positions.size());
  for (int k = 0; k < landmarks; ++k) {
    graph.vertices.push_back({k, VertexKind::point, std::nullopt, false});
  }
  double before = 0.0;
  for (std::size_t step = 0; step + 1 < walk.size(); ++step) {
    const int pose = landmarks + static_cast<int>(step);
    const Vector2 drive = mesh.displacement(walk[step], walk[step + 1]);
    const double heading = direction(drive);
    graph.vertices.push_back({pose, VertexKind::pose, std::nullopt, false});
    if (step == 0) {
      const Vector2 at = mesh.positions[idx(walk[0])];
      graph.vertices.back().estimate = Pose{at.x(), at.y(), heading};
      graph.vertices.back().fixed = true;
    } else {
      PoseEdge turn;
      turn.from = pose - 1;
      turn.to = pose;
      turn.measured.heading = wrap_angle(heading - before) + kHeadingChange * normal(random);
      turn.information(2, 2) = 1.0 / (kHeadingChange * kHeadingChange);
      graph.pose_edges.push_back(turn);
    }
    before = heading;
    constexpr double kStanding = 1e-4;  // m
    graph.point_edges.push_back(
        {pose, walk[step], Vector2::Zero(), Matrix2::Identity() / (kStanding * kStanding)});
    const double stretch = drive.norm() * (1.0 + kStretch * normal(random));
    const double wobble = kWobble * normal(random);
    const Matrix2 R = rotation(wobble);
    const Vector2 sd(kStretch * drive.norm(), kWobble * drive.norm());
    graph.point_edges.push_back({pose, walk[step + 1], stretch * R.col(0),
                                 R * sd.cwiseAbs2().cwiseInverse().asDiagonal() * R.transpose()});
  }
  return graph;
}

Errors errors_of(const Mesh& mesh, const std::vector<Pose>& estimates) {
  Errors errors = Errors::Zero();
  for (const MeshRoute& route : mesh.routes) {
    const Vector2 truth = mesh.displacement(route.from, route.to);
    const Vector2 found =
        estimates[idx(route.to)].position() - estimates[idx(route.from)].position();
    const auto n = static_cast<double>(mesh.routes.size());
    errors[0] += std::abs(found.norm() - truth.norm()) / truth.norm() / n;
    errors[1] += std::abs(wrap_angle(direction(found) - direction(truth))) / n;
  }
  for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
    errors[2] += (estimates[k].position() - mesh.positions[k]).norm() /
                 static_cast<double>(mesh.positions.size() - 1);
  }
  return errors;
}

TEST(SlowCompassFree, FullLeastSquaresIsAsGoodAsTheReference) {
  struct Row {
    int tour;
    Errors errors;
  };
  const std::array<Row, 5> reference{{{1, {.033, .041, .12}},
                                      {2, {.024, .030, .095}},
                                      {3, {.020, .025, .080}},
                                      {5, {.016, .022, .071}},
                                      {8, {.014, .016, .060}}}};
  constexpr int kSeeds = 200;
  constexpr int kReferenceSeeds = 20;
  const Mesh mesh = even_mesh({5, 5}, 1.0);
  std::array<Errors, 5> sums;
  std::array<Errors, 5> squares;
  sums.fill(Errors::Zero());
  squares.fill(Errors::Zero());
  double chi2 = 0.0;
  double dof = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    auto walks = random_stream(seed, Stream::walk);
    const Tours tours = make_tours(mesh, WalkKind::euler, 8, walks);
    for (std::size_t k = 0; k < reference.size(); ++k) {
      auto noise = random_stream(seed, Stream::wheels);  // the same drive, cut off later
      const auto end = static_cast<std::ptrdiff_t>(tours.ends[idx(reference[k].tour - 1)]);
      const std::vector<int> walk(tours.walk.begin(), tours.walk.begin() + end + 1);
      const PoseGraphAdjustment result = adjust(graph_of(mesh, walk, noise));
      const Errors errors = errors_of(mesh, result.estimates);
      sums[k] += errors;
      squares[k] += errors.square();
      if (reference[k].tour == 8) {
        chi2 += result.chi2;
        dof += result.dof;
      }
    }
  }
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const Errors mean = sums[k] / kSeeds;
    const Errors wander = ((squares[k] / kSeeds - mean.square()) / kReferenceSeeds).sqrt();
    for (const int what : {0, 1, 2}) {
      EXPECT_LE(mean[what], 1.1 * reference[k].errors[what] + 2.0 * wander[what])
          << "tour " << reference[k].tour << ", figure " << what;
    }
  }
  // The mean's standard error is sqrt(2/dof).
  EXPECT_NEAR(chi2 / dof, 1.0, 4.0 * std::sqrt(2.0 / dof));
}

}  // namespace
}  // namespace trussmap::compass_free_test
