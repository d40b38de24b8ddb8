// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A row of a table, whatever holds the table. Columns count from 0.
#pragma once

#include "trussmap/planar.hpp"

#include <cstdint>
#include <string>

namespace trussmap::text {

class RowReader {
 public:
  [[nodiscard]] virtual double real(int column) const = 0;
  [[nodiscard]] virtual std::int64_t integer(int column) const = 0;
  [[nodiscard]] virtual std::string text(int column) const = 0;
  [[nodiscard]] virtual bool is_null(int column) const = 0;

 protected:
  ~RowReader() = default;
};

/// What is not bound is null.
class RowWriter {
 public:
  virtual RowWriter& bind(int column, double value) = 0;
  virtual RowWriter& bind(int column, std::int64_t value) = 0;
  virtual RowWriter& bind(int column, const std::string& text) = 0;
  RowWriter& bind(int column, int value) { return bind(column, std::int64_t{value}); }
  /// Two columns: x, y.
  RowWriter& bind(int column, const Vector2& vector) {
    return bind(column, vector.x()).bind(column + 1, vector.y());
  }
  /// Three, of a symmetric one: xx, xy, yy.
  RowWriter& bind(int column, const Matrix2& C) {
    return bind(column, C(0, 0))
        .bind(column + 1, 0.5 * (C(0, 1) + C(1, 0)))
        .bind(column + 2, C(1, 1));
  }

 protected:
  ~RowWriter() = default;
};

}  // namespace trussmap::text
