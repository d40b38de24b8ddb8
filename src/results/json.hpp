// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Results as JSON, by their lists of fields (described.hpp).
#pragma once

#include "results/described.hpp"

#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

namespace trussmap::results {

using Json = nlohmann::ordered_json;

template <typename T>
[[nodiscard]] Json json_of(const T& value);

namespace detail {

// Whether there is anything: what Form::absent asks.
template <typename T>
[[nodiscard]] bool is_there(const T& value) {
  if constexpr (MayBeThere<T>) {
    return value.has_value();
  } else if constexpr (requires { value.empty(); }) {
    return !value.empty();
  } else if constexpr (std::is_pointer_v<T>) {
    return value != nullptr;
  } else {
    return true;
  }
}

template <typename Range>
[[nodiscard]] Json list_of(const Range& range, bool null) {
  Json list = Json::array();
  for (const auto& one : range) {
    if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(one)>>) {
      list.push_back(null && !std::isfinite(one) ? Json() : Json(one));
    } else {
      list.push_back(json_of(one));
    }
  }
  return list;
}

template <typename T>
[[nodiscard]] Json value_json(const T& value, bool null);

template <typename T, typename... Fields>
void add_keys(const T& whole, const Described<Fields...>& list, Json& to) {
  for_each_field(list, [&]<typename Get>(const Field<Get>& one) {
    if constexpr (kIsGroup<Get>) {
      Json& object = to[one.name] = Json::object();
      add_keys(whole, one.get, object);
    } else {
      const auto& value = value_of(whole, one);
      if (one.form == Form::absent && !is_there(value)) return;
      if (one.form == Form::keys) {
        to.update(value_json(value, one.null));
      } else {
        to[one.name] = value_json(value, one.null);
      }
    }
  });
}

template <typename T>
[[nodiscard]] Json value_json(const T& value, bool null) {
  if constexpr (HasFields<T>) {
    Json object = Json::object();
    add_keys(value, kDescribed<T>, object);
    return object;
  } else if constexpr (std::is_floating_point_v<T>) {
    return null && !std::isfinite(value) ? Json() : Json(value);
  } else if constexpr (std::is_enum_v<T>) {
    return std::string(name_of(value));
  } else if constexpr (std::is_arithmetic_v<T> || IsText<T>) {
    return value;
  } else if constexpr (std::is_pointer_v<T> || MayBeThere<T>) {
    return is_there(value) ? value_json(*value, null) : Json();
  } else if constexpr (IsPair<T>) {
    return Json::array({json_of(value.first), json_of(value.second)});
  } else if constexpr (IsKeyed<T>) {
    Json object = Json::object();
    for (const auto& [key, one] : value.values) object[key] = json_of(one);
    return object;
  } else if constexpr (IsMap<T>) {
    Json object = Json::object();
    for (const auto& [key, one] : value) object[key] = json_of(one);
    return object;
  } else {
    return list_of(value, null);
  }
}

}  // namespace detail

/// Of any value that a field can have.
template <typename T>
[[nodiscard]] Json json_of(const T& value) {
  return detail::value_json(value, false);
}

/// As a file has it.
template <typename T>
[[nodiscard]] std::string json_text(const T& value) {
  return json_of(value).dump(2) + "\n";
}

}  // namespace trussmap::results
