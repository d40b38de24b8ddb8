// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "rows.hpp"

#include "trussmap/model.hpp"

namespace trussmap::python {

py::object cell(const py::object& value) {
  if (py::isinstance<Effect>(value)) return value.attr("name");
  return value;
}

py::dict fields_of(const py::object& object, const std::vector<std::string>& fields) {
  py::dict result;
  for (const std::string& field : fields) {
    std::string name = field;
    if (name.back() == '_') name.pop_back();
    result[py::str(name)] = cell(object.attr(field.c_str()));
  }
  return result;
}

std::string repr_of(const py::object& object, const std::string& name,
                    const std::vector<std::string>& fields) {
  std::string text;
  for (const std::string& field : fields) {
    text += (text.empty() ? "" : ", ") + field + "=" +
            std::string(py::repr(cell(object.attr(field.c_str()))));
  }
  return name + "(" + text + ")";
}

}  // namespace trussmap::python
