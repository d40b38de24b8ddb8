// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/truss_lines.hpp"

#include "io/graph_line.hpp"
#include "trussmap/pose_graph.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::distributed {
namespace {

LandmarkLine landmark_of(io::GraphLine& line) {
  LandmarkLine result;
  result.id = line.id("the vertex");
  result.x = line.number("x");
  result.y = line.number("y");
  result.line = static_cast<std::int64_t>(line.line_number());
  line.finish();
  return result;
}

RouteLine route_of(io::GraphLine& line) {
  RouteLine result;
  result.from = line.id("the first vertex");
  result.to = line.id("the second vertex");
  if (result.from == result.to) {
    line.fail(
        fmt::format("the edge joins vertex {} to itself, expected two vertices", result.from));
  }
  result.dx = line.number("dx");
  result.dy = line.number("dy");
  result.xx = line.number("I11");
  result.xy = line.number("I12");
  result.yy = line.number("I22");
  result.line = static_cast<std::int64_t>(line.line_number());
  line.finish();
  if (!is_information((Matrix2() << result.xx, result.xy, result.xy, result.yy).finished())) {
    line.fail(
        "the information matrix is not positive semidefinite, expected the inverse of a "
        "covariance");
  }
  return result;
}

void take(io::GraphLine& line, TrussLines& found) {
  const std::string_view tag = line.word();
  if (tag == "VERTEX_XY") {
    found.landmarks.push_back(landmark_of(line));
  } else if (tag == "EDGE_POINTXY") {
    found.routes.push_back(route_of(line));
  } else if (tag == "FIX") {
    do {
      found.fixed.push_back(
          {line.id("the fixed vertex"), static_cast<std::int64_t>(line.line_number())});
    } while (!io::GraphLine(line).word().empty());
  } else if (!tag.empty()) {
    line.fail(fmt::format(
        "\"{}\" is no line of a truss, expected VERTEX_XY, EDGE_POINTXY or FIX: the processes of a "
        "cluster adjust landmarks and measured displacements, one machine adjusts poses, too",
        tag));
  }
}

}  // namespace

TrussLines parse_truss_lines(const LineRange& lines, const std::string& file) {
  TrussLines found;
  std::string_view text = lines.text;
  std::size_t number = lines.first_line;
  try {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      io::GraphLine line(text.substr(0, end), number++, file);
      take(line, found);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  } catch (const InputError& error) {
    const std::string whole = error.what();
    const std::string place = fmt::format("{}:{}: ", file, error.line());
    found.fault = Fault{error.line(), whole.substr(std::min(place.size(), whole.size()))};
  }
  return found;
}

}  // namespace trussmap::distributed
