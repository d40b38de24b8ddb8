// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/findings.hpp"
#include "recording/repeated_rows.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace trussmap {
using namespace check;

namespace {

void mend_counters(MendedRecording& mended, const Model* model) {
  Recording& recording = mended.recording;
  const MotionRows drive = with_wheels(recording, model != nullptr ? model->robot : Robot()).drive;
  const std::vector<CounterJump> glitches = counter_glitches(drive);
  if (glitches.empty()) return;
  const std::vector<std::string> names = names_of_wheels(drive);
  for (const CounterJump& one : glitches) {
    mended.notes.push_back(text::joined("drive.csv: ", names[one.column], " of rows ", one.row + 1,
                                        " and ", one.back + 1, " shared evenly"));
  }
  recording = without_glitches(std::move(recording), glitches, names);
}

template <typename Rows>
void leave_repeats_out(Rows& rows, const char* file, std::vector<std::string>& notes) {
  const std::vector<bool> repeated = recording::repeated_rows(rows);
  Rows kept;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!repeated[k]) kept.push_back(std::move(rows[k]));
  }
  if (kept.size() < repeated.size()) {
    notes.push_back(text::joined(file, ": ", repeated.size() - kept.size(),
                                 " rows that stood there twice left out"));
  }
  rows = std::move(kept);
}

/// Later times of all files count on as if the row had lasted as long as others.
void set_clock_back(MendedRecording& mended) {
  Recording& recording = mended.recording;
  Drive& drive = recording.drive;
  std::vector<double> durations;
  for (std::size_t row = 0; row < drive.rows(); ++row) durations.push_back(drive.duration(row));
  const double usual = statistics::median(std::move(durations));
  for (const std::size_t row : clock_jumps(drive, {usual, 0.0})) {
    const double last = drive.t[row - 1];
    const double jump = drive.t[row] - last - usual;
    const auto back = [&](double& t) { t -= t > last ? jump : 0.0; };
    for (double& t : drive.t) back(t);
    for (Sighting& one : recording.sightings) back(one.t);
    for (Fix& one : recording.fixes) back(one.t);
    for (TruthRow& one : recording.truth) back(one.t);
    for (Loop& one : recording.loops) {
      back(one.t);
      back(one.t2);
    }
    mended.notes.push_back(text::joined("all files: ", text::shortest_text(jump),
                                        " s taken off the times after ", text::shortest_text(last),
                                        " s"));
  }
}

}  // namespace

MendedRecording mended(Recording recording, const Model* model) {
  MendedRecording result{std::move(recording), {}};
  mend_counters(result, model);
  leave_repeats_out(result.recording.sightings, "sightings.csv", result.notes);
  leave_repeats_out(result.recording.loops, "loops.csv", result.notes);
  set_clock_back(result);
  return result;
}

}  // namespace trussmap
