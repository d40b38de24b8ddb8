// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a store knows by name: its builder's options, and the notes of programs.
#pragma once

#include "store/database.hpp"
#include "trussmap/map_builder.hpp"

#include <string>

namespace trussmap::store {

class Facts {
 public:
  explicit Facts(const Database& database);

  /// Empty, 0: there is none.
  [[nodiscard]] std::string text(const std::string& name);
  [[nodiscard]] double real(const std::string& name);

  template <typename Value>
  void put(const std::string& name, const Value& value) {
    put_.bind(0, name).bind(1, value).run();
  }

 private:
  Statement get_;
  Statement put_;
};

void create_facts_table(const Database& database);

/// Throws std::invalid_argument as load_memory() does.
[[nodiscard]] MapBuilderOptions options_among(Facts& facts);
void put_options_among(Facts& facts, const MapBuilderOptions& options);

}  // namespace trussmap::store
