// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/online_terms.hpp"

#include "text/number_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace trussmap::fitting {
namespace {

VariableSource of_row(std::string_view name, double drive::CausalRow::*value) {
  return {name, value, value};
}

const std::vector<VariableSource>& known_sources() {
  using Row = drive::CausalRow;
  static const std::vector<VariableSource> sources{of_row("speed", &Row::speed),
                                                   of_row("turn_rate", &Row::turn_rate),
                                                   of_row("acceleration", &Row::acceleration),
                                                   of_row("curvature", &Row::curvature),
                                                   of_row("arc_angle", &Row::arc_angle),
                                                   of_row("spin_angle", &Row::spin_angle),
                                                   {"heading", nullptr, nullptr, &Pose::heading},
                                                   {"x", nullptr, nullptr, &Pose::x},
                                                   {"y", nullptr, nullptr, &Pose::y},
                                                   {"t", &Row::t, &Row::t_end},
                                                   {"distance", &Row::distance, &Row::distance_end},
                                                   of_row("session", &Row::session),
                                                   of_row("starts", &Row::starts),
                                                   of_row("spins", &Row::spins),
                                                   of_row("reverses_left", &Row::reverses_left),
                                                   of_row("reverses_right", &Row::reverses_right)};
  return sources;
}

std::optional<VariableSource> find_source(const std::string& name,
                                          const std::vector<std::string>& covariates) {
  for (const VariableSource& one : known_sources()) {
    if (one.name == name) return one;
  }
  const auto at = std::find(covariates.begin(), covariates.end(), name);
  if (at == covariates.end()) return std::nullopt;
  VariableSource source;
  source.covariate = static_cast<std::size_t>(at - covariates.begin());
  return source;
}

[[noreturn]] void refuse(const OnlineTerm& term, const std::string& name,
                         const std::vector<std::string>& covariates) {
  std::string known;
  for (const VariableSource& one : known_sources()) known += std::string(one.name) + ", ";
  for (const std::string& one : covariates) known += one + ", ";
  known.resize(known.size() - 2);
  throw std::invalid_argument("shape \"" + term.shape.text() + "\" names \"" + name +
                              "\", which the robot does not supply, expected one of " + known);
}

}  // namespace

void OnlineTerms::add(OnlineTerm term, const std::vector<std::string>& covariates) {
  for (const std::string& name : term.shape.variables()) {
    if (!find_source(name, covariates)) refuse(term, name, covariates);
  }
  if (term.coefficient == 0.0) return;
  for (const std::string& name : term.shape.variables()) columns_[name] = {0.0};
  if (term.shape.variables().empty()) term.constant = term.shape.values({{"t", {0.0}}}).front();
  sources_.clear();
  for (const auto& [name, column] : columns_) sources_.push_back(*find_source(name, covariates));
  terms_.push_back(std::move(term));
}

void OnlineTerms::fill(const drive::CausalRow& row, const Pose& pose,
                       std::span<const double> covariates) {
  std::size_t k = 0;
  for (auto& [name, column] : columns_) {
    const VariableSource& source = sources_[k++];
    if (source.pose != nullptr) {
      column.front() = pose.*source.pose;
    } else if (source.middle != nullptr) {
      column.front() = row.*(at_ == Instant::end ? source.end : source.middle);
    } else {
      column.front() = covariates[source.covariate];
    }
  }
}

double OnlineTerms::value(const OnlineTerm& term) const {
  if (term.constant) return *term.constant;
  try {
    return term.shape.values(columns_).front();
  } catch (const std::invalid_argument&) {
    std::string state;
    for (const std::string& name : term.shape.variables()) {
      state += (state.empty() ? "" : ", ") + name + " = " +
               text::short_text(columns_.find(name)->second.front());
    }
    throw std::invalid_argument("effect \"" + term.effect + "\": shape \"" + term.shape.text() +
                                "\" has no finite value at " + state);
  }
}

bool OnlineTerms::see_the_pose() const {
  return std::any_of(sources_.begin(), sources_.end(),
                     [](const VariableSource& one) { return one.pose != nullptr; });
}

}  // namespace trussmap::fitting
