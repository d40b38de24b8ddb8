// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/graph_line.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::string_view kKnownTags =
    "VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_POINTXY, FIX, VERTEX2, EDGE2, ODOMETRY or "
    "LANDMARK";

/// Which program's lines a file has: TORO and iSAM both write EDGE2, and mean different things.
enum class Dialect { g2o_or_toro, isam };

Dialect dialect_of(std::string_view text) {
  for (const std::string_view tag : {"LANDMARK ", "ODOMETRY "}) {
    for (std::size_t at = text.find(tag); at != std::string_view::npos;
         at = text.find(tag, at + 1)) {
      if (at == 0 || text[at - 1] == '\n') return Dialect::isam;
    }
  }
  return Dialect::g2o_or_toro;
}

/// The ends of an edge or a fixed vertex, kept until all vertices are known.
struct Mention {
  std::int64_t id;
  VertexKind kind;
  std::size_t line;
};

class Reader {
 public:
  Reader(const std::string& file, Dialect dialect) : file_(file), dialect_(dialect) {}

  void take(GraphLine& line) {
    const std::string_view tag = line.word();
    if (tag.empty()) return;
    if (tag == "EDGE_SE2" || tag == "EDGE2" || tag == "ODOMETRY") {
      take_pose_edge(line, tag == "EDGE2" && dialect_ == Dialect::g2o_or_toro);
    } else if (tag == "LANDMARK") {
      PointEdge edge;
      take_vector_edge(line, edge, VertexKind::pose);
      graph_.point_edges.push_back(edge);
    } else if (tag == "VERTEX_SE2" || tag == "VERTEX2") {
      take_vertex(line, VertexKind::pose);
    } else if (tag == "EDGE_SE2_XY") {
      PointEdge edge;
      take_vector_edge(line, edge, VertexKind::pose);
      graph_.point_edges.push_back(edge);
    } else if (tag == "VERTEX_XY") {
      take_vertex(line, VertexKind::point);
    } else if (tag == "EDGE_POINTXY") {
      DisplacementEdge edge;
      take_vector_edge(line, edge, VertexKind::point);
      graph_.displacement_edges.push_back(edge);
    } else if (tag == "FIX") {
      take_fixed(line);
      return;
    } else {
      line.fail(fmt::format("\"{}\" is unknown, expected {}", tag, kKnownTags));
    }
    line.finish();
  }

  PoseGraph finish() {
    if (dialect_ == Dialect::isam) number_landmarks_apart();
    const bool implicit = graph_.vertices.empty();
    for (std::size_t k = 0; k < graph_.pose_edges.size(); ++k) {
      PoseEdge& edge = graph_.pose_edges[k];
      edge.from = resolve(pose_ends_[2 * k], implicit);
      edge.to = resolve(pose_ends_[2 * k + 1], implicit);
    }
    for (std::size_t k = 0; k < graph_.point_edges.size(); ++k) {
      PointEdge& edge = graph_.point_edges[k];
      edge.pose = resolve(point_ends_[2 * k], implicit);
      edge.point = resolve(point_ends_[2 * k + 1], implicit);
    }
    for (std::size_t k = 0; k < graph_.displacement_edges.size(); ++k) {
      DisplacementEdge& edge = graph_.displacement_edges[k];
      edge.from = resolve(displacement_ends_[2 * k], implicit);
      edge.to = resolve(displacement_ends_[2 * k + 1], implicit);
    }
    for (const Mention& fixed : fixed_) fix(fixed);
    return std::move(graph_);
  }

 private:
  void take_vertex(GraphLine& line, VertexKind kind) {
    GraphVertex vertex;
    vertex.id = line.id("the vertex");
    vertex.kind = kind;
    Pose estimate;
    estimate.x = line.number("x");
    estimate.y = line.number("y");
    if (kind == VertexKind::pose) estimate.heading = line.number("theta");
    vertex.estimate = estimate;
    const auto [place, fresh] = numbers_.emplace(vertex.id, graph_.vertices.size());
    if (!fresh) {
      line.fail(fmt::format("vertex {} is defined a second time, expected it once", vertex.id));
    }
    graph_.vertices.push_back(vertex);
  }

  void take_ends(GraphLine& line, VertexKind from, VertexKind to, std::vector<Mention>& ends) {
    const std::int64_t i = line.id("the first vertex");
    const std::int64_t j = line.id("the second vertex");
    const bool same_numbers = dialect_ != Dialect::isam || from == to;
    if (i == j && same_numbers) {
      line.fail(fmt::format("the edge joins vertex {} to itself, expected two vertices", i));
    }
    ends.push_back({i, from, line.line_number()});
    ends.push_back({j, to, line.line_number()});
  }

