// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/schema.hpp"

namespace trussmap::store {
namespace {

/// Blanks and ends of lines as one blank each.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n';
    if (!blank || line.empty() || line.back() != ' ') line += blank ? ' ' : c;
  }
  return line;
}

}  // namespace

std::vector<std::string> schema_of(const Database& database,
                                   const std::vector<std::string>& tables) {
  std::string names;
  for (const std::string& table : tables) names += (names.empty() ? "'" : ", '") + table + "'";
  Statement rows(database,
                 "SELECT type || ' ' || name || ' ' || ifnull(sql, '') FROM sqlite_schema "
                 "WHERE type = 'trigger' OR tbl_name COLLATE NOCASE IN (" +
                     names + ") ORDER BY 1");
  std::vector<std::string> schema;
  while (rows.step()) schema.push_back(on_one_line(rows.text(0)));
  return schema;
}

}  // namespace trussmap::store
