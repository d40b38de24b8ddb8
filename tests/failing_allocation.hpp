// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Memory that runs out at a chosen moment.
#pragma once

namespace trussmap::testing {

/// While this lives, the n-th `new` of this thread from now on (1: the next) throws std::bad_alloc;
/// all others are served.
class FailingAllocation {
 public:
  explicit FailingAllocation(int nth);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// Whether it came to that.
  [[nodiscard]] bool happened() const;
};

}  // namespace trussmap::testing
