// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/named_values.hpp"
#include "trussmap/model.hpp"

namespace trussmap {
namespace {

constexpr text::NamedValues<ProcessKind, 8> kProcessNames{
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
  return text::name_in(kProcessNames, process);
}

bool is_correlated(ProcessKind process) {
  return process == ProcessKind::correlated_in_t || process == ProcessKind::correlated_in_distance;
}

bool is_chain(ProcessKind process) {
  return is_correlated(process) || process == ProcessKind::walk_in_t ||
         process == ProcessKind::walk_in_distance;
}

ProcessKind process_named(std::string_view name) {
  return text::value_named(kProcessNames, "process", name);
}

}  // namespace trussmap
