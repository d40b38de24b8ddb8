// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a result consists of, said once: a list of fields per struct. JSON (json.hpp), its schema
// (schema.hpp), Python's classes and their stubs are made from it.
//
//   template <>
//   inline constexpr auto kDescribed<Outlier> =
//       described(field("what", &Outlier::what, "the measurement"),
//                 field("statistic", &Outlier::statistic, "its size, in standard deviations"),
//                 share("p_adjusted", &Outlier::p_adjusted, "Bonferroni, over all measurements"));
//
// A field is a member, a function of the whole, or described(...) again: an object of fields of the
// whole. Names end in the unit; numbers without one are counts, ratios or chi^2. A value can be a
// number, a truth value, a text, an enumerator that has a name_of, a described struct, and a
// vector, array, pair, std::optional of, pointer to or text -> value of these.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace trussmap::results {

/// How a field stands among the others.
enum class Form {
  value,   ///< under its name, whatever it is
  absent,  ///< not at all where there is none: an empty optional, list or text, a null pointer
  keys     ///< its own keys among those of the whole
};

template <typename Get>
struct Field {
  const char* name;
  Get get;
  const char* about = "";
  Form form = Form::value;
  bool null = false;         ///< a number that is not finite is null
  const char* choices = "";  ///< the texts that it can be, " | " between them; "": any
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  const char* since = "0.1.0";  ///< the first version that has it

  [[nodiscard]] constexpr Field if_any() const { return with(&Field::form, Form::absent); }
  [[nodiscard]] constexpr Field or_null() const { return with(&Field::null, true); }
  [[nodiscard]] constexpr Field at_least(double value) const { return with(&Field::least, value); }
  [[nodiscard]] constexpr Field at_most(double value) const { return with(&Field::most, value); }
  [[nodiscard]] constexpr Field one_of(const char* texts) const {
    return with(&Field::choices, texts);
  }
  [[nodiscard]] constexpr Field since_version(const char* version) const {
    return with(&Field::since, version);
  }

 private:
  template <typename Value>
  [[nodiscard]] constexpr Field with(Value Field::*member, Value value) const {
    Field changed = *this;
    changed.*member = value;
    return changed;
  }
};

template <typename Get>
[[nodiscard]] constexpr Field<Get> field(const char* name, Get get, const char* about = "") {
  return {.name = name, .get = get, .about = about};
}

/// A probability or another share of one.
template <typename Get>
[[nodiscard]] constexpr Field<Get> share(const char* name, Get get, const char* about = "") {
  return field(name, get, about).at_least(0.0).at_most(1.0);
}

/// What a struct says by the keys of another, which stand among its own. Python has it by `name`.
template <typename Get>
[[nodiscard]] constexpr Field<Get> keys_of(const char* name, Get get) {
  return {.name = name, .get = get, .form = Form::keys};
}

template <typename First, typename... Rest>
struct Through;
/// A member of a member, and so on: members and functions, the first one of the whole. Pointers are
/// followed.
template <typename First, typename... Rest>
[[nodiscard]] constexpr Through<First, Rest...> through(First first, Rest... rest);

template <typename First, typename... Rest>
struct Through {
  First first;
  std::tuple<Rest...> rest;

  template <typename T>
  constexpr decltype(auto) operator()(const T& whole) const {
    using Part = std::invoke_result_t<First, const T&>;
    if constexpr (sizeof...(Rest) == 0) {
      return std::invoke(first, whole);
    } else if constexpr (!std::is_reference_v<Part>) {  // nothing of it outlives this call
      const Part part = std::invoke(first, whole);
      return std::apply(
          [&](const auto&... one) {
            return std::remove_cvref_t<decltype(through(one...)(part))>(through(one...)(part));
          },
          rest);
    } else {
      return std::apply(
          [&](const auto&... one) -> decltype(auto) {
            if constexpr (std::is_pointer_v<std::remove_cvref_t<Part>>) {
              return through(one...)(*std::invoke(first, whole));
            } else {
              return through(one...)(std::invoke(first, whole));
            }
          },
          rest);
    }
  }
};
template <typename First, typename... Rest>
constexpr Through<First, Rest...> through(First first, Rest... rest) {
  return {first, {rest...}};
}

template <typename... Fields>
struct Described {
  std::tuple<Fields...> fields;
  const char* definition = "";  ///< its name in the schema; "": it is described in place
  const char* about = "";

  [[nodiscard]] constexpr Described named(const char* name, const char* what = "") const {
    return {fields, name, what};
  }
};

namespace detail {
template <typename Get>
[[nodiscard]] constexpr std::tuple<Field<Get>> as_tuple(const Field<Get>& one) {
  return {one};
}
template <typename... Fields>
[[nodiscard]] constexpr std::tuple<Fields...> as_tuple(const std::tuple<Fields...>& some) {
  return some;
}
template <typename... Fields>
[[nodiscard]] constexpr Described<Fields...> of_tuple(const std::tuple<Fields...>& fields) {
  return {.fields = fields};
}
}  // namespace detail

/// Of fields, and of tuples of these.
template <typename... Parts>
[[nodiscard]] constexpr auto described(const Parts&... parts) {
  return detail::of_tuple(std::tuple_cat(detail::as_tuple(parts)...));
}

struct NotDescribed {};

/// A struct's fields: specialised beside what describes it.
template <typename T>
inline constexpr NotDescribed kDescribed;

// Kinds of values, beside numbers and enumerators.
template <typename T>
concept IsText = std::is_convertible_v<T, std::string_view>;
template <typename T>
concept MayBeThere = requires(const T& value) {
  value.has_value();
};
template <typename T>
concept IsPair = requires(const T& value) {
  value.second;
};
template <typename T>
concept IsKeyed = requires(const T& value) {
  value.values;
};
template <typename T>
concept IsMap = requires {
  typename T::mapped_type;
};
template <typename T>
concept HasFields = !std::is_same_v<std::remove_const_t<decltype(kDescribed<T>)>, NotDescribed>;

/// Whether a field is an object of fields of the whole.
template <typename Get>
inline constexpr bool kIsGroup = false;
template <typename... Fields>
inline constexpr bool kIsGroup<Described<Fields...>> = true;

/// Calls `visit(field)` for each field, in the order of the list.
template <typename... Fields, typename Visit>
constexpr void for_each_field(const Described<Fields...>& list, Visit&& visit) {
  std::apply([&visit](const auto&... one) { (visit(one), ...); }, list.fields);
}

/// A field's value, and its type.
template <typename T, typename Get>
[[nodiscard]] decltype(auto) value_of(const T& whole, const Field<Get>& one) {
  return std::invoke(one.get, whole);
}
template <typename T, typename Get>
using ValueOf = std::remove_cvref_t<std::invoke_result_t<Get, const T&>>;

/// Values by names that are not known beforehand.
template <typename Value>
struct Keyed {
  std::vector<std::pair<std::string, Value>> values;

  [[nodiscard]] bool empty() const { return values.empty(); }
};

}  // namespace trussmap::results
