// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/xml_element.hpp"

#include "io/read_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <cstring>
#include <expat.h>
#include <memory>
#include <string_view>
#include <type_traits>

namespace trussmap::io {
namespace {

// What a document may grow to by what it declares as defaults.
constexpr Growth kByDefaults{16, 10};
constexpr std::string_view kSpace = " \t\r\n";
// Expat counts in int.
constexpr std::size_t kPortion = std::size_t{1} << 20U;  // bytes

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

/// Grows the tree as Expat reports it. An exception must not pass through C: faults are noted.
struct Builder {
  XML_Parser parser = nullptr;
  XmlElement document;  // its child is the root
  std::vector<XmlElement*> open{&document};
  std::size_t deepest = 0;
  bool too_deep = false;
  std::size_t most = 0;   // bytes that names, values and texts may come to
  std::size_t grown = 0;  // and have

  /// Whether there is room for so many more bytes.
  bool take(std::size_t bytes) {
    grown += bytes;
    if (grown > most) XML_StopParser(parser, XML_FALSE);
    return grown <= most;
  }

  void begin(const char* name, const char** attributes) {
    if (open.size() > deepest) {
      too_deep = true;
      XML_StopParser(parser, XML_FALSE);
      return;
    }
    constexpr std::size_t kElement = 64;  // bytes, beside its names and values
    std::size_t bytes = kElement;
    for (const char** one = attributes; one[0] != nullptr; ++one) {
      bytes += std::strlen(*one);
    }
    if (!take(bytes)) return;
    XmlElement& element = open.back()->children.emplace_back();
    element.name = name;
    element.line = static_cast<int>(XML_GetCurrentLineNumber(parser));
    for (; attributes[0] != nullptr; attributes += 2) {
      element.attributes[attributes[0]] = attributes[1];
    }
    open.push_back(&element);  // stays valid: its parent grows no child while this one is open
  }

  void end() {
    open.back()->text = trimmed(open.back()->text);
    open.pop_back();
  }
};

Builder& builder(void* data) {
  return *static_cast<Builder*>(data);
}

}  // namespace

std::string XmlElement::attribute(const std::string& key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::string() : found->second;
}

const XmlElement* XmlElement::child(const std::string& tag) const {
  for (const XmlElement& one : children) {
    if (one.name == tag) return &one;
  }
  return nullptr;
}

XmlElement parse_xml(const std::string& document, const std::string& file) {
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), &XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  Builder tree;
  tree.parser = parser.get();
  tree.most = most_grown(kByDefaults, document.size());
  tree.deepest = static_cast<std::size_t>(read_limits().nesting);
  XML_SetUserData(parser.get(), &tree);
  XML_SetElementHandler(
      parser.get(),
      [](void* data, const char* name, const char** attributes) {
        builder(data).begin(name, attributes);
      },
      [](void* data, const char*) { builder(data).end(); });
  XML_SetCharacterDataHandler(parser.get(), [](void* data, const char* text, int length) {
    Builder& all = builder(data);
    const auto bytes = static_cast<std::size_t>(length);
    if (all.take(bytes)) all.open.back()->text.append(text, bytes);
  });
  std::string_view rest = document;
  bool last = false;
  while (!last) {
    const std::string_view portion = rest.substr(0, kPortion);
    rest.remove_prefix(portion.size());
    last = rest.empty();
    const XML_Status status =
        XML_Parse(parser.get(), portion.data(), static_cast<int>(portion.size()), last ? 1 : 0);
    const auto line = static_cast<int>(XML_GetCurrentLineNumber(parser.get()));
    if (tree.grown > tree.most) {
      throw InputError(file, line, "elements and defaults grow to " + more_than(kByDefaults));
    }
    if (tree.too_deep) {
      throw InputError(file, line,
                       "elements are nested more than " + std::to_string(tree.deepest) +
                           " deep, expected a map; allow more with --max-nesting");
    }
    if (status != XML_STATUS_OK) {
      throw InputError(file, line,
                       std::string("no XML: ") + XML_ErrorString(XML_GetErrorCode(parser.get())) +
                           ", expected well-formed GraphML");
    }
  }
  return std::move(tree.document.children.front());
}

}  // namespace trussmap::io
