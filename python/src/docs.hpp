// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Docstrings: what the public headers say of a name (header_docs.py gathers it).
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace trussmap::python {

/// By "function", "Type" and "Type.member".
[[nodiscard]] const std::map<std::string_view, const char*>& header_docs();

/// Empty where the headers say nothing of it.
[[nodiscard]] inline const char* doc(std::string_view name) {
  const auto found = header_docs().find(name);
  return found == header_docs().end() ? "" : found->second;
}

/// A sentence of the package's own, then what the headers say.
[[nodiscard]] inline std::string doc(const char* sentence, std::string_view name) {
  const std::string more = doc(name);
  return more.empty() ? sentence : std::string(sentence) + "\n\n" + more;
}

}  // namespace trussmap::python
