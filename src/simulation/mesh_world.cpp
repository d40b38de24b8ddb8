// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/mesh_world.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr int kMostLandmarks = 1'000'000;

void require_increasing(const std::vector<double>& lines) {
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (!std::isfinite(lines[k]) || (k > 0 && lines[k] <= lines[k - 1])) {
      throw std::invalid_argument("a mesh's lines must be finite and increase");
    }
  }
}

std::vector<double> even_lines(int count, double spacing) {
  std::vector<double> lines;
  lines.reserve(idx(count));
  for (int k = 0; k < count; ++k) lines.push_back(k * spacing);
  return lines;
}

}  // namespace

MeshSize parse_mesh_size(std::string_view text) {
  const auto bad = [&] {
    return std::invalid_argument("mesh size '" + std::string(text) +
                                 "' is not columns x rows (like 6x6) of 2 to 1000000 landmarks");
  };
  MeshSize size;
  const char* const end = text.data() + text.size();
  const auto columns = std::from_chars(text.data(), end, size.columns);
  if (columns.ec != std::errc{} || columns.ptr == end || *columns.ptr != 'x') throw bad();
  const auto rows = std::from_chars(columns.ptr + 1, end, size.rows);
  if (rows.ec != std::errc{} || rows.ptr != end) throw bad();
  if (size.columns < 1 || size.rows < 1 || size.rows > kMostLandmarks / size.columns) throw bad();
  if (size.columns * size.rows < 2) throw bad();
  return size;
}

Mesh even_mesh(MeshSize size, double spacing) {
  if (size.columns < 1 || size.rows < 1) {
    throw std::invalid_argument("a mesh has one line or more each way");
  }
  if (!std::isfinite(spacing) || spacing <= 0.0) {
    throw std::invalid_argument("a mesh's spacing must be above 0 m");
  }
  return mesh_of_lines(even_lines(size.columns, spacing), even_lines(size.rows, spacing));
}

Mesh mesh_of_lines(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.empty() || y.empty() || x.size() * y.size() < 2 ||
      x.size() * y.size() > static_cast<std::size_t>(kMostLandmarks)) {
    throw std::invalid_argument("a mesh has 2 to 1000000 landmarks");
  }
  require_increasing(x);
  require_increasing(y);
  Mesh mesh;
  mesh.size = {static_cast<int>(x.size()), static_cast<int>(y.size())};
  for (int i = 0; i < mesh.size.columns; ++i) {
    for (int j = 0; j < mesh.size.rows; ++j) {
      mesh.positions.emplace_back(x[idx(i)], y[idx(j)]);
      if (i + 1 < mesh.size.columns) {
        mesh.routes.push_back({mesh.landmark(i, j), mesh.landmark(i + 1, j)});
      }
      if (j + 1 < mesh.size.rows) {
        mesh.routes.push_back({mesh.landmark(i, j), mesh.landmark(i, j + 1)});
      }
    }
  }
  return mesh;
}

Mesh regular_polygon(int corners, double side) {
  if (corners < 3 || corners > kMostLandmarks) {
    throw std::invalid_argument("a polygon has 3 to 1000000 corners");
  }
  if (!std::isfinite(side) || side <= 0.0) {
    throw std::invalid_argument("a polygon's sides must be above 0 m");
  }
  Mesh mesh;
  mesh.size = {corners, 1};
  Vector2 at = Vector2::Zero();
  for (int k = 0; k < corners; ++k) {
    mesh.positions.push_back(at);
    mesh.routes.push_back({k, (k + 1) % corners});
    const double along = 2.0 * std::numbers::pi * k / corners;
    at += side * Vector2(std::cos(along), std::sin(along));
  }
  return mesh;
}

}  // namespace trussmap

namespace trussmap::simulation {

bool is_polygon(const Mesh& mesh) {
  return mesh.size.rows == 1 && mesh.routes.size() == mesh.positions.size();
}

}  // namespace trussmap::simulation

namespace trussmap {

std::vector<double> random_lines(int count, double shortest, double longest,
                                 std::mt19937_64& random) {
  if (count < 1) throw std::invalid_argument("a mesh has one line or more each way");
  if (!std::isfinite(longest) || shortest <= 0.0 || longest < shortest) {
    throw std::invalid_argument("gaps between a mesh's lines must be above 0 m, shortest first");
  }
  std::uniform_real_distribution<double> gap(shortest, longest);
  std::vector<double> lines;
  lines.reserve(idx(count));
  for (int k = 0; k < count; ++k) lines.push_back(k == 0 ? 0.0 : lines.back() + gap(random));
  return lines;
}

Mesh jittered(Mesh mesh, double reach, std::mt19937_64& random) {
  if (reach < 0.0 || !(2.0 * reach < shortest_route(mesh))) {
    throw std::invalid_argument("landmarks may be moved by less than half the shortest route");
  }
  std::uniform_real_distribution<double> offset(-1.0, 1.0);
  for (Vector2& position : mesh.positions) {
    position.x() += reach * offset(random);
    position.y() += reach * offset(random);
  }
  return mesh;
}

std::string landmark_name(const Mesh& mesh, int landmark) {
  if (!mesh.names.empty()) return mesh.names[idx(landmark)];
  return fmt::format("L{}_{}", mesh.column(landmark), mesh.row(landmark));
}

}  // namespace trussmap

namespace trussmap::simulation {

std::vector<int> neighbours(const Mesh& mesh, int landmark) {
  const int i = mesh.column(landmark);
  const int j = mesh.row(landmark);
  std::vector<int> found;
  if (i > 0) found.push_back(mesh.landmark(i - 1, j));
  if (j > 0) found.push_back(mesh.landmark(i, j - 1));
  if (j + 1 < mesh.size.rows) found.push_back(mesh.landmark(i, j + 1));
  if (i + 1 < mesh.size.columns) found.push_back(mesh.landmark(i + 1, j));
  return found;
}

std::vector<int> perimeter(const Mesh& mesh) {
  const int right = mesh.size.columns - 1;
  const int top = mesh.size.rows - 1;
  std::vector<int> round;
  for (int i = 0; i <= right; ++i) round.push_back(mesh.landmark(i, 0));
  for (int j = 1; j <= top; ++j) round.push_back(mesh.landmark(right, j));
  if (right == 0 || top == 0) return round;
  for (int i = right - 1; i >= 0; --i) round.push_back(mesh.landmark(i, top));
  for (int j = top - 1; j >= 1; --j) round.push_back(mesh.landmark(0, j));
  return round;
}

}  // namespace trussmap::simulation

namespace trussmap {

double shortest_route(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const MeshRoute& route : mesh.routes) {
    shortest = std::min(shortest, mesh.displacement(route.from, route.to).norm());
  }
  return shortest;
}

}  // namespace trussmap
