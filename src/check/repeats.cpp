// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rows of sightings and loops that stand twice.
#include "check/findings.hpp"
#include "recording/repeated_rows.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace trussmap::check {
namespace {

void add_repeats(Checked& checked, const char* file, const std::vector<bool>& repeated,
                 const std::string& first) {
  const auto count = std::count(repeated.begin(), repeated.end(), true);
  if (count == 0) return;
  const auto all = static_cast<std::ptrdiff_t>(repeated.size());
  checked.findings.push_back(
      {checked.recording.name + "/" + file, "", "rows twice",
       text::joined(2 * count == all
                        ? "every row stands twice"
                        : text::joined(count, count == 1 ? " row stands" : " rows stand",
                                       " there a second time, the same to the last digit"),
                    " (the first is ", first, "); of ", all, " rows ", all - count, " are used"),
       "remove the copies: one measurement counts once"});
}

}  // namespace

void check_repeats(Checked& checked) {
  const DrivenRecording& recording = checked.recording;
  const auto place_of = [](const std::vector<bool>& repeated) {
    return static_cast<std::size_t>(std::find(repeated.begin(), repeated.end(), true) -
                                    repeated.begin());
  };
  const std::vector<bool> sightings = recording::repeated_rows(recording.sightings);
  if (const std::size_t k = place_of(sightings); k < sightings.size()) {
    const Sighting& one = recording.sightings[k];
    add_repeats(
        checked, "sightings.csv", sightings,
        text::joined("that of ", one.landmark, " at t = ", text::shortest_text(one.t), " s"));
  }
  const std::vector<bool> loops = recording::repeated_rows(recording.loops);
  if (const std::size_t k = place_of(loops); k < loops.size()) {
    const Loop& one = recording.loops[k];
    add_repeats(checked, "loops.csv", loops,
                text::joined("that from t = ", text::shortest_text(one.t), " s to ",
                             text::shortest_text(one.t2), " s"));
  }
}

}  // namespace trussmap::check
