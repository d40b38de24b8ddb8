// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is fuzzed: each reader, by name, with bytes that anybody may have written. A reader may
// throw what its header names, and nothing else.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace trussmap::fuzz {

using Target = void (*)(std::string_view bytes);

/// By the name of their folders in tests/fuzz/corpus.
[[nodiscard]] const std::map<std::string, Target>& targets();

/// Those of ROS bags.
[[nodiscard]] std::map<std::string, Target> bag_targets();

/// Those of them that read logs of others.
[[nodiscard]] const std::map<std::string, Target>& log_targets();

}  // namespace trussmap::fuzz
