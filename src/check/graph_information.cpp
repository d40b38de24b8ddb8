// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the information of edges says, and whether it can be meant so.
#include "check/findings.hpp"
#include "check/graph_findings.hpp"
#include "geometry/units.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace trussmap::check {
namespace {

// A heading that is known to 2 rad is not known at all: equally likely all around it has 1.8.
constexpr double kNoHeading = 0.3;   // 1/rad^2
constexpr double kFarBelow = 0.05;   // chi^2 per degree of freedom
constexpr double kPlausible = 30.0;  // factor of chi^2 per degree of freedom, to either side
constexpr double kSurely = 30.0;     // by which the inverse has to be nearer to 1
constexpr double kVaries = 1.5;      // factor between lengths

struct Lengths {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  void take(double length) {
    least = std::min(least, length);
    most = std::max(most, length);
  }
  [[nodiscard]] bool vary() const { return most > kVaries * least; }
};

Lengths lengths_of(const CheckedGraph& checked) {
  Lengths lengths;
  const PoseGraph& graph = checked.graph;
  for (std::size_t k = 0; k < checked.edges_given; ++k) {
    lengths.take(graph.pose_edges[k].measured.position().norm());
  }
  for (const PointEdge& edge : graph.point_edges) lengths.take(edge.measured.norm());
  for (const DisplacementEdge& edge : graph.displacement_edges) lengths.take(edge.measured.norm());
  return lengths;
}

/// Of an odometry edge, which most graphs have: what a heading is said to be known by.
double usual_heading_information(const CheckedGraph& checked) {
  std::vector<double> values;
  for (std::size_t k = 0; k < checked.edges_given; ++k) {
    values.push_back(checked.graph.pose_edges[k].information(2, 2));
  }
  return values.empty() ? 0.0 : statistics::median(values);
}

/// The matrix as a covariance's inverse. Where a file gives roots R of the information R'R, the
/// covariance stood in R's place.
PoseGraph inverted(const PoseGraph& graph) {
  const double power = graph.source.roots > 0 ? -0.5 : -1.0;
  return with_information(graph, [power](const Eigen::MatrixXd& information) -> Eigen::MatrixXd {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(information);
    const Eigen::VectorXd values = parts.eigenvalues().array().pow(power);
    return parts.eigenvectors() * values.asDiagonal() * parts.eigenvectors().transpose();
  });
}

bool can_be_covariances(const PoseGraph& graph) {
  if (graph.source.roots > 0 && graph.source.roots < graph.edges()) return false;
  const auto regular = [](const auto& edge) {
    const double largest = edge.information.diagonal().maxCoeff();
    return largest > 0.0 &&
           edge.information.determinant() > 1e-12 * edge.information.diagonal().prod();
  };
  const auto all = [&](const auto& edges) {
    return std::all_of(edges.begin(), edges.end(), regular);
  };
  return all(graph.pose_edges) && all(graph.point_edges) && all(graph.displacement_edges);
}

double far_from_one(double per_dof) {
  return std::abs(std::log(per_dof));
}

}  // namespace

void check_source(CheckedGraph& checked) {
  const PoseGraph& graph = checked.graph;
  if (graph.source.other_order) {
    checked.add("information", "information order",
                "the six entries are no information matrix in the order of their lines' program, "
                "but are one in that of the other (TORO's for g2o's, or the reverse)",
                "EDGE_SE2: I11 I12 I13 I22 I23 I33; EDGE2 of TORO: I11 I12 I22 I33 I13 I23");
  }
  const std::size_t roots = graph.source.roots;
  if (roots > 0 && roots < graph.edges()) {
    checked.add(
        "information", "roots beside information",
        text::joined(roots, " of ", graph.edges(),
                     " edges are iSAM's lines, whose information is read as its square root, the "
                     "others g2o's, whose information is read as it stands"),
        "one program's lines: EDGE_SE2 and EDGE_SE2_XY with information, or ODOMETRY and "
        "LANDMARK with roots");
  }
}

void check_identity(CheckedGraph& checked) {
  const PoseGraph& graph = checked.graph;
  const auto identity = [](const auto& edge) { return edge.information.isIdentity(0.0); };
  const auto all = [&](const auto& edges) {
    return std::all_of(edges.begin(), edges.end(), identity);
  };
  if (!all(graph.pose_edges) || !all(graph.point_edges) || !all(graph.displacement_edges)) return;
  const Lengths lengths = lengths_of(checked);
  const bool kinds = (!checked.loops.empty() && checked.loops.size() < checked.edges_given) ||
                     (checked.edges_given > 0 && !graph.point_edges.empty());
  checked.all_alike = true;
  if (graph.edges() < 2 || (!kinds && !lengths.vary())) return;
  std::string evidence =
      text::joined("all ", graph.edges(), " edges have the identity: 1 m and 1 rad for each, ");
  if (!checked.loops.empty() && checked.loops.size() < checked.edges_given) {
    evidence += "odometry and loops, ";
  }
  evidence +=
      text::joined("lengths from ", figure(lengths.least), " to ", figure(lengths.most, "m"));
  if (checked.fit.dof > 0) {
    evidence += text::joined("; chi2 is then a sum of m^2 and rad^2, ", figure(checked.fit.chi2),
                             " for ", checked.fit.dof,
                             " degrees of freedom, and says nothing of whether the edges agree");
  }
  checked.add("information", "identity information", evidence,
              "a note, if it is meant so; else give each edge the inverse of its covariance");
}

void check_covariance(CheckedGraph& checked) {
  const PoseGraph& graph = checked.graph;
  if (checked.all_alike || !can_be_covariances(graph)) return;
  const bool headings = checked.edges_given > 0;
  const double known = usual_heading_information(checked);
  if (headings && known > kNoHeading) return;
  const GraphFit& fit = checked.fit;
  const bool tests = fit.dof > 0 && fit.chi2 > 0.0;
  if (!headings && !(tests && fit.per_dof() < kFarBelow)) return;
  PoseGraph mended = inverted(graph);
  std::string evidence;
  if (headings) {
    evidence = text::joined("headings would be known to ", figure(1.0 / std::sqrt(known), "rad"),
                            " at best, which is to say not at all");
  }
  if (tests) {
    const GraphFit inverse = fit_graph(mended);
    const double before = far_from_one(fit.per_dof());
    const double after = far_from_one(inverse.per_dof());
    if (after > std::log(kPlausible) || before < after + std::log(kSurely)) return;
    evidence += text::joined(evidence.empty() ? "" : "; ", "chi2 is ", figure(fit.chi2), " for ",
                             fit.dof, " degrees of freedom, and ", figure(inverse.chi2),
                             " with the inverse of each matrix");
    checked.fit = inverse;
  } else {
    const double position = graph.pose_edges.front().information(0, 0);
    if (1.0 / std::sqrt(position) < lengths_of(checked).most) return;
    evidence += text::joined(", and positions to ", figure(1.0 / std::sqrt(position), "m"),
                             " along edges of at most ", figure(lengths_of(checked).most, "m"));
  }
  checked.add("information", "covariance for information", evidence,
              "write the inverse of each covariance");
  checked.graph = std::move(mended);
}

}  // namespace trussmap::check
