// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A session laid in the frame of its fixes.
#pragma once

#include "estimation/laid_session.hpp"

#include <vector>

namespace trussmap::estimation {

/// A session's fixes, by pose.
struct SessionFixes {
  std::vector<int> poses;  ///< ascending
  std::vector<Vector2> places;
  double sd = 0.0;                    ///< m, the median
  Vector2 antenna = Vector2::Zero();  ///< m, robot axes: where it is stated to sit
};

[[nodiscard]] SessionFixes fixes_of(const RecordingProblem& session);

/// Of which nothing is laid: from where its first stretch suits the fixes on, corrected by them.
[[nodiscard]] LaidSession lay_along_fixes(const SessionToLay& session, const SessionFixes& fixes,
                                          LaidSession nothing);

/// All of a session that lies in a frame of its own.
[[nodiscard]] LaidSession lay_onto_fixes(const SessionFixes& fixes, LaidSession laid);

}  // namespace trussmap::estimation
