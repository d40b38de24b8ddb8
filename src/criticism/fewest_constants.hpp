// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constants that say the same by fewer or plainer numbers:
//
//   travel, turn and slip alike        the scale of all wheels
//   ratio of wheels, scale, turning    one wheel of another size
//   gross ratio and gross scale        two wheels of other sizes
#pragma once

#include "trussmap/fit_model.hpp"

#include <cstddef>
#include <vector>

namespace trussmap::criticism {

/// A wheel (left or right) that is by a share g larger than stated.
[[nodiscard]] Effect wheel_of_other_size(Channel wheel, double g);

/// The fit with these in place of its effects from `first` on, where it does as well with them.
[[nodiscard]] ModelFit with_fewest(const std::vector<DrivenRecording>& recordings,
                                   const ModelFit& fit, std::size_t first);

}  // namespace trussmap::criticism
