// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "rows.hpp"

#include "trussmap/model.hpp"

namespace trussmap::python {
namespace {

bool is_object(const py::object& value) {
  return py::hasattr(value, "to_dict");
}

/// Lists of objects, dicts and arrays are no cells.
bool is_cell(const py::object& value) {
  if (py::isinstance<py::dict>(value) || py::hasattr(value, "__array__")) return false;
  return !py::isinstance<py::tuple>(value) || py::len(value) == 0 ||
         !is_object(py::object(value[py::int_(0)]));
}

}  // namespace

py::dict row_of(const py::object& object, const std::vector<std::string>& names) {
  py::dict row;
  for (const std::string& name : names) {
    std::string key = name;
    if (key.back() == '_') key.pop_back();
    const py::object value = object.attr(name.c_str());
    if (py::isinstance<Effect>(value)) {
      row[py::str(key)] = value.attr("name");
    } else if (is_object(value)) {
      for (const auto& [inner, one] : py::dict(value.attr("to_dict")())) {
        row[py::str(key + "_" + std::string(py::str(inner)))] = one;
      }
    } else if (is_cell(value)) {
      row[py::str(key)] = value;
    }
  }
  return row;
}

std::string repr_of(const py::object& object, const std::vector<std::string>& names) {
  std::string text;
  for (const auto& [key, value] : row_of(object, names)) {
    text +=
        (text.empty() ? "" : ", ") + std::string(py::str(key)) + "=" + std::string(py::repr(value));
  }
  return std::string(py::str(py::type::of(object).attr("__name__"))) + "(" + text + ")";
}

}  // namespace trussmap::python
