// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/asked_paths.hpp"

#include "trussmap/error.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::logs {

std::optional<FieldRef> AskedPaths::find(const std::string& path, std::size_t line,
                                         const LogTopic& topic, FieldRef from) {
  if (path.empty()) return std::nullopt;
  auto known = asked_.find({line, path});
  if (known == asked_.end()) {
    try {
      known = asked_
                  .emplace(std::pair(line, path),
                           Asked{FieldPath(path, topic.table), false, "", topic.file})
                  .first;
    } catch (const std::invalid_argument& error) {
      throw InputError(map_->file.string(), line, error.what());
    }
  }
  Asked& asked = known->second;
  const std::optional<FieldRef> field = asked.path.find(from);
  if (field) {
    asked.found = true;
  } else if (!asked.found && asked.fields.empty()) {
    asked.fields = listed_fields(from);
  }
  return field;
}

double AskedPaths::number(const std::string& path, std::size_t line, const LogTopic& topic,
                          FieldRef from) {
  const std::optional<FieldRef> field = find(path, line, topic, from);
  return field && std::isfinite(field->number()) ? field->number() : kAbsent;
}

void AskedPaths::check() const {
  for (const auto& [key, asked] : asked_) {
    if (asked.found) continue;
    throw InputError(map_->file.string(), key.first,
                     fmt::format("no message of {} has the field {}, expected one of {}",
                                 asked.file, key.second, asked.fields));
  }
}

std::string listed_fields(FieldRef message) {
  constexpr std::size_t kMost = 24;
  std::string text;
  std::size_t count = 0;
  for (const NamedField& one : leaves_of(message, 1)) {
    if (++count > kMost) return text + ", ...";
    text += (text.empty() ? "" : ", ") + one.path;
  }
  return text;
}

}  // namespace trussmap::logs
