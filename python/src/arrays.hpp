// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Numbers between numpy and the library: out as views that cannot be written and keep their owner
// alive, in with one copy.
#pragma once

#include <cstddef>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace trussmap::python {

namespace py = pybind11;

/// The array, not to be written.
[[nodiscard]] py::array read_only(py::array array);

/// A view of numbers that `owner` holds: `strides` in bytes.
[[nodiscard]] py::array view(const double* first, std::vector<py::ssize_t> shape,
                             std::vector<py::ssize_t> strides, py::handle owner);

/// Of a column.
[[nodiscard]] py::array view(const std::vector<double>& column, py::handle owner);

/// Of one member of rows, such as &Fix::x.
template <typename Row>
[[nodiscard]] py::array view(const std::vector<Row>& rows, double Row::*member, py::handle owner) {
  static const double nothing = 0.0;
  const double* first = rows.empty() ? &nothing : &(rows.front().*member);
  return view(first, {static_cast<py::ssize_t>(rows.size())},
              {static_cast<py::ssize_t>(sizeof(Row))}, owner);
}

/// One column of numbers, from whatever numpy takes for an array of one dimension; texts and the
/// like are refused (ValueError, naming it).
[[nodiscard]] std::vector<double> numbers(py::handle values, const std::string& name);

/// Rows of so many numbers each.
[[nodiscard]] std::vector<std::vector<double>> number_rows(py::handle values, std::size_t columns,
                                                           const std::string& name);

/// A small matrix or vector, copied.
template <typename Matrix>
[[nodiscard]] py::array array_of(const Matrix& matrix) {
  constexpr bool kVector = Matrix::ColsAtCompileTime == 1;
  std::vector<py::ssize_t> shape{matrix.rows()};
  if (!kVector) shape.push_back(matrix.cols());
  py::array_t<double> result(shape);
  double* at = result.mutable_data();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) *at++ = matrix(i, j);
  }
  return read_only(result);
}

/// A vector of points [n x 2] or covariances [n x 2 x 2] and the like.
template <typename Matrix>
[[nodiscard]] py::array array_of(const std::vector<Matrix>& matrices) {
  constexpr py::ssize_t kRows = Matrix::RowsAtCompileTime;
  constexpr py::ssize_t kColumns = Matrix::ColsAtCompileTime;
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(matrices.size()), kRows};
  if (kColumns > 1) shape.push_back(kColumns);
  py::array_t<double> result(shape);
  double* at = result.mutable_data();
  for (const Matrix& matrix : matrices) {
    for (Eigen::Index i = 0; i < kRows; ++i) {
      for (Eigen::Index j = 0; j < kColumns; ++j) *at++ = matrix(i, j);
    }
  }
  return read_only(result);
}

/// A fixed-size matrix from an array. ValueError, naming it, on another shape.
template <typename Matrix>
[[nodiscard]] Matrix matrix(py::handle values, const std::string& name) {
  Matrix result;
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(values);
  const bool flat = Matrix::ColsAtCompileTime == 1;
  if (!array || array.ndim() != (flat ? 1 : 2) || array.size() != result.size() ||
      array.shape(0) != result.rows()) {
    PyErr_Clear();
    throw py::value_error(name + ": expected " + std::to_string(result.rows()) +
                          (flat ? "" : " x " + std::to_string(result.cols())) + " numbers");
  }
  const double* at = array.data();
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index j = 0; j < result.cols(); ++j) result(i, j) = *at++;
  }
  return result;
}

}  // namespace trussmap::python
