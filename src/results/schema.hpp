// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The JSON Schema (draft 7) of results, by their lists of fields (described.hpp).
#pragma once

#include "results/json.hpp"

#include <string_view>

namespace trussmap::results {

/// Gathers the definitions of what has a name.
class SchemaMaker {
 public:
  /// A definition under a name of its own, of all keys of a struct.
  template <HasFields T>
  void define(const std::string& name, const char* about = "") {
    const Json object = object_of<T>(about);
    definitions_[name] = object;
  }

  [[nodiscard]] const Json& definitions() const { return definitions_; }

 private:
  template <typename T>
  [[nodiscard]] Json schema_of(bool null) {
    if constexpr (HasFields<T>) {
      constexpr std::string_view name = kDescribed<T>.definition;
      if (name.empty()) return object_of<T>(kDescribed<T>.about);
      if (!definitions_.contains(name)) {
        definitions_[std::string(name)] = nullptr;  // its place, before those of its parts
        define<T>(std::string(name), kDescribed<T>.about);
      }
      return {{"$ref", "#/definitions/" + std::string(name)}};
    } else if constexpr (std::is_same_v<T, bool>) {
      return {{"type", "boolean"}};
    } else if constexpr (std::is_floating_point_v<T>) {
      return null ? Json{{"type", {"number", "null"}}} : Json{{"type", "number"}};
    } else if constexpr (std::is_integral_v<T>) {
      Json integer{{"type", "integer"}};
      if constexpr (std::is_unsigned_v<T>) integer["minimum"] = 0;
      return integer;
    } else if constexpr (std::is_enum_v<T> || IsText<T>) {
      return {{"type", "string"}};
    } else if constexpr (std::is_pointer_v<T>) {
      return or_null(schema_of<std::remove_cv_t<std::remove_pointer_t<T>>>(null));
    } else if constexpr (MayBeThere<T>) {
      return or_null(schema_of<typename T::value_type>(null));
    } else if constexpr (IsPair<T>) {
      return {{"type", "array"},
              {"minItems", 2},
              {"maxItems", 2},
              {"items", schema_of<typename T::first_type>(null)}};
    } else if constexpr (IsKeyed<T>) {
      using Pair = typename decltype(T::values)::value_type;
      return {{"type", "object"},
              {"additionalProperties", schema_of<typename Pair::second_type>(null)}};
    } else if constexpr (IsMap<T>) {
      return {{"type", "object"},
              {"additionalProperties", schema_of<typename T::mapped_type>(null)}};
    } else {
      Json list{{"type", "array"}, {"items", schema_of<PointedTo<typename T::value_type>>(null)}};
      if constexpr (requires { std::tuple_size<T>::value; }) {
        list["minItems"] = std::tuple_size<T>::value;
        list["maxItems"] = std::tuple_size<T>::value;
      }
      return list;
    }
  }

  template <HasFields T>
  [[nodiscard]] Json object_of(std::string_view about) {
    return object_of<T>(kDescribed<T>, about);
  }

  template <typename T, typename... Fields>
  [[nodiscard]] Json object_of(const Described<Fields...>& list, std::string_view about) {
    Json object{{"type", "object"}};
    if (!about.empty()) object["description"] = about;
    object["required"] = Json::array();
    object["properties"] = Json::object();
    for_each_field(list, [&](const auto& one) { add<T>(one, object); });
    if (object["required"].empty()) object.erase("required");
    return object;
  }

  /// What a field's value is like, whether it may be absent or not.
  template <typename T, typename Get>
  [[nodiscard]] Json value_schema(const Field<Get>& one) {
    if constexpr (kIsGroup<Get>) {
      return object_of<T>(one.get, "");
    } else {
      using Value = ValueOf<T, Get>;
      const bool may_be_null = one.form == Form::value && is_nullable<Value>();
      if (*one.choices != '\0') return choices_of(one.choices, may_be_null);
      return may_be_null ? schema_of<Value>(one.null) : schema_of<ThereOf<Value>>(one.null);
    }
  }

  template <typename T, typename Get>
  void add(const Field<Get>& one, Json& object) {
    Json value = value_schema<T>(one);
    if (one.form == Form::keys) {
      add_base(value, object);
      return;
    }
    if (std::isfinite(one.least)) value["minimum"] = one.least;
    if (std::isfinite(one.most)) value["maximum"] = one.most;
    if (*one.about != '\0') {
      if (value.contains("$ref")) value = {{"allOf", Json::array({value})}};
      value["description"] = one.about;
    }
    if (one.since != std::string_view("0.1.0"))
      value["$comment"] = "since " + std::string(one.since);
    object["properties"][one.name] = std::move(value);
    if (one.form == Form::value) object["required"].push_back(one.name);
  }

  /// Of elements, which are there.
  template <typename Value>
  using PointedTo = std::remove_cv_t<std::remove_pointer_t<Value>>;

  /// What an optional or a pointer has.
  template <typename Value>
  struct There {
    using type = Value;
  };
  template <MayBeThere Value>
  struct There<Value> {
    using type = typename Value::value_type;
  };
  template <typename Value>
  struct There<const Value*> {
    using type = Value;
  };
  template <typename Value>
  using ThereOf = typename There<Value>::type;

  template <typename Value>
  [[nodiscard]] static constexpr bool is_nullable() {
    return (std::is_pointer_v<Value> && !IsText<Value>) || MayBeThere<Value>;
  }

  /// Keys of one that has a name are referred to, else they stand among the object's own.
  static void add_base(const Json& base, Json& object) {
    if (base.contains("$ref")) {
      object["allOf"].push_back(base);
      return;
    }
    for (const auto& [key, value] : base.at("properties").items())
      object["properties"][key] = value;
    if (base.contains("required")) {
      for (const Json& key : base["required"]) object["required"].push_back(key);
    }
    if (base.contains("allOf")) {
      for (const Json& part : base["allOf"]) object["allOf"].push_back(part);
    }
  }

  [[nodiscard]] static Json choices_of(std::string_view texts, bool null) {
    Json list = Json::array();
    for (std::size_t at = 0; at <= texts.size();) {
      const std::size_t end = std::min(texts.find(" | ", at), texts.size());
      list.push_back(texts.substr(at, end - at));
      at = end + 3;
    }
    if (null) list.push_back(nullptr);
    return {{"enum", list}};
  }

  [[nodiscard]] static Json or_null(Json schema) {
    if (schema.contains("type") && schema["type"].is_string() && !schema.contains("properties")) {
      schema["type"] = {schema["type"], "null"};
      return schema;
    }
    if (schema.contains("type") && schema["type"].is_array()) return schema;
    return {{"anyOf", Json::array({schema, {{"type", "null"}}})}};
  }

  Json definitions_ = Json::object();
};

}  // namespace trussmap::results
