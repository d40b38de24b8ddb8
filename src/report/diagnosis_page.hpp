// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of a diagnosis: what is missing, how large and how sure that is, what else it could be,
// what to drive next, and what there is to gain.
#pragma once

#include "criticism/diagnosis.hpp"
#include "report/comparison_page.hpp"
#include "report/fit_page.hpp"
#include "report/page.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// Tables of a diagnosis. They say what effects do in the recordings, and need these.
struct DiagnosisTables {
  PageTable parts;   ///< for each part of the robot and its world, the best change
  PageTable rivals;  ///< no rows where nothing looks the same
  PageTable tried;   ///< the catalogue: what would have been seen
  /// "wheelbase from 0.21 %": what well-known effects would have been seen from.
  std::vector<std::string> seen_from;
};

/// `found`: effects that a search has added before this diagnosis, listed with their parts.
[[nodiscard]] DiagnosisTables diagnosis_tables(const Diagnosis& diagnosis,
                                               const ShapeContext& context,
                                               const std::vector<FittedEffect>& found = {});

/// Findings that are missing, or too small to matter.
[[nodiscard]] std::vector<const Finding*> found_by(const Diagnosis& diagnosis);

struct DiagnosisPictures {
  FittedModel given;
  std::optional<FittedModel> with;    ///< with what is missing put in and fitted, where it can be
  std::vector<FittedEffect> effects;  ///< what is missing, as found_by()
  std::vector<TrendPicture> trends;   ///< of the model as given
  DiagnosisTables tables;
};

[[nodiscard]] Page diagnosis_page(const Diagnosis& diagnosis, const DiagnosisPictures& pictures,
                                  const std::string& subject);

}  // namespace trussmap
