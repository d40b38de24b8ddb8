// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Values of a TOML file, of the kind that is asked for. All throw TomlFault where it is not.
#pragma once

#include "io/toml_parser.hpp"

#include <stdexcept>
#include <string>

namespace trussmap::io {

/// What is wrong and where, for an InputError, which knows the file as well.
struct TomlFault {
  std::size_t line = 0;
  std::string what;
};

[[noreturn]] void refuse(const toml::source_region& where, const std::string& what);

[[nodiscard]] const toml::table& toml_table(const toml::node& node, const std::string& name);
[[nodiscard]] const toml::array& toml_list(const toml::node& node, const std::string& name);
/// As `shown` in the file, "[[effect]]": each element is a table.
[[nodiscard]] const toml::array& toml_tables(const toml::node& node, const std::string& name,
                                             const std::string& shown);
[[nodiscard]] std::string toml_words(const toml::node& node, const std::string& name);
/// Finite, and at most 1e12 in size.
[[nodiscard]] double toml_figure(const toml::node& node, const std::string& name);
/// m.
[[nodiscard]] double toml_length(const toml::node& node, const std::string& name);
[[nodiscard]] double toml_spread(const toml::node& node, const std::string& name);

/// Why a file is no TOML.
[[nodiscard]] std::string toml_fault(const toml::parse_error& error);

/// -0 would be read as a whole number, without its sign.
[[nodiscard]] std::string toml_number(double value);

/// What `read` refuses is told with its place, after `subject`.
template <typename Read>
[[nodiscard]] auto told(const toml::node& node, const std::string& subject, const Read& read) {
  try {
    return read();
  } catch (const std::invalid_argument& error) {
    refuse(node.source(), subject + error.what());
  }
}

}  // namespace trussmap::io
