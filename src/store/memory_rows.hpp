// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A builder's memory (map/memory_tables.hpp) as rows of a database: read whole, and written where
// it differs from what is there already, so that an arrival costs as many rows as it changed.
#pragma once

#include "map/memory_tables.hpp"
#include "store/database.hpp"

#include <vector>

namespace trussmap::store {

/// Makes the tables, with an empty memory in them. Within a transaction.
void create_memory_tables(const Database& database);

class MemoryRows {
 public:
  explicit MemoryRows(const Database& database);

  /// Throws std::invalid_argument, saying what, where the rows cannot be a builder's memory.
  [[nodiscard]] map::BuilderMemory load(const MapBuilderOptions& options);

  /// Writes what differs from the last load or save. After a transaction that was rolled back, call
  /// load first.
  void save(const map::BuilderMemory& memory, const MapBuilderOptions& options);

 private:
  struct Written {
    std::vector<Vector2> positions;
    std::vector<int> roots;
    struct RouteRow {
      int traversals = 0;
      double orientation = 0.0;
      bool operator==(const RouteRow&) const = default;
    };
    std::vector<RouteRow> routes;  ///< of which either changes whenever the route does
    std::vector<map::ReckonedRoute> reckoned;
    std::vector<map::CornerAverage> corners;
    std::vector<int> chain;
    std::vector<double> misfits;
    std::vector<LeftOutArrival> left_out;
  };

  void save_landmarks(const map::BuilderMemory& memory);
  void save_routes(const map::BuilderMemory& memory, bool weighed);
  void save_reckoned(const map::BuilderMemory& memory);
  void save_chain(const map::BuilderMemory& memory);
  void save_gate(const map::BuilderMemory& memory);
  void save_state(const map::BuilderMemory& memory);

  const Database& database_;
  Written written_;
  Statement put_landmark_;
  Statement move_landmark_;
  Statement put_route_;
  Statement put_reckoned_;
  Statement put_corner_;
  Statement put_link_;
  Statement cut_chain_;
  Statement put_misfit_;
  Statement put_left_out_;
  Statement put_state_;
};

}  // namespace trussmap::store
