// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The adjusted truss as g2o, written by all processes side by side: as format_g2o has it, landmarks
// first, then what is fixed, then the routes, each in the order of the file that was read.
#pragma once

#include "distributed/placing.hpp"

#include <filesystem>

namespace trussmap::distributed {

/// `x`, `y`: positions of this process's landmarks, m. Written beside `path` and renamed when all
/// is on the disk. Throws InputError in all processes where that fails, or where the file `graph`
/// has changed since it was read.
void write_truss(const Communicator& all, Placing& placing, const std::vector<double>& x,
                 const std::vector<double>& y, const std::filesystem::path& graph,
                 const std::filesystem::path& path);

}  // namespace trussmap::distributed
