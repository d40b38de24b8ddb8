// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Described results (results/described.hpp) in Python: an attribute per field, under the name that
// JSON has, and its type for the stubs.
//
//   a described struct     its class where it has one, else a dict
//   an optional, a pointer what it has, or None; also of what JSON leaves out
//   a list                 a list; of described structs a tuple, which cannot be changed
//   a number               a float or an int: what JSON has as null is nan or inf
#pragma once

#include "docs.hpp"
#include "results/common.hpp"
#include "stubs.hpp"
#include "trussmap/model.hpp"

#include <cctype>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <string_view>

namespace trussmap::python {

namespace py = pybind11;

using results::IsKeyed;
using results::IsMap;
using results::IsPair;
using results::IsText;
using results::MayBeThere;

template <typename V>
[[nodiscard]] bool has_class() {
  return py::detail::get_type_info(typeid(V)) != nullptr;
}

template <typename V>
[[nodiscard]] py::object to_python(const V& value);

template <typename T, typename... Fields>
[[nodiscard]] py::dict dict_of(const T& whole, const results::Described<Fields...>& list) {
  py::dict dict;
  results::for_each_field(list, [&]<typename Get>(const results::Field<Get>& one) {
    if constexpr (results::kIsGroup<Get>) {
      dict[one.name] = dict_of(whole, one.get);
    } else {
      dict[one.name] = to_python(results::value_of(whole, one));
    }
  });
  return dict;
}

template <typename V>
[[nodiscard]] py::object to_python(const V& value) {
  if constexpr (std::is_same_v<V, Effect>) {
    return py::cast(value);
  } else if constexpr (std::is_same_v<V, results::SizedEffect>) {
    return py::cast(*value.effect);
  } else if constexpr (results::HasFields<V>) {
    return has_class<V>() ? py::cast(value) : dict_of(value, results::kDescribed<V>);
  } else if constexpr (std::is_enum_v<V>) {
    return py::str(std::string(name_of(value)));
  } else if constexpr (IsText<V>) {
    return py::str(std::string(value));
  } else if constexpr (std::is_arithmetic_v<V>) {
    return py::cast(value);
  } else if constexpr (MayBeThere<V> || std::is_pointer_v<V>) {
    return value ? to_python(*value) : py::object(py::none());
  } else if constexpr (IsPair<V>) {
    return py::make_tuple(to_python(value.first), to_python(value.second));
  } else if constexpr (IsKeyed<V>) {
    py::dict dict;
    for (const auto& [key, one] : value.values) dict[py::str(key)] = to_python(one);
    return dict;
  } else if constexpr (IsMap<V>) {
    py::dict dict;
    for (const auto& [key, one] : value) dict[py::str(key)] = to_python(one);
    return dict;
  } else {
    py::list list;
    for (const auto& one : value) list.append(to_python(one));
    if (results::HasFields<typename V::value_type>) return py::tuple(list);
    return list;
  }
}

/// As a stub has it: "Optional[float]".
template <typename V>
[[nodiscard]] std::string type_text() {
  if constexpr (std::is_same_v<V, results::SizedEffect>) {
    return "Effect";
  } else if constexpr (results::HasFields<V>) {
    return has_class<V>() ? std::string(py::str(py::type::of<V>().attr("__name__")))
                          : "dict[str, Any]";
  } else if constexpr (std::is_enum_v<V> || IsText<V>) {
    return "str";
  } else if constexpr (std::is_same_v<V, bool>) {
    return "bool";
  } else if constexpr (std::is_floating_point_v<V>) {
    return "float";
  } else if constexpr (std::is_arithmetic_v<V>) {
    return "int";
  } else if constexpr (MayBeThere<V>) {
    return "Optional[" + type_text<typename V::value_type>() + "]";
  } else if constexpr (std::is_pointer_v<V>) {
    return "Optional[" + type_text<std::remove_cv_t<std::remove_pointer_t<V>>>() + "]";
  } else if constexpr (IsPair<V>) {
    return "tuple[" + type_text<typename V::first_type>() + ", " +
           type_text<typename V::second_type>() + "]";
  } else if constexpr (IsKeyed<V>) {
    return "dict[str, " + type_text<typename decltype(V::values)::value_type::second_type>() + "]";
  } else if constexpr (IsMap<V>) {
    return "dict[str, " + type_text<typename V::mapped_type>() + "]";
  } else if constexpr (results::HasFields<typename V::value_type>) {
    return "tuple[" + type_text<typename V::value_type>() + ", ...]";
  } else {
    return "list[" + type_text<typename V::value_type>() + "]";
  }
}

/// Python's words are no attributes: from_.
[[nodiscard]] inline std::string attribute_name(std::string_view field) {
  const bool keyword = field == "from" || field == "class" || field == "false";
  return std::string(field) + (keyword ? "_" : "");
}

/// What a field says of itself.
[[nodiscard]] inline std::string field_doc(const char* about) {
  std::string text = about;
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.ends_with('.') ? text : text + ".";
}

/// A property per field of what `part` gets of the class; keys of another struct are properties of
/// their own, those of an effect are the effect.
template <typename Class, typename T, typename... Fields, typename Part>
void add_fields(py::class_<Class>& type, const results::Described<Fields...>& list, Part part) {
  results::for_each_field(list, [&]<typename Get>(const results::Field<Get>& one) {
    const std::string name = attribute_name(one.name);
    if constexpr (results::kIsGroup<Get>) {
      type.def_property_readonly(
          name.c_str(), [=](const Class& self) { return dict_of<T>(part(self), one.get); },
          field_doc(one.about).c_str());
      note_attribute(type, name, [] { return std::string("dict[str, Any]"); });
    } else {
      using Value = results::ValueOf<T, Get>;
      using Base = std::remove_cv_t<std::remove_pointer_t<Value>>;
      if constexpr (results::HasFields<Base> && !std::is_same_v<Base, Effect>) {
        if (one.form == results::Form::keys) {
          add_fields<Class, Base>(type, results::kDescribed<Base>, [=](const Class& self) -> Base {
            const T& whole = part(self);
            if constexpr (std::is_pointer_v<Value>) {
              return *results::value_of(whole, one);
            } else {
              return results::value_of(whole, one);
            }
          });
          return;
        }
      }
      type.def_property_readonly(
          name.c_str(),
          [=](const Class& self) {
            const T& whole = part(self);
            return to_python(results::value_of(whole, one));
          },
          field_doc(one.about).c_str());
      note_attribute(type, name, [may_be_absent = one.form == results::Form::absent] {
        const std::string text = type_text<Value>();
        return may_be_absent && !text.starts_with("Optional[") && MayBeThere<Value>
                   ? "Optional[" + text + "]"
                   : text;
      });
    }
  });
}

}  // namespace trussmap::python
