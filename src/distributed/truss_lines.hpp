// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A process's lines of a truss's file, read: landmarks, measured routes and what is fixed, by the
// ids of the file.
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/line_range.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace trussmap::distributed {

struct LandmarkLine {
  std::int64_t id = 0;
  double x = 0.0;  ///< m
  double y = 0.0;  ///< m
  std::int64_t line = 0;
};

struct RouteLine {
  std::int64_t from = 0;
  std::int64_t to = 0;
  double dx = 0.0;  ///< m
  double dy = 0.0;  ///< m
  double xx = 0.0;  ///< information, 1/m^2
  double xy = 0.0;
  double yy = 0.0;
  std::int64_t line = 0;
};

struct FixedLine {
  std::int64_t id = 0;
  std::int64_t line = 0;
};

struct TrussLines {
  std::vector<LandmarkLine> landmarks;
  std::vector<RouteLine> routes;
  std::vector<FixedLine> fixed;
  std::optional<Fault> fault;  ///< of the first line that is wrong; reading ends there
};

[[nodiscard]] TrussLines parse_truss_lines(const LineRange& lines, const std::string& file);

}  // namespace trussmap::distributed
