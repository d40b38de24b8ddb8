// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Loops whose turns do not depend on each other, on the threads of trussmap/running.hpp.
//
// What a turn computes must not depend on which thread runs it, nor when: then the figures do not
// depend on the number of threads either. Sums over turns are to be taken afterwards, in order.
//
// std::thread, no library: ThreadSanitizer sees into it, and users need nothing more.
#pragma once

#include <cstddef>
#include <functional>

namespace trussmap::parallel {

/// Calls turn(0) ... turn(turns - 1), each once, in any order and at the same time. Within a turn,
/// further loops run on its own thread. Of exceptions the one of the lowest turn is thrown, as if
/// the loop had run by itself; turns after it may or may not have run.
void parallel_for(std::size_t turns, const std::function<void(std::size_t)>& turn);

/// The same where a turn is too little work to be handed out by itself: `block` at a time, by
/// their first and one past their last.
void parallel_ranges(std::size_t turns, std::size_t block,
                     const std::function<void(std::size_t begin, std::size_t end)>& range);

/// Whether a loop here would have more than one thread.
[[nodiscard]] bool is_parallel();

}  // namespace trussmap::parallel
