// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Plain structs of the library as read-only Python objects: an attribute per member, documented as
// its header does, a dict of them for tables.
#pragma once

#include "docs.hpp"

#include <memory>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <vector>

namespace trussmap::python {

namespace py = pybind11;

/// A value as a table's cell has it: an effect by its name.
[[nodiscard]] py::object cell(const py::object& value);

/// `fields` of an object, by name; a trailing _ (from_) is taken off.
[[nodiscard]] py::dict fields_of(const py::object& object, const std::vector<std::string>& fields);

/// "Name(chi2=12.5, dof=7)".
[[nodiscard]] std::string repr_of(const py::object& object, const std::string& name,
                                  const std::vector<std::string>& fields);

/// Dicts of all: what pandas.DataFrame takes.
template <typename Row>
[[nodiscard]] py::list table_of(const std::vector<Row>& rows) {
  py::list table;
  for (const Row& row : rows) table.append(py::cast(row).attr("to_dict")());
  return table;
}

template <typename T>
class RowClass {
 public:
  /// `name`: in Python; `header`: the struct's in C++.
  RowClass(py::module_& module, const char* name, const char* header)
      : class_(module, name,
               *doc(header) == '\0' ? "A row: attributes, and to_dict() for tables." : doc(header)),
        name_(name),
        header_(header),
        fields_(std::make_shared<std::vector<std::string>>()) {
    class_.def(
        "to_dict", [fields = fields_](const py::object& self) { return fields_of(self, *fields); },
        "Attributes by name, for tables; effects by their names.");
    class_.def("__repr__", [fields = fields_, own = name_](const py::object& self) {
      return repr_of(self, own, *fields);
    });
  }

  /// A member of the same name.
  template <typename Member>
  RowClass& field(const char* name, Member T::*member) {
    std::string key = name;
    if (key.back() == '_') key.pop_back();
    class_.def_property_readonly(
        name, [member](const T& self) -> const Member& { return self.*member; },
        py::return_value_policy::copy, doc(header_ + "." + key));
    fields_->emplace_back(name);
    return *this;
  }

  /// What a function of the struct says.
  template <typename Get>
  RowClass& value(const char* name, Get get, const char* about = "") {
    const std::string key = header_ + "." + name;
    class_.def_property_readonly(name, get, *about == '\0' ? doc(key) : about);
    fields_->emplace_back(name);
    return *this;
  }

  /// The same, and no cell of a table.
  template <typename Get>
  RowClass& aside(const char* name, Get get, const char* about = "") {
    const std::string key = header_ + "." + name;
    class_.def_property_readonly(name, get, *about == '\0' ? doc(key) : about);
    return *this;
  }

  py::class_<T>& type() { return class_; }

 private:
  py::class_<T> class_;
  std::string name_;
  std::string header_;
  std::shared_ptr<std::vector<std::string>> fields_;
};

}  // namespace trussmap::python
