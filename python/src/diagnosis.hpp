// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A diagnosis as Python has it; a discovery has two.
#pragma once

#include "fits.hpp"
#include "results.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/evidence.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace trussmap::python {

struct DiagnosisResult {
  DiagnosisReport report;
  Model model;  ///< that was diagnosed
  Prepared input;
  std::size_t list = 8;
  Lazy<DiagnosisEvidence> evidence;
};

}  // namespace trussmap::python
