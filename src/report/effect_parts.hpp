// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which part of the robot or its world an effect belongs to.
#pragma once

#include "trussmap/model.hpp"

#include <array>

namespace trussmap::report {

enum class EffectPart { wheels, turning, floor, compass, gyro, sighting };
inline constexpr std::array kEffectParts{EffectPart::wheels, EffectPart::turning,
                                         EffectPart::floor,  EffectPart::compass,
                                         EffectPart::gyro,   EffectPart::sighting};

[[nodiscard]] const char* part_name(EffectPart part);
[[nodiscard]] EffectPart part_of(const Effect& effect);

}  // namespace trussmap::report
