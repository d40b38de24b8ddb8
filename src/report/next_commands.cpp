// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which command helps on from a result.
#include "report/noise_verdict.hpp"
#include "trussmap/pages.hpp"

namespace trussmap {
namespace {

constexpr NextCommand kBuild{"build", "", "makes the map with this model"};
constexpr NextCommand kCheck{"check", "",
                             "looks for mistakes in the recordings: units, signs, clocks"};

}  // namespace

std::optional<NextCommand> next_command(const Comparison& result) {
  if (result.consistent()) return kBuild;
  return NextCommand{"diagnose", "", "asks which physical effect is missing"};
}

std::optional<NextCommand> next_command(const Diagnosis& result) {
  switch (result.verdict) {
    case Diagnosis::Verdict::missing:
      return NextCommand{"discover", "", "adds what is missing, and what shows behind it"};
    case Diagnosis::Verdict::unexplained_misfit:
      if (result.objection == Objection::change || result.objection == Objection::place) break;
      return kCheck;
    case Diagnosis::Verdict::nothing_missing:
      if (!report::noise_is_wrong(result)) return kBuild;
      return NextCommand{"fit", "--noise", "writes the noise found into the model"};
  }
  return std::nullopt;
}

std::optional<NextCommand> next_command(const Discovery& result, bool kept) {
  if (!result.consistent) return next_command(result.last);
  const bool added = result.found.model.effects.size() > result.given.model.effects.size();
  if (kept) return kBuild;  // the model in the file has the noise found, too
  if (!added && report::noise_is_wrong(result.last)) return next_command(result.last);
  if (added) return NextCommand{"discover", "", "writes the model found to a file"};
  return kBuild;
}

}  // namespace trussmap
