// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "stubs.hpp"

#include <algorithm>
#include <utility>

namespace trussmap::python {
namespace {

struct NotedClass {
  std::string name;
  std::vector<std::string> methods = {};  ///< lines
  std::vector<std::string> names = {};    ///< of attributes
  std::vector<std::function<std::string()>> types = {};
};

std::vector<NotedClass>& all_noted() {
  static std::vector<NotedClass> classes;
  return classes;
}

NotedClass& noted(const pybind11::handle& of) {
  const std::string name = pybind11::str(of.attr("__name__"));
  const auto found = std::ranges::find(all_noted(), name, &NotedClass::name);
  return found == all_noted().end() ? all_noted().emplace_back(NotedClass{.name = name}) : *found;
}

}  // namespace

void note_attribute(const pybind11::handle& of, const std::string& name,
                    std::function<std::string()> type) {
  noted(of).names.push_back(name);
  noted(of).types.push_back(std::move(type));
}

void note_method(const pybind11::handle& of, const std::string& line) {
  noted(of).methods.push_back(line);
}

const std::vector<std::string>& noted_names(const pybind11::handle& of) {
  return noted(of).names;
}

pybind11::dict stub_lines() {
  pybind11::dict classes;
  for (const NotedClass& one : all_noted()) {
    pybind11::list lines;
    for (const std::string& line : one.methods) lines.append(line);
    for (std::size_t k = 0; k < one.names.size(); ++k) {
      lines.append("@property");
      lines.append("def " + one.names[k] + "(self) -> " + one.types[k]() + ": ...");
    }
    classes[pybind11::str(one.name)] = lines;
  }
  return classes;
}

}  // namespace trussmap::python
