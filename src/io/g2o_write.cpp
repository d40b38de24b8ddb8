// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/index.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/write_files.hpp"

#include <iterator>

#include <fmt/format.h>

namespace trussmap {
namespace {

void append_vertices(const PoseGraph& graph, fmt::memory_buffer& out) {
  for (const GraphVertex& vertex : graph.vertices) {
    if (!vertex.estimate) continue;
    const Pose& at = *vertex.estimate;
    if (is_pose(vertex)) {
      fmt::format_to(std::back_inserter(out), "VERTEX_SE2 {} {} {} {}\n", vertex.id, at.x, at.y,
                     at.heading);
    } else {
      fmt::format_to(std::back_inserter(out), "VERTEX_XY {} {} {}\n", vertex.id, at.x, at.y);
    }
  }
  for (const GraphVertex& vertex : graph.vertices) {
    if (vertex.fixed) fmt::format_to(std::back_inserter(out), "FIX {}\n", vertex.id);
  }
}

void append_edge(fmt::memory_buffer& out, std::string_view tag, std::int64_t from, std::int64_t to,
                 const Vector2& measured, const Matrix2& information) {
  fmt::format_to(std::back_inserter(out), "{} {} {} {} {} {} {} {}\n", tag, from, to, measured.x(),
                 measured.y(), information(0, 0), information(0, 1), information(1, 1));
}

}  // namespace

std::string format_g2o(const PoseGraph& graph) {
  fmt::memory_buffer out;
  append_vertices(graph, out);
  const auto id = [&graph](int vertex) { return graph.vertices[idx(vertex)].id; };
  for (const PoseEdge& edge : graph.pose_edges) {
    const Matrix3& I = edge.information;
    fmt::format_to(std::back_inserter(out), "EDGE_SE2 {} {} {} {} {} {} {} {} {} {} {}\n",
                   id(edge.from), id(edge.to), edge.measured.x, edge.measured.y,
                   edge.measured.heading, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
  }
  for (const PointEdge& edge : graph.point_edges) {
    append_edge(out, "EDGE_SE2_XY", id(edge.pose), id(edge.point), edge.measured, edge.information);
  }
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    append_edge(out, "EDGE_POINTXY", id(edge.from), id(edge.to), edge.measured, edge.information);
  }
  return fmt::to_string(out);
}

void write_g2o(const PoseGraph& graph, const std::string& path) {
  write_file(path, format_g2o(graph));
}

}  // namespace trussmap
