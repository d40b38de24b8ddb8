// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/model.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

using Name = std::pair<ProcessKind, std::string_view>;

constexpr std::array<Name, 8> kNames{
    {{ProcessKind::white, "white"},
     {ProcessKind::per_leg, "per leg"},
     {ProcessKind::per_session, "per session"},
     {ProcessKind::per_pass, "per pass"},
     {ProcessKind::correlated_in_t, "correlated in t"},
     {ProcessKind::correlated_in_distance, "correlated in distance"},
     {ProcessKind::walk_in_t, "walk in t"},
     {ProcessKind::walk_in_distance, "walk in distance"}}};

}  // namespace

std::string_view name_of(ProcessKind process) {
  return std::find_if(kNames.begin(), kNames.end(),
                      [process](const Name& one) { return one.first == process; })
      ->second;
}

bool is_correlated(ProcessKind process) {
  return process == ProcessKind::correlated_in_t || process == ProcessKind::correlated_in_distance;
}

bool is_chain(ProcessKind process) {
  return is_correlated(process) || process == ProcessKind::walk_in_t ||
         process == ProcessKind::walk_in_distance;
}

ProcessKind process_named(std::string_view name) {
  std::string names;
  for (const auto& [process, own] : kNames) {
    if (own == name) return process;
    names += (names.empty() ? "" : ", ") + std::string(own);
  }
  throw std::invalid_argument("process \"" + std::string(name) + "\" is unknown, expected one of " +
                              names);
}

}  // namespace trussmap
