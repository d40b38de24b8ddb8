// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/reference_alignment.hpp"

#include "calibration/sensor_places.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace trussmap::calibration {
namespace {

// Far beyond what a marker put on by hand or two logs cut by hand are off by.
constexpr double kPlaceSd = 3.0;       // m: a long vehicle's
constexpr double kHeadingSd = 0.1;     // rad
constexpr double kYawSd = 0.5;         // rad, of a sensor
constexpr double kLateSd = 0.3;        // s
constexpr double kClockSd = 0.001;     // s/s
constexpr double kUselessPlace = 0.1;  // m, a standard error
constexpr double kUselessYaw = 0.1;    // rad

/// Where the robot was `late` seconds before time t, seen from where it is at t; at rest outside
/// of the drive.
Pose way_back(const MotionRows& drive, double t, double late) {
  const auto inside = [&drive](double at) { return std::clamp(at, drive.start(), drive.t.back()); };
  const double from = inside(std::min(t, t - late));
  const double to = inside(std::max(t, t - late));
  if (!(to > from)) return {};
  const Pose way =
      estimation::segment_motion(estimation::segment_rows(drive, from, to)).displacement;
  return late > 0.0 ? inverse(way) : way;
}

/// What one second of lateness does to a truth row: the way back over the lateness of an earlier
/// fit, which is exact there; without one, that of a moment about the row.
effects::ViewPattern per_second(const MotionRows& drive, double t, double late) {
  constexpr double kMoment = 0.15;     // s: longer than a row's jitter
  constexpr double kTellable = 0.005;  // s
  Pose back;
  double seconds = late;
  if (std::abs(late) < kTellable) {
    back = way_back(drive, t + 0.5 * kMoment, kMoment);
    seconds = kMoment;
  } else {
    back = way_back(drive, t, late);
  }
  effects::ViewPattern result;
  result.ahead = back.x / seconds;
  result.left = back.y / seconds;
  result.heading = back.heading / seconds;
  return result;
}

effects::ViewPattern times(const effects::ViewPattern& pattern, double factor) {
  effects::ViewPattern result;
  result.ahead = factor * pattern.ahead;
  result.left = factor * pattern.left;
  result.heading = factor * pattern.heading;
  return result;
}

double lateness(const TruthAlignment& alignment, int session, double t) {
  const auto found = alignment.clocks.find(session);
  if (found == alignment.clocks.end()) return 0.0;
  return found->second.late + found->second.drift * (t - found->second.start);
}

int session_of(const std::vector<int>& sessions, std::size_t recording) {
  return sessions.empty() ? static_cast<int>(recording) : sessions[recording];
}

/// Sessions with such rows, and when their drives start.
template <typename Row>
std::map<int, TruthClock> clocks_of(const std::vector<DrivenRecording>& recordings,
                                    std::vector<Row> Observations::*rows,
                                    const std::vector<int>& sessions) {
  std::map<int, TruthClock> clocks;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    if ((recordings[k].*rows).empty()) continue;
    clocks.try_emplace(session_of(sessions, k), TruthClock{0.0, 0.0, recordings[k].drive.start()});
  }
  return clocks;
}

/// Patterns of the rows of truth, or of the fixes.
using Patterns = std::vector<std::vector<effects::ViewPattern>> estimation::EffectPattern::*;

/// One value for all rows of all recordings.
template <typename Row>
estimation::EffectPattern everywhere(const char* name, const effects::ViewPattern& unit,
                                     double prior_sd,
                                     const std::vector<DrivenRecording>& recordings,
                                     std::vector<Row> Observations::*rows, Patterns patterns) {
  estimation::EffectPattern result;
  result.name = name;
  result.prior_sd = prior_sd;
  for (const DrivenRecording& one : recordings) {
    (result.*patterns).emplace_back((one.*rows).size(), unit);
  }
  return result;
}

/// How late one session's rows are, with `late_at` what an earlier fit has found of that.
template <typename Row, typename LateAt>
estimation::EffectPattern lateness_of(int session, const std::vector<DrivenRecording>& recordings,
                                      std::vector<Row> Observations::*rows, Patterns patterns,
                                      const std::vector<int>& sessions, const LateAt& late_at) {
  estimation::EffectPattern result;
  result.prior_sd = kLateSd;
  (result.*patterns).resize(recordings.size());
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    if (session_of(sessions, k) != session) continue;
    for (const Row& row : recordings[k].*rows) {
      (result.*patterns)[k].push_back(per_second(recordings[k].drive, row.t, late_at(row.t)));
    }
  }
  return result;
}

