// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Beside explanation_of (workbench.hpp): whether what the catalogue says of an effect holds.
#pragma once

namespace trussmap {

struct CatalogueEntry;
struct Effect;

}  // namespace trussmap

namespace trussmap::wording {

/// Whose cause and remedy are this effect's; nullptr beyond the catalogue, and for an effect that
/// has not its usual sign (Explanation::unusual).
[[nodiscard]] const CatalogueEntry* usual_entry(const Effect& effect);

}  // namespace trussmap::wording
