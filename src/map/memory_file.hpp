// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A builder's memory as a text: the tables of memory_tables.hpp, one after the other.
//
//   trussmap map builder 1                         version of the format
//   options 1: method, scope, eta, ...             table, rows, columns
//   elastic automatic 50 1 own 1 0 5               a row: a field per column, "-" is null
//   landmarks 4: number, name, x, y, root
//   0 dock 0 0 -1
//   ...
//   end 5c1f09e3a7d2b840                           FNV-1a (64 bits) of all bytes before this line
//
// Numbers are the shortest that read back to the same bits. In texts, bytes up to the blank, "%"
// and 127 are %XX, and so is a "-" that stands alone.
#pragma once

#include "map/builder_memory.hpp"

#include <string>

namespace trussmap::map {

[[nodiscard]] std::string format_memory(const BuilderMemory& memory,
                                        const MapBuilderOptions& options);

struct KeptMemory {
  MapBuilderOptions options;
  BuilderMemory memory;
};

/// Throws InputError, naming `file` and the line, where the text is not a builder's to the last
/// byte.
[[nodiscard]] KeptMemory parse_memory(const std::string& text, const std::string& file);

}  // namespace trussmap::map