  void take_pose_edge(GraphLine& line, bool toro) {
    take_ends(line, VertexKind::pose, VertexKind::pose, pose_ends_);
    PoseEdge edge;
    edge.measured.x = line.number("dx");
    edge.measured.y = line.number("dy");
    edge.measured.heading = line.number("dtheta");
    // Where the six entries of the upper triangle stand, in the order of the file.
    using Places = std::array<std::array<int, 2>, 6>;
    constexpr Places kG2o{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
    constexpr Places kToro{{{0, 0}, {0, 1}, {1, 1}, {2, 2}, {0, 2}, {1, 2}}};
    for (const auto& [row, column] : toro ? kToro : kG2o) {
      edge.information(row, column) = line.number("an entry of the information");
      edge.information(column, row) = edge.information(row, column);
    }
    if (dialect_ == Dialect::isam) square(edge.information);
    check_information(line, edge.information);
    graph_.pose_edges.push_back(edge);
  }

  template <typename Edge>
  void take_vector_edge(GraphLine& line, Edge& edge, VertexKind from) {
    take_ends(line, from, VertexKind::point,
              from == VertexKind::pose ? point_ends_ : displacement_ends_);
    edge.measured.x() = line.number("dx");
    edge.measured.y() = line.number("dy");
    edge.information(0, 0) = line.number("I11");
    edge.information(0, 1) = edge.information(1, 0) = line.number("I12");
    edge.information(1, 1) = line.number("I22");
    if (dialect_ == Dialect::isam) square(edge.information);
    check_information(line, edge.information);
  }

  /// iSAM gives the upper triangle R of the information R'R.
  template <typename Matrix>
  static void square(Matrix& information) {
    const Matrix R = information.template triangularView<Eigen::Upper>();
    information = R.transpose() * R;
  }

  /// iSAM counts poses and landmarks separately: landmarks go on where the poses end.
  void number_landmarks_apart() {
    std::int64_t last = 0;
    for (const Mention& end : pose_ends_) last = std::max(last, end.id);
    for (std::size_t k = 0; k < point_ends_.size(); ++k) {
      if (k % 2 == 0) last = std::max(last, point_ends_[k].id);
    }
    for (std::size_t k = 1; k < point_ends_.size(); k += 2) point_ends_[k].id += last + 1;
  }

  template <typename Matrix>
  static void check_information(const GraphLine& line, const Matrix& information) {
    if (!is_information(information)) {
      line.fail(
          "the information matrix is not positive semidefinite, expected the inverse of a "
          "covariance");
    }
  }

  void take_fixed(GraphLine& line) {
    do {
      fixed_.push_back({line.id("the fixed vertex"), VertexKind::pose, line.line_number()});
    } while (!GraphLine(line).word().empty());
  }

  int resolve(const Mention& end, bool implicit) {
    const auto known = numbers_.find(end.id);
    if (known == numbers_.end()) {
      if (!implicit) {
        throw InputError(file_, end.line,
                         fmt::format("vertex {} has no VERTEX line, expected one for every vertex "
                                     "or for none",
                                     end.id));
      }
      numbers_.emplace(end.id, graph_.vertices.size());
      graph_.vertices.push_back({end.id, end.kind, std::nullopt, false});
      return static_cast<int>(graph_.vertices.size()) - 1;
    }
    if (graph_.vertices[known->second].kind != end.kind) {
      const bool wanted_pose = end.kind == VertexKind::pose;
      throw InputError(file_, end.line,
                       fmt::format("vertex {} is a {}, expected a {} here", end.id,
                                   wanted_pose ? "point" : "pose", wanted_pose ? "pose" : "point"));
    }
    return static_cast<int>(known->second);
  }

  void fix(const Mention& mention) {
    const auto known = numbers_.find(mention.id);
    if (known == numbers_.end() || !graph_.vertices[known->second].estimate) {
      throw InputError(file_, mention.line,
                       fmt::format("vertex {} is fixed but has no VERTEX line, expected one that "
                                   "says where",
                                   mention.id));
    }
    graph_.vertices[known->second].fixed = true;
  }

  const std::string& file_;
  Dialect dialect_;
  PoseGraph graph_;
  std::unordered_map<std::int64_t, std::size_t> numbers_;  // for look-up only
  std::vector<Mention> pose_ends_;                         // two per edge, in the edges' order
  std::vector<Mention> point_ends_;
  std::vector<Mention> displacement_ends_;
  std::vector<Mention> fixed_;
};

}  // namespace

PoseGraph parse_g2o(std::string_view text, const std::string& name) {
  Reader reader(name, dialect_of(text));
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    GraphLine line(text.substr(0, end), ++number, name);
    reader.take(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  PoseGraph graph = reader.finish();
  if (graph.edges() == 0) throw InputError(name, 0, "has no edges, expected a pose graph");
  return graph;
}

PoseGraph read_g2o(const std::string& path) {
  return parse_g2o(read_file(path), path);
}

}  // namespace trussmap
