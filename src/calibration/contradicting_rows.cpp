// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/contradicting_rows.hpp"

#include "calibration/sought_constants.hpp"
#include "geometry/index.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace trussmap::calibration {
namespace {

constexpr double kScatter = 4.0;  // chi^2/dof: noise stated half as large, and more

template <typename Row>
void remove(std::vector<Row>& stream, const std::set<std::size_t>& rows) {
  for (auto at = rows.rbegin(); at != rows.rend(); ++at) {
    stream.erase(stream.begin() + static_cast<std::ptrdiff_t>(*at));
  }
}

/// Of one stream of a session, each row once.
std::set<std::size_t> rows_of(const std::vector<LeftOutRow>& all, int session,
                              estimation::RecordingStream stream) {
  std::set<std::size_t> rows;
  for (const LeftOutRow& one : all) {
    if (one.session == session && one.stream == stream) rows.insert(one.row);
  }
  return rows;
}

}  // namespace

bool is_contradicted(const WheelCalibration& found) {
  constexpr double kChance = 1e-6;
  return !found.settled || (scatter_of(found) > kScatter &&
                            statistics::chi2_p_value(found.chi2, found.dof) < kChance);
}

bool explains_more(const WheelCalibration& rest, const std::optional<WheelCalibration>& by_all) {
  constexpr double kShare = 0.5;                                   // of chi^2/dof
  if (!rest.settled || scatter_of(rest) > kScatter) return false;  // the model is wrong
  return !by_all || !by_all->settled || scatter_of(rest) < kShare * scatter_of(*by_all);
}

std::vector<LeftOutRow> contradicting_rows(const std::vector<DrivenRecording>& recordings,
                                           const Model& model,
                                           const WheelCalibrationOptions& options,
                                           const std::optional<WheelCalibration>& by_all) {
  constexpr double kGood = 2.0;  // chi^2/dof
  constexpr std::size_t kMostStarts = 4;
  constexpr int kRounds = 2;  // the constants are found by the rest alone
  constexpr int kTries = 2;   // that leave none out: many would have to go
  std::vector<std::vector<double>> starts = likely_starts(recordings, model, options);
  if (by_all) starts.insert(starts.begin(), in_force(by_all->model));
  if (starts.size() > kMostStarts) {  // the stated constants are the last
    starts.erase(starts.begin() + kMostStarts - 1, starts.end() - 1);
  }
  WheelCalibrationOptions how = options;
  how.noise = false;
  how.rounds = kRounds;
  std::vector<LeftOutRow> rows;
  std::optional<double> least;
  int without = 0;
  for (const std::vector<double>& start : starts) {
    try {
      CalibrationByParts one = calibrated_by_parts(start, recordings, model, how);
      const double cost = one.found.chi2 + *how.gate * static_cast<double>(one.left_out.size());
      if (one.left_out.empty() && ++without == kTries) break;
      if (least && cost >= *least) continue;
      least = cost;
      rows = std::move(one.left_out);
      if (!rows.empty() && scatter_of(one.found) < kGood) break;
    } catch (const SolveError&) {
      continue;
    }
  }
  return rows;
}

std::vector<DrivenRecording> without_rows(std::vector<DrivenRecording> recordings,
                                          const std::vector<LeftOutRow>& rows) {
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const auto of = [&](estimation::RecordingStream stream) {
      return rows_of(rows, static_cast<int>(s), stream);
    };
    remove(recordings[s].sightings, of(estimation::RecordingStream::sightings));
    remove(recordings[s].fixes, of(estimation::RecordingStream::fixes));
    remove(recordings[s].loops, of(estimation::RecordingStream::loops));
  }
  return recordings;
}

}  // namespace trussmap::calibration
