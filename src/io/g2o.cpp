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
using namespace io;

namespace {

constexpr std::string_view kKnownTags =
    "VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_POINTXY, FIX, VERTEX2, EDGE2, ODOMETRY or "
    "LANDMARK";

// Where the six entries of the upper triangle stand, in the order of the file.
using Places = std::array<std::array<int, 2>, 6>;
constexpr Places kG2oOrder{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
constexpr Places kToroOrder{{{0, 0}, {0, 1}, {1, 1}, {2, 2}, {0, 2}, {1, 2}}};

/// The same entries of the file, taken in the other order.
Matrix3 reordered(const Matrix3& matrix, const Places& read, const Places& meant) {
  Matrix3 result;
  for (std::size_t k = 0; k < read.size(); ++k) {
    const double entry = matrix(read[k][0], read[k][1]);
    result(meant[k][0], meant[k][1]) = result(meant[k][1], meant[k][0]) = entry;
  }
  return result;
}

constexpr const char* kIndefinite =
    "the information matrix is not positive semidefinite, expected the inverse of a covariance";

bool has_line(std::string_view text, std::string_view tag) {
  for (std::size_t at = text.find(tag); at != std::string_view::npos; at = text.find(tag, at + 1)) {
    if (at == 0 || text[at - 1] == '\n') return true;
  }
  return false;
}

/// What a file's EDGE2 lines are where nobody says it. VERTEX2 lines are TORO's, and cannot be
/// strays: if there are any, every vertex needs one.
Edge2 usual_edge2(std::string_view text, std::string_view name) {
  if (name.ends_with(".xz")) name.remove_suffix(3);
  return name.ends_with(".txt") && !has_line(text, "VERTEX2 ") ? Edge2::isam : Edge2::toro;
}

/// The ends of an edge or a fixed vertex, kept until all vertices are known.
struct Mention {
  std::int64_t id;
  VertexKind kind;
  std::size_t line;
  bool apart = false;  ///< a landmark of iSAM's, which counts them by themselves
};

class Reader {
 public:
  Reader(const std::string& file, Edge2 edge2, bool edge2_stated, InformationOrder order)
      : file_(file), edge2_(edge2), edge2_stated_(edge2_stated), order_(order) {}

  void take(GraphLine& line) {
    const std::string_view tag = line.word();
    if (tag.empty()) return;
    if (tag == "EDGE_SE2") {
      take_pose_edge(line, kG2oOrder);
    } else if (tag == "EDGE2") {
      take_edge2(line);
    } else if (tag == "ODOMETRY") {
      if (isam_line_ == 0) isam_line_ = line.line_number();
      take_rooted_edge(line);
    } else if (tag == "LANDMARK") {
      take_landmark(line);
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
    refuse_two_programs();
    settle_order();
    number_landmarks_apart();
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

  void take_ends(GraphLine& line, VertexKind from, VertexKind to, std::vector<Mention>& ends,
                 bool apart = false) {
    const std::int64_t i = line.id("the first vertex");
    const std::int64_t j = line.id("the second vertex");
    if (i == j && !apart) {
      line.fail(fmt::format("the edge joins vertex {} to itself, expected two vertices", i));
    }
    ends.push_back({i, from, line.line_number()});
    ends.push_back({j, to, line.line_number(), apart});
  }

  PoseEdge take_measured(GraphLine& line) {
    take_ends(line, VertexKind::pose, VertexKind::pose, pose_ends_);
    PoseEdge edge;
    edge.measured.x = line.number("dx");
    edge.measured.y = line.number("dy");
    edge.measured.heading = line.number("dtheta");
    return edge;
  }

  static Matrix3 take_entries(GraphLine& line, const Places& places) {
    Matrix3 information;
    for (const auto& [row, column] : places) {
      information(row, column) = line.number("an entry of the information");
      information(column, row) = information(row, column);
    }
    return information;
  }

  void take_pose_edge(GraphLine& line, const Places& order) {
    PoseEdge edge = take_measured(line);
    edge.information = take_entries(line, order);
    if (!is_information(edge.information)) take_disordered(line, edge, order);
    orders_.push_back(&order);
    graph_.pose_edges.push_back(edge);
  }

  /// iSAM gives the upper triangle R of the information R'R.
  void take_rooted_edge(GraphLine& line) {
    PoseEdge edge = take_measured(line);
    edge.information = take_entries(line, kG2oOrder);
    if (!edge2_stated_ && edge.information(2, 2) == 0.0 && edge.information(1, 1) != 0.0 &&
        is_information(reordered(edge.information, kG2oOrder, kToroOrder))) {
      line.fail(
          "the root's R33 is 0, but in TORO's order the entries are information; expected --edge2 "
          "toro or --edge2 isam");
    }
    square(line, edge.information);
    orders_.push_back(nullptr);
    graph_.pose_edges.push_back(edge);
  }

  void take_edge2(GraphLine& line) {
    if (edge2_line_ == 0) edge2_line_ = line.line_number();
    if (edge2_ == Edge2::isam) {
      take_rooted_edge(line);
    } else {
      take_pose_edge(line, kToroOrder);
    }
  }

  void take_landmark(GraphLine& line) {
    if (isam_line_ == 0) isam_line_ = line.line_number();
    PointEdge edge;
    take_ends(line, VertexKind::pose, VertexKind::point, point_ends_, true);
    take_vector(line, edge);
    square(line, edge.information);
    graph_.point_edges.push_back(edge);
  }

  /// iSAM gives the upper triangle R of the information R'R.
  template <typename Matrix>
  void square(const GraphLine& line, Matrix& information) {
    const Matrix R = information.template triangularView<Eigen::Upper>();
    information = R.transpose() * R;
    if (!is_information(information)) line.fail(kIndefinite);
    ++graph_.source.roots;
  }

  /// iSAM counts poses and landmarks separately: landmarks go on where all else ends, but for
  /// those that have a VERTEX_XY line.
  void number_landmarks_apart() {
    std::int64_t last = 0;
    const auto pass = [&last](const std::vector<Mention>& mentions) {
      for (const Mention& one : mentions) last = one.apart ? last : std::max(last, one.id);
    };
    pass(pose_ends_);
    pass(point_ends_);
    pass(displacement_ends_);
    for (const GraphVertex& one : graph_.vertices) last = std::max(last, one.id);
    for (Mention& one : point_ends_) {
      if (!one.apart) continue;
      const auto known = numbers_.find(one.id);
      const bool stated =
          known != numbers_.end() && graph_.vertices[known->second].kind == VertexKind::point;
      one.apart = !stated;
      if (!stated) one.id += last + 1;
    }
  }

  template <typename Edge>
  static void take_vector(GraphLine& line, Edge& edge) {
    edge.measured.x() = line.number("dx");
    edge.measured.y() = line.number("dy");
    edge.information(0, 0) = line.number("I11");
    edge.information(0, 1) = edge.information(1, 0) = line.number("I12");
    edge.information(1, 1) = line.number("I22");
  }

  template <typename Edge>
  void take_vector_edge(GraphLine& line, Edge& edge, VertexKind from) {
    take_ends(line, from, VertexKind::point,
              from == VertexKind::pose ? point_ends_ : displacement_ends_);
    take_vector(line, edge);
    if (!is_information(edge.information)) line.fail(kIndefinite);
  }

  static const Places& other(const Places& order) {
    return &order == &kToroOrder ? kG2oOrder : kToroOrder;
  }

  /// Entries that are no information as they stand: in the other program's order?
  void take_disordered(const GraphLine& line, const PoseEdge& edge, const Places& order) {
    if (!is_information(reordered(edge.information, order, other(order)))) line.fail(kIndefinite);
    const bool toro = &order == &kToroOrder;
    if (order_ == InformationOrder::as_documented) {
      line.fail(fmt::format("{}; in the order {} it would be one", kIndefinite,
                            toro ? "I11 I12 I13 I22 I23 I33 of g2o (or of iSAM: --edge2 isam)"
                                 : "I11 I12 I22 I33 I13 I23 of TORO"));
    }
    if (disordered_line_ == 0) disordered_line_ = line.line_number();
  }

  /// Takes all pose edges in the other order where some can only be meant so, and all can be.
  void settle_order() {
    if (disordered_line_ == 0) return;
    for (std::size_t k = 0; k < orders_.size(); ++k) {
      if (orders_[k] == nullptr) continue;
      Matrix3& information = graph_.pose_edges[k].information;
      information = reordered(information, *orders_[k], other(*orders_[k]));
      if (!is_information(information)) throw InputError(file_, disordered_line_, kIndefinite);
    }
    graph_.source.other_order = true;
  }

  void refuse_two_programs() const {
    if (edge2_stated_ || edge2_ != Edge2::toro || edge2_line_ == 0 || isam_line_ == 0) return;
    throw InputError(file_, edge2_line_,
                     fmt::format("EDGE2 is TORO's here, but line {} is iSAM's, whose EDGE2 has the "
                                 "root of the information; expected --edge2 isam or --edge2 toro",
                                 isam_line_));
  }

  void take_fixed(GraphLine& line) {
    do {
      fixed_.push_back({line.id("the fixed vertex"), VertexKind::pose, line.line_number()});
    } while (!GraphLine(line).word().empty());
  }

  int resolve(const Mention& end, bool implicit) {
    const auto known = numbers_.find(end.id);
    if (known == numbers_.end()) {
      if (!implicit && !end.apart) {
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
  Edge2 edge2_;  ///< TORO's or iSAM's
  bool edge2_stated_;
  InformationOrder order_;
  std::size_t edge2_line_ = 0;         // the first
  std::size_t isam_line_ = 0;          // the first that only iSAM has
  std::size_t disordered_line_ = 0;    // the first that is information in the other order alone
  std::vector<const Places*> orders_;  // of each pose edge; null: a root
  PoseGraph graph_;
  std::unordered_map<std::int64_t, std::size_t> numbers_;  // for look-up only
  std::vector<Mention> pose_ends_;                         // two per edge, in the edges' order
  std::vector<Mention> point_ends_;
  std::vector<Mention> displacement_ends_;
  std::vector<Mention> fixed_;
};

}  // namespace

PoseGraph parse_g2o(std::string_view text, const std::string& name, Edge2 edge2,
                    InformationOrder order) {
  const bool stated = edge2 != Edge2::by_name;
  Reader reader(name, stated ? edge2 : usual_edge2(text, name), stated, order);
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

PoseGraph read_g2o(const std::string& path, Edge2 edge2, InformationOrder order) {
  return parse_g2o(read_file(path), path, edge2, order);
}

}  // namespace trussmap
