// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/io/g2o.hpp"

#include "trussmap/core/error.hpp"
#include "trussmap/io/atomic_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::string_view kKnownTags =
    "VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_POINTXY, FIX, VERTEX2 or EDGE2";
constexpr std::string_view kBlank = " \t\r\v\f";

/// One line, taken apart from the left.
class Line {
 public:
  Line(std::string_view text, std::size_t number, const std::string& file)
      : rest_(text.substr(0, text.find('#'))), number_(number), file_(file) {}

  /// The next word, empty at the end of the line.
  std::string_view word() {
    const std::size_t begin = rest_.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) {
      rest_ = {};
      return rest_;
    }
    const std::size_t end = std::min(rest_.find_first_of(kBlank, begin), rest_.size());
    const std::string_view found = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return found;
  }

  double number(std::string_view meaning) {
    const std::string_view found = word();
    double value = 0.0;
    if (!parse(found, value) || !std::isfinite(value)) complain(found, meaning, "a number");
    return value;
  }

  std::int64_t id(std::string_view meaning) {
    const std::string_view found = word();
    std::int64_t value = 0;
    if (!parse(found, value)) complain(found, meaning, "a whole number");
    return value;
  }

  void finish() {
    const std::string_view found = word();
    if (!found.empty()) fail(fmt::format("\"{}\" is too much, the line should end here", found));
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, number_, what); }
  [[nodiscard]] std::size_t line_number() const { return number_; }

 private:
  template <typename Number>
  static bool parse(std::string_view text, Number& value) {
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }

  [[noreturn]] void complain(std::string_view found, std::string_view meaning,
                             std::string_view expected) const {
    if (found.empty()) fail(fmt::format("the line ends before {}, expected {}", meaning, expected));
    fail(fmt::format("{} is \"{}\", expected {}", meaning, found, expected));
  }

  std::string_view rest_;
  std::size_t number_;
  const std::string& file_;
};

/// The ends of an edge or a fixed vertex, kept until all vertices are known.
struct Mention {
  std::int64_t id;
  VertexKind kind;
  std::size_t line;
};

class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file) {}

  void take(Line& line) {
    const std::string_view tag = line.word();
    if (tag.empty()) return;
    if (tag == "EDGE_SE2" || tag == "EDGE2") {
      take_pose_edge(line, tag == "EDGE2");
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
  void take_vertex(Line& line, VertexKind kind) {
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

  void take_ends(Line& line, VertexKind from, VertexKind to, std::vector<Mention>& ends) {
    const std::int64_t i = line.id("the first vertex");
    const std::int64_t j = line.id("the second vertex");
    if (i == j) {
      line.fail(fmt::format("the edge joins vertex {} to itself, expected two vertices", i));
    }
    ends.push_back({i, from, line.line_number()});
    ends.push_back({j, to, line.line_number()});
  }

  void take_pose_edge(Line& line, bool toro) {
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
    check_information(line, edge.information);
    graph_.pose_edges.push_back(edge);
  }

  template <typename Edge>
  void take_vector_edge(Line& line, Edge& edge, VertexKind from) {
    take_ends(line, from, VertexKind::point,
              from == VertexKind::pose ? point_ends_ : displacement_ends_);
    edge.measured.x() = line.number("dx");
    edge.measured.y() = line.number("dy");
    edge.information(0, 0) = line.number("I11");
    edge.information(0, 1) = edge.information(1, 0) = line.number("I12");
    edge.information(1, 1) = line.number("I22");
    check_information(line, edge.information);
  }

  template <typename Matrix>
  static void check_information(const Line& line, const Matrix& information) {
    if (!is_information(information)) {
      line.fail(
          "the information matrix is not positive semidefinite, expected the inverse of a "
          "covariance");
    }
  }

  void take_fixed(Line& line) {
    do {
      fixed_.push_back({line.id("the fixed vertex"), VertexKind::pose, line.line_number()});
    } while (!Line(line).word().empty());
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
  PoseGraph graph_;
  std::unordered_map<std::int64_t, std::size_t> numbers_;  // looked up only, never walked
  std::vector<Mention> pose_ends_;                         // two per edge, in the edges' order
  std::vector<Mention> point_ends_;
  std::vector<Mention> displacement_ends_;
  std::vector<Mention> fixed_;
};

}  // namespace

PoseGraph parse_g2o(std::string_view text, const std::string& name) {
  Reader reader(name);
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    Line line(text.substr(0, end), ++number, name);
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
