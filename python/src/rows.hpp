// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Structs of the library as read-only Python objects: an attribute per field of its list, a dict of
// them for tables.
#pragma once

#include "docs.hpp"
#include "fields.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace trussmap::python {

/// An object's attributes, by name, for a table: effects by their names, attributes of objects
/// under both names ("heldout_arrival_rms_m"); lists of objects are left out.
[[nodiscard]] py::dict row_of(const py::object& object, const std::vector<std::string>& names);

/// "Name(chi2=12.5, dof=7)".
[[nodiscard]] std::string repr_of(const py::object& object, const std::vector<std::string>& names);

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
  RowClass(py::module_& module, const char* name, const char* about = "")
      : class_(module, name, docstring(name, about)), header_(name) {
    if constexpr (results::HasFields<T>) {
      add_fields<T, T>(class_, results::kDescribed<T>,
                       [](const T& self) -> const T& { return self; });
    }
    class_.def(
        "to_dict", [](const py::object& self) { return row_of(self, columns(self)); },
        "Attributes by name, for tables.");
    class_.def("__repr__", [](const py::object& self) { return repr_of(self, columns(self)); });
    note_method(class_, "def to_dict(self) -> dict[str, Any]: ...");
  }

  /// A member of the same name.
  template <typename Member>
  RowClass& field(const char* name, Member T::*member) {
    std::string key = name;
    if (key.back() == '_') key.pop_back();
    return value(
        name, [member](const T& self) { return self.*member; }, doc(header_ + "." + key));
  }

  /// What a function of the struct says.
  template <typename Get>
  RowClass& value(const char* name, Get get, const char* about = "") {
    using Value = std::remove_cvref_t<std::invoke_result_t<Get, const T&>>;
    class_.def_property_readonly(
        name,
        [get](const T& self) {
          if constexpr (std::is_base_of_v<py::handle, Value>) {
            return get(self);
          } else {
            return to_python(get(self));
          }
        },
        *about == '\0' ? doc(header_ + "." + name) : about);
    if constexpr (std::is_base_of_v<py::array, Value>) {
      note_attribute(class_, name, [] { return std::string("_Array"); });
    } else if constexpr (std::is_base_of_v<py::handle, Value>) {
      note_attribute(class_, name, [] { return std::string("Any"); });
    } else {
      note_attribute(class_, name, [] { return type_text<Value>(); });
    }
    return *this;
  }

  py::class_<T>& type() { return class_; }

 private:
  static const char* docstring(const char* name, const char* about) {
    if (*about != '\0') return about;
    return *doc(name) == '\0' ? "A row: attributes, and to_dict() for tables." : doc(name);
  }

  /// Names of the properties, in their order.
  static std::vector<std::string> columns(const py::object& self) {
    return noted_names(py::type::of(self));
  }

  py::class_<T> class_;
  std::string header_;
};

}  // namespace trussmap::python
