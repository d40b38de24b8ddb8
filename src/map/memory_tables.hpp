// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A builder's memory as tables: the one description of what is kept, for a database (src/store) and
// for a file (memory_file.hpp). Numbers are in SI units; null is what is not there.
#pragma once

#include "map/builder_memory.hpp"
#include "text/table_row.hpp"

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace trussmap::map {

struct MemoryTable {
  const char* name;
  const char* columns;  ///< their names, with ", " between them; rows ascend by the first
};

/// The row of options, of a database its facts: method, scope, law by their names, the rest
/// numbers.
inline constexpr MemoryTable kOptionsTable{"options",
                                           "method, scope, eta, groups, law, refine, pooled, gate"};
inline constexpr MemoryTable kLandmarksTable{"landmarks", "number, name, x, y, root"};
inline constexpr MemoryTable kRoutesTable{
    "routes",
    "number, source, target, traversals, stretch, orientation, dx, dy, c_xx, c_xy, c_yy, k_xx, "
    "k_xy, k_yy, wx, wy"};
inline constexpr MemoryTable kCornersTable{"corners", "number, i, j, k, angles, angle, variance"};
inline constexpr MemoryTable kReckonedTable{
    "reckoned",
    "number, route, lengths, length, length_variance, directions, direction, direction_variance, "
    "corner, traversals, stretch, orientation, dx, dy, c_xx, c_xy, c_yy"};
inline constexpr MemoryTable kChainTable{"chain", "place, landmark"};
inline constexpr MemoryTable kMisfitsTable{"misfits", "place, squared"};
inline constexpr MemoryTable kLeftOutTable{
    "left_out", "place, source, target, dx, dy, c_xx, c_xy, c_yy, sds, own_axes"};
inline constexpr MemoryTable kStateTable{
    "state",
    "here, said, carried_dx, carried_dy, carried_c_xx, carried_c_xy, carried_c_yy, frame, "
    "first_direction, ox, oy, o_xx, o_xy, o_yy, heading, heading_variance, earlier, beta, "
    "beta_variance, beta_x, beta_y, reading, reading_variance, driven_x, driven_y, driven_turn, "
    "driven_xx, driven_xy, driven_xt, driven_yy, driven_yt, driven_tt, said_x, said_y, said_xx, "
    "said_xy, said_yy, said_reading, said_reading_variance"};

/// Where the tables are read from, in the order in which they stand above.
class MemoryTables {
 public:
  [[nodiscard]] virtual int rows(const MemoryTable& table) = 0;
  virtual void each(const MemoryTable& table,
                    const std::function<void(const text::RowReader&)>& visit) = 0;

 protected:
  ~MemoryTables() = default;
};

/// Throws std::invalid_argument, as what a thing is damaged that has it ("a route without ..."),
/// where the rows cannot be a builder's memory.
[[nodiscard]] BuilderMemory load_memory(MemoryTables& tables, const MapBuilderOptions& options);
[[nodiscard]] MapBuilderOptions options_in(const text::RowReader& row);

void put_options(text::RowWriter& row, const MapBuilderOptions& options);
void put_landmark(text::RowWriter& row, const BuilderMemory& memory, int number);
/// `weighed`: with weights (weighs_each()).
void put_route(text::RowWriter& row, const BuilderMemory& memory, int number, bool weighed);
void put_corner(text::RowWriter& row, const BuilderMemory& memory, int number);
void put_reckoned(text::RowWriter& row, const BuilderMemory& memory, int number);
void put_link(text::RowWriter& row, const BuilderMemory& memory, int place);
void put_misfit(text::RowWriter& row, const BuilderMemory& memory, int place);
void put_left_out(text::RowWriter& row, const BuilderMemory& memory, int place);
void put_state(text::RowWriter& row, const BuilderMemory& memory);

/// What the landmark's loop hangs on, -1: nothing.
[[nodiscard]] int root_of(const BuilderMemory& memory, int landmark);

}  // namespace trussmap::map
