// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/xml_element.hpp"

#include "trussmap/error.hpp"

#include <expat.h>
#include <memory>
#include <string_view>
#include <type_traits>

namespace trussmap {
namespace {

constexpr std::size_t kDeepest = 100;  // elements
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
  bool too_deep = false;

  void begin(const char* name, const char** attributes) {
    if (open.size() > kDeepest) {
      too_deep = true;
      XML_StopParser(parser, XML_FALSE);
      return;
    }
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
  XML_SetUserData(parser.get(), &tree);
  XML_SetElementHandler(
      parser.get(),
      [](void* data, const char* name, const char** attributes) {
        builder(data).begin(name, attributes);
      },
      [](void* data, const char*) { builder(data).end(); });
  XML_SetCharacterDataHandler(parser.get(), [](void* data, const char* text, int length) {
    builder(data).open.back()->text.append(text, static_cast<std::size_t>(length));
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
    if (tree.too_deep) {
      throw InputError(
          file, line,
          "elements are nested more than " + std::to_string(kDeepest) + " deep, expected a map");
    }
    if (status != XML_STATUS_OK) {
      throw InputError(file, line,
                       std::string("no XML: ") + XML_ErrorString(XML_GetErrorCode(parser.get())) +
                           ", expected well-formed GraphML");
    }
  }
  return std::move(tree.document.children.front());
}

}  // namespace trussmap
