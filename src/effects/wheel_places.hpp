// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a drive's wheels stand on the robot, seen from above: plain geometry, as a builder of the
// robot would measure it.
//
//        ahead x        differential,     mecanum            omni3
//          ^            skid-steer
//          |             1|    |2          \1    2/          2/   \1      numbers: columns
//    y <---+             1|    |2          /3    4\            ---3       strokes: where it rolls,
//                        1|    |2                                         or its rollers' axes
//
// A steered robot's reference point is the middle of its rear axle; a tricycle has one wheel, and
// an ackermann robot two, a length ahead of it.
#pragma once

#include "trussmap/model.hpp"

#include <vector>

namespace trussmap::effects {

/// One per column; of a tricycle its steered wheel, of an ackermann robot its measured one, beside
/// no place for the steering. None where `wheels` has a matrix alone.
[[nodiscard]] std::vector<WheelPlace> wheel_places(const Robot& robot);

}  // namespace trussmap::effects
