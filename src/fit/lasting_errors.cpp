// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measurement_rows.hpp"
#include "fit/fit_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace trussmap {
namespace {

constexpr std::array<double, 8> kLags{0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0};  // s, upper ends
constexpr double kGone = 0.3;                                                    // correlation
constexpr double kNoticeable = 0.3;  // correlation at the first lags, to be noticed at all
constexpr int kFewestPairs = 100;    // per lag
constexpr double kOneFrame = 1e-3;   // s
constexpr double kMostSds = 3.0;     // of an error, lest single ones decide

struct SeenError {
  double t = 0.0;
  Vector2 error = Vector2::Zero();  ///< whitened: range, bearing (or along, across)
};

/// Whitened errors by session and landmark, in order of time.
std::map<std::pair<int, int>, std::vector<SeenError>> errors_of(const fitting::FitState& fit) {
  std::map<std::pair<int, int>, std::vector<SeenError>> result;
  std::vector<bool> out(fit.problem.measurements.size(), false);
  for (const int k : fit.adjustment.left_out) out[idx(k)] = true;
  const Eigen::VectorXd offsets = fitting::offsets_of(fit);
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    const estimation::Measurement& one = fit.problem.measurements[k];
    if (!estimation::is_sighting(one) || !estimation::begins_with(one, "range") || out[k]) continue;
    const estimation::MeasurementRows rows =
        estimation::measurement_rows(fit.problem, one, fit.adjustment.state, one.value,
                                     estimation::view_of(fit.columns.border, offsets, one));
    const estimation::Vector4 white = one.whitener * rows.error;
    result[{one.session, one.to}].push_back({fit.problem.time_of(one.from), white.head<2>()});
  }
  return result;
}

struct LagSums {
  std::array<double, kLags.size()> products{};
  std::array<int, kLags.size()> pairs{};
};

LagSums lag_sums(const std::map<std::pair<int, int>, std::vector<SeenError>>& all,
                 const Vector2& scale) {
  LagSums sums;
  const auto limited = [&](const Vector2& error) {
    return Vector2(error.cwiseQuotient(scale).cwiseMin(kMostSds).cwiseMax(-kMostSds));
  };
  for (const auto& [key, errors] : all) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      for (std::size_t j = i + 1; j < errors.size(); ++j) {
        const double lag = errors[j].t - errors[i].t;
        if (lag > kLags.back()) break;
        if (lag < kOneFrame) continue;
        const auto bin = static_cast<std::size_t>(
            std::lower_bound(kLags.begin(), kLags.end(), lag) - kLags.begin());
        sums.products[bin] += 0.5 * limited(errors[i].error).dot(limited(errors[j].error));
        ++sums.pairs[bin];
      }
    }
  }
  return sums;
}

}  // namespace

LastingErrors lasting_errors(const ModelFit& fit) {
  const auto errors = errors_of(*fit.state);
  LastingErrors result;
  Vector2 squares = Vector2::Zero();
  for (const auto& [key, list] : errors) {
    for (const SeenError& one : list) squares += one.error.cwiseAbs2();
    result.sightings += static_cast<int>(list.size());
  }
  if (result.sightings < kFewestPairs || !(squares.minCoeff() > 0.0)) return result;
  const LagSums sums = lag_sums(errors, (squares / result.sightings).cwiseSqrt());
  bool noticed = false;
  for (std::size_t k = 0; k < kLags.size(); ++k) {
    if (sums.pairs[k] < kFewestPairs) continue;
    const double correlation = sums.products[k] / sums.pairs[k];
    if (!noticed && correlation < kNoticeable) return result;
    noticed = true;
    if (correlation >= kGone) result.lasts = kLags[k];
  }
  return result;
}

std::vector<DrivenRecording> thinned_frames(const std::vector<DrivenRecording>& recordings,
                                            double lasts) {
  std::vector<DrivenRecording> result = recordings;
  for (DrivenRecording& recording : result) {
    double frame = -std::numeric_limits<double>::infinity();
    std::erase_if(recording.sightings, [&](const Sighting& one) {
      if (one.standing() || one.t - frame < kOneFrame) return false;
      if (one.t - frame < lasts) return true;
      frame = one.t;
      return false;
    });
  }
  return result;
}

namespace {

/// Sightings from afar of one instant.
struct Frame {
  double t = 0.0;
  double tells = 0.0;
};

/// The frame of each sighting, -1 where the robot stands on the landmark.
std::vector<int> frames_of(const std::vector<Sighting>& sightings, std::vector<Frame>& frames) {
  std::map<std::string, double> count;
  for (const Sighting& one : sightings) count[one.landmark] += 1.0;
  std::vector<int> frame_of;
  for (const Sighting& one : sightings) {
    if (one.standing()) {
      frame_of.push_back(-1);
      continue;
    }
    if (frames.empty() || one.t - frames.back().t >= kOneFrame) frames.push_back({one.t, 0.0});
    // What one more adds to the logarithm of the information about its landmark.
    frames.back().tells += 1.0 / count[one.landmark];
    frame_of.push_back(static_cast<int>(frames.size()) - 1);
  }
  return frame_of;
}

}  // namespace

std::vector<DrivenRecording> richest_frames(const std::vector<DrivenRecording>& recordings,
                                            double every) {
  std::vector<DrivenRecording> result = recordings;
  for (DrivenRecording& recording : result) {
    std::vector<Frame> frames;
    const std::vector<int> frame_of = frames_of(recording.sightings, frames);
    std::map<double, std::size_t> richest;  // by the number of the span of time
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const double span = std::floor((frames[k].t - frames.front().t) / every);
      std::size_t& best = richest.try_emplace(span, k).first->second;
      if (frames[k].tells > frames[best].tells) best = k;
    }
    std::vector<bool> kept(frames.size(), false);
    for (const auto& [span, frame] : richest) kept[frame] = true;
    std::size_t at = 0;
    std::erase_if(recording.sightings, [&](const Sighting&) {
      const int frame = frame_of[at++];
      return frame >= 0 && !kept[idx(frame)];
    });
  }
  return result;
}

bool has_dense_frames(const std::vector<DrivenRecording>& recordings) {
  int pairs = 0;
  for (const DrivenRecording& recording : recordings) {
    std::map<std::string, double> last;
    for (const Sighting& one : recording.sightings) {
      if (one.standing()) continue;
      const auto [place, first] = last.try_emplace(one.landmark, one.t);
      if (!first && one.t - place->second < 1.0) ++pairs;
      place->second = one.t;
    }
  }
  return pairs >= kFewestPairs;
}

}  // namespace trussmap
