// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Numbers as text, and numbers of few digits.
#pragma once

#include <string>

namespace trussmap {

/// The shortest text that reads back to the same bits: "0.1", "1e-07".
[[nodiscard]] std::string shortest_text(double value);

/// Six significant digits at most, as printf's %g.
[[nodiscard]] std::string short_text(double value);

/// The nearest multiple of a power of ten between 1e-5 and 1e-4 of `scale`: a number that a search
/// cannot tell from `value`, with a short text. `scale` above 0.
[[nodiscard]] double rounded_within(double value, double scale);

}  // namespace trussmap
