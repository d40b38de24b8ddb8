// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Vectors and matrices out of the reference files.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace trussmap::testing {

template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> matrix(const nlohmann::json& rows) {
  Eigen::Matrix<double, Rows, Columns> m;
  for (int r = 0; r < Rows; ++r) {
    for (int c = 0; c < Columns; ++c) {
      m(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)].get<double>();
    }
  }
  return m;
}

inline Eigen::Vector2d vector2(const nlohmann::json& pair) {
  return {pair[0].get<double>(), pair[1].get<double>()};
}

}  // namespace trussmap::testing
