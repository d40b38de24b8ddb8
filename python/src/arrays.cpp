// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "arrays.hpp"

#include <cstring>

namespace trussmap::python {
namespace {

/// What cannot be a column of numbers is refused by its kind: numpy would read numbers out of
/// texts.
void require_numbers(const py::array& array, const std::string& name) {
  const char kind = array.dtype().kind();
  if (std::strchr("biufO", kind) == nullptr) {
    throw py::value_error("column " + name + " has values of type " +
                          std::string(py::str(static_cast<py::handle>(array.dtype()))) +
                          ", expected numbers");
  }
}

}  // namespace

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array view(const double* first, std::vector<py::ssize_t> shape,
               std::vector<py::ssize_t> strides, py::handle owner) {
  return read_only(
      py::array(py::dtype::of<double>(), std::move(shape), std::move(strides), first, owner));
}

py::array view(const std::vector<double>& column, py::handle owner) {
  static const double nothing = 0.0;
  return view(column.empty() ? &nothing : column.data(), {static_cast<py::ssize_t>(column.size())},
              {static_cast<py::ssize_t>(sizeof(double))}, owner);
}

std::vector<double> numbers(py::handle values, const std::string& name) {
  const py::module_ numpy = py::module_::import("numpy");
  const py::array array = numpy.attr("asarray")(values);
  if (array.ndim() != 1) {
    throw py::value_error("column " + name + " has " + std::to_string(array.ndim()) +
                          " dimensions, expected one");
  }
  std::vector<double> result(static_cast<std::size_t>(array.size()));
  if (result.empty()) return result;
  require_numbers(array, name);
  // numpy converts straight into the library's own memory.
  const py::array target(py::dtype::of<double>(), {array.size()},
                         {static_cast<py::ssize_t>(sizeof(double))}, result.data(),
                         py::capsule(result.data(), [](void*) {}));
  try {
    numpy.attr("copyto")(target, array, py::arg("casting") = "unsafe");
  } catch (py::error_already_set& error) {
    throw py::value_error("column " + name + " holds something that is no number: " +
                          std::string(py::str(error.value())));
  }
  return result;
}

std::vector<std::vector<double>> number_rows(py::handle values, std::size_t columns,
                                             const std::string& name) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(values);
  if (!array || array.ndim() != 2 || array.shape(1) != static_cast<py::ssize_t>(columns)) {
    PyErr_Clear();
    throw py::value_error(name + ": expected rows of " + std::to_string(columns) + " numbers");
  }
  std::vector<std::vector<double>> rows;
  for (py::ssize_t k = 0; k < array.shape(0); ++k) {
    rows.emplace_back(array.data(k, 0), array.data(k, 0) + columns);
  }
  return rows;
}

}  // namespace trussmap::python