/// The clock that a lateness grows by.
estimation::EffectPattern drift_of(const estimation::EffectPattern& late,
                                   const std::vector<DrivenRecording>& recordings, double start) {
  estimation::EffectPattern result = late;
  result.name = "truth's clock";
  result.prior_sd = kClockSd;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    for (std::size_t row = 0; row < result.truths[k].size(); ++row) {
      result.truths[k][row] = times(late.truths[k][row], recordings[k].truth[row].t - start);
    }
  }
  return result;
}

constexpr effects::ViewPattern kAhead{.ahead = 1.0};
constexpr effects::ViewPattern kLeft{.left = 1.0};
constexpr effects::ViewPattern kTurned{.heading = 1.0};

estimation::EffectParameters of_truth(const std::vector<DrivenRecording>& recordings,
                                      const std::vector<int>& sessions,
                                      const TruthAlignment& prior) {
  estimation::EffectParameters parameters;
  const std::map<int, TruthClock> clocks = clocks_of(recordings, &Observations::truth, sessions);
  if (clocks.empty()) return parameters;
  const auto add = [&](const char* name, const effects::ViewPattern& unit, double sd) {
    parameters.push_back(everywhere(name, unit, sd, recordings, &Observations::truth,
                                    &estimation::EffectPattern::truths));
  };
  add("truth's point, ahead", kAhead, kPlaceSd);
  add("truth's point, left", kLeft, kPlaceSd);
  add("truth's heading", kTurned, kHeadingSd);
  for (const auto& [session, start] : clocks) {
    const int number = session;
    estimation::EffectPattern late =
        lateness_of(number, recordings, &Observations::truth, &estimation::EffectPattern::truths,
                    sessions, [&](double t) { return lateness(prior, number, t); });
    late.name = "truth late";
    estimation::EffectPattern clock = drift_of(late, recordings, start.start);
    parameters.push_back(std::move(late));
    parameters.push_back(std::move(clock));
  }
  return parameters;
}

estimation::EffectParameters of_fixes(const std::vector<DrivenRecording>& recordings,
                                      const std::vector<int>& sessions, const FixAlignment& prior) {
  estimation::EffectParameters parameters;
  const std::map<int, TruthClock> clocks = clocks_of(recordings, &Observations::fixes, sessions);
  if (clocks.empty()) return parameters;
  for (const auto& [name, unit] :
       {std::pair{"antenna, ahead", kAhead}, std::pair{"antenna, left", kLeft}}) {
    parameters.push_back(everywhere(name, unit, kPlaceSd, recordings, &Observations::fixes,
                                    &estimation::EffectPattern::fixes));
  }
  for (const auto& [session, start] : clocks) {
    const auto known = prior.late.find(session);
    const double so_far = known == prior.late.end() ? 0.0 : known->second;
    estimation::EffectPattern late =
        lateness_of(session, recordings, &Observations::fixes, &estimation::EffectPattern::fixes,
                    sessions, [so_far](double) { return so_far; });
    late.name = "fixes late";
    parameters.push_back(std::move(late));
  }
  return parameters;
}

template <typename Row>
estimation::EffectParameters of_mounting(const std::vector<DrivenRecording>& recordings,
                                         std::vector<Row> Observations::*rows, Patterns patterns) {
  estimation::EffectParameters parameters;
  for (const auto& [name, unit, sd] :
       {std::tuple{"sensor, ahead", kAhead, kPlaceSd}, std::tuple{"sensor, left", kLeft, kPlaceSd},
        std::tuple{"sensor, yaw", kTurned, kYawSd}}) {
    parameters.push_back(everywhere(name, unit, sd, recordings, rows, patterns));
  }
  return parameters;
}

/// Reads coefficients one after the other.
class CoefficientReader {
 public:
  CoefficientReader(const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance)
      : values_(values), covariance_(covariance) {}

  double value() { return values_[at_++]; }

  /// Beside what was stated; kept with its error where that is below `useless`.
  double beside(double stated, double useless, std::optional<Calibrated>& kept) {
    const double sd = std::sqrt(covariance_(at_, at_));
    const double found = stated + value();
    if (sd < useless) kept = Calibrated{found, sd};
    return found;
  }

  CalibratedMounting mounting(const char* of, const std::optional<Mounting>& stated, bool turns) {
    const Mounting from = stated.value_or(Mounting());
    CalibratedMounting result{.of = of};
    place.x = beside(from.x, kUselessPlace, result.x);
    place.y = beside(from.y, kUselessPlace, result.y);
    if (turns) place.yaw = beside(from.yaw, kUselessYaw, result.yaw);
    return result;
  }

