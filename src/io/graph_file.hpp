// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The text of a pose graph, for readers that look for mistakes in it, too.
#pragma once

#include "trussmap/map_files.hpp"

#include <string>
#include <string_view>

namespace trussmap {

/// Of the entries of a pose edge's information.
enum class InformationOrder {
  as_documented,  ///< an InputError where they are none as they stand
  either          ///< g2o's for TORO's and the reverse, where they are none otherwise
};

/// As parse_g2o, which takes the order as documented.
[[nodiscard]] PoseGraph parse_graph(std::string_view text, const std::string& name, Edge2 edge2,
                                    InformationOrder order);

}  // namespace trussmap
