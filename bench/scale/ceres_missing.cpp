// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// In the place of ceres_rivals.cpp where Ceres is not installed: the parts without it remain.
#include "ceres_rivals.hpp"

#include <stdexcept>

namespace trussmap::bench {

std::string ceres_version() {
  return "";
}

double fit_with_ceres(const Grid& /*grid*/, Stages& /*stages*/) {
  throw std::logic_error("no Ceres");
}

double fit_with_ceres(const PoseGraph& /*graph*/, double /*optimum*/, double /*tolerance*/,
                      Stages& /*stages*/) {
  throw std::logic_error("no Ceres");
}

}  // namespace trussmap::bench
