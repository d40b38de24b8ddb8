// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Batch least squares on the truss.
#pragma once

#include "trussmap/graph/landmark_graph.hpp"

namespace trussmap {

[[nodiscard]] LandmarkGraph adjust_linear(const LandmarkGraph& map);

}  // namespace trussmap