  Mounting place;  ///< of the mounting read last, sure or not

 private:
  const Eigen::VectorXd& values_;
  const Eigen::MatrixXd& covariance_;
  Eigen::Index at_ = 0;
};

}  // namespace

ReferencesUsed references_in(const std::vector<DrivenRecording>& recordings,
                             const estimation::ProblemOptions& used) {
  const auto any = [&](const auto& has) {
    return std::any_of(recordings.begin(), recordings.end(), has);
  };
  const auto sees = [](const DrivenRecording& one) {
    return std::any_of(one.sightings.begin(), one.sightings.end(),
                       [](const Sighting& sighting) { return !sighting.standing(); });
  };
  return {used.truth && any([](const DrivenRecording& one) { return !one.truth.empty(); }),
          used.fixes && any([](const DrivenRecording& one) { return !one.fixes.empty(); }),
          any(sees),
          used.loops && any([](const DrivenRecording& one) { return !one.loops.empty(); })};
}

estimation::EffectParameters reference_alignment(const std::vector<DrivenRecording>& recordings,
                                                 const ReferencesUsed& used,
                                                 const std::vector<int>& sessions,
                                                 const ReferenceAlignment& prior) {
  estimation::EffectParameters parameters;
  const auto add = [&parameters](estimation::EffectParameters more) {
    for (estimation::EffectPattern& one : more) parameters.push_back(std::move(one));
  };
  if (used.truth) add(of_truth(recordings, sessions, prior.truth));
  if (used.fixes) add(of_fixes(recordings, sessions, prior.fixes));
  if (used.sensor) {
    add(of_mounting(recordings, &Observations::sightings, &estimation::EffectPattern::sightings));
  }
  if (used.scanner)
    add(of_mounting(recordings, &Observations::loops, &estimation::EffectPattern::loops));
  return parameters;
}

ReferenceAlignment alignment_of(const std::vector<DrivenRecording>& recordings, const Robot& robot,
                                const ReferencesUsed& used, const std::vector<int>& sessions,
                                const Eigen::VectorXd& coefficients,
                                const Eigen::MatrixXd& covariance) {
  const Mountings& stated = robot.mounted;
  ReferenceAlignment result;
  CoefficientReader reader(coefficients, covariance);
  if (used.truth) {
    TruthAlignment& truth = result.truth;
    truth.clocks = clocks_of(recordings, &Observations::truth, sessions);
    result.mountings.push_back(reader.mounting("tracked", stated.tracked, true));
    truth.ahead = reader.place.x;
    truth.left = reader.place.y;
    truth.heading = reader.place.yaw;
    for (auto& [session, clock] : truth.clocks) {
      clock.late = reader.value();
      clock.drift = reader.value();
    }
  }
  if (used.fixes) {
    result.mountings.push_back(reader.mounting("antenna", stated.antenna, false));
    result.fixes.ahead = reader.place.x;
    result.fixes.left = reader.place.y;
    for (const auto& [session, clock] : clocks_of(recordings, &Observations::fixes, sessions)) {
      result.fixes.late[session] = reader.value();
    }
  }
  if (used.sensor) result.mountings.push_back(reader.mounting("sensor", stated.sensor, true));
  if (used.scanner) result.mountings.push_back(reader.mounting("scanner", stated.scanner, true));
  return result;
}

Mountings with_found(Mountings mounted, const ReferenceAlignment& found) {
  for (const CalibratedMounting& one : found.mountings) {
    std::optional<Mounting>& at = mounted.*place_named(one.of);
    if (!one.x && !one.y && !one.yaw) continue;
    if (!at) at.emplace();
    if (one.x) at->x = one.x->value;
    if (one.y) at->y = one.y->value;
    if (one.yaw) at->yaw = one.yaw->value;
  }
  return mounted;
}

std::vector<DrivenRecording> aligned(const std::vector<DrivenRecording>& recordings,
                                     const TruthAlignment& alignment) {
  std::vector<DrivenRecording> result = recordings;
  for (std::size_t k = 0; k < result.size(); ++k) {
    for (TruthRow& row : result[k].truth) {
      const double late = lateness(alignment, static_cast<int>(k), row.t);
      const Pose back = way_back(result[k].drive, row.t, late);
      row.heading = wrap_angle(row.heading - alignment.heading - back.heading);
      const Vector2 lever =
          rotation(row.heading) * Vector2(alignment.ahead + back.x, alignment.left + back.y);
      row.x -= lever.x();
      row.y -= lever.y();
    }
  }
  return result;
}

}  // namespace trussmap::calibration
