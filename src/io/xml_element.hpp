// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An XML document as a tree of elements.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace trussmap::io {

struct XmlElement {
  std::string name;
  int line = 0;
  std::map<std::string, std::string> attributes;
  std::string text;  ///< directly in the element, without white space at either end
  std::vector<XmlElement> children;

  /// Empty where there is none.
  [[nodiscard]] std::string attribute(const std::string& key) const;
  /// The first of this name, nullptr where there is none.
  [[nodiscard]] const XmlElement* child(const std::string& tag) const;
};

/// The root element. Throws InputError, with `file` and line, on what is not well-formed or nested
/// deeper than any map is.
[[nodiscard]] XmlElement parse_xml(const std::string& document, const std::string& file);

}  // namespace trussmap::io
