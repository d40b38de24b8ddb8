// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/facts.hpp"

#include "geometry/index.hpp"
#include "map/memory_tables.hpp"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <vector>

namespace trussmap::store {
namespace {

/// The facts that are options, as the columns of a row.
class OptionFacts final : public text::RowReader, public text::RowWriter {
 public:
  explicit OptionFacts(Facts& facts) : facts_(facts) {
    std::istringstream columns(map::kOptionsTable.columns);
    for (std::string name; std::getline(columns >> std::ws, name, ',');) names_.push_back(name);
  }

  [[nodiscard]] double real(int column) const override { return facts_.real(name(column)); }
  [[nodiscard]] std::int64_t integer(int column) const override {
    return static_cast<std::int64_t>(std::clamp(real(column), -1e9, 1e9));
  }
  [[nodiscard]] std::string text(int column) const override { return facts_.text(name(column)); }
  [[nodiscard]] bool is_null(int /*column*/) const override { return false; }

  using text::RowWriter::bind;
  OptionFacts& bind(int column, double value) override { return put(column, value); }
  OptionFacts& bind(int column, std::int64_t value) override { return put(column, value); }
  OptionFacts& bind(int column, const std::string& text) override { return put(column, text); }

 private:
  [[nodiscard]] const std::string& name(int column) const { return names_[idx(column)]; }
  template <typename Value>
  OptionFacts& put(int column, const Value& value) {
    facts_.put(name(column), value);
    return *this;
  }

  Facts& facts_;
  std::vector<std::string> names_;
};

/// A query of one fact, ready for the next one in the end.
class Asked {
 public:
  Asked(Statement& get, const std::string& name) : get_(get), there_(get.bind(0, name).step()) {}
  ~Asked() { get_.reset(); }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  [[nodiscard]] bool there() const { return there_; }

 private:
  Statement& get_;
  bool there_;
};

}  // namespace

Facts::Facts(const Database& database)
    : get_(database, "SELECT value FROM facts WHERE name = ?"),
      put_(database, "REPLACE INTO facts VALUES (?, ?)") {}

std::string Facts::text(const std::string& name) {
  const Asked asked(get_, name);
  return asked.there() ? get_.text(0) : std::string();
}

double Facts::real(const std::string& name) {
  const Asked asked(get_, name);
  return asked.there() ? get_.real(0) : 0.0;
}

void create_facts_table(const Database& database) {
  database.run("CREATE TABLE facts(name TEXT PRIMARY KEY, value) WITHOUT ROWID");
}

MapBuilderOptions options_among(Facts& facts) {
  return map::options_in(OptionFacts(facts));
}

void put_options_among(Facts& facts, const MapBuilderOptions& options) {
  OptionFacts row(facts);
  map::put_options(row, options);
}

}  // namespace trussmap::store
