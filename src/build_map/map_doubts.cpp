// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/map_doubts.hpp"

#include "build_map/measured_doubts.hpp"
#include "geometry/units.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include <Eigen/LU>

namespace trussmap::map_building {
namespace {

void doubt_units(const std::vector<DrivenRecording>& recordings, const Model& model,
                 std::vector<std::string>& warnings) {
  constexpr double kFast = 30.0;  // m/s
  constexpr double kWide = 10.0;  // m
  for (const DrivenRecording& recording : recordings) {
    const MotionRows& drive = recording.drive;
    double path = 0.0;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const auto [left, right] = drive::own_travel(drive, row, model.robot);
      path += std::max(std::abs(left), std::abs(right));
    }
    const double speed = path / (drive.t.back() - drive.start());
    if (speed > kFast) {
      warnings.push_back(recording.name + ": the wheels drive at " + text::short_text(speed, 3) +
                         " m/s on average; are left and right in metres, t in seconds?");
    }
  }
  if (model.robot.wheelbase > kWide) {
    warnings.push_back("a wheelbase of " + text::short_text(model.robot.wheelbase) +
                       " m; is it in metres?");
  }
}

/// How far the map's routes are from what was measured of them, in standard deviations, in the
/// middle of all routes. Sound maps have 1 to 5.
double contradiction(const LandmarkGraph& map) {
  std::vector<double> distances;
  for (int k = 0; k < map.routes(); ++k) {
    const Route& route = map.route(k);
    const Vector2 off = map.landmark(route.target).position - map.landmark(route.source).position -
                        route.displacement;
    distances.push_back(std::sqrt(off.dot(route.covariance.inverse() * off)));
  }
  return distances.empty() ? 0.0 : statistics::median(std::move(distances));
}

/// Rms distance of the built map from the adjusted one, after rotation and translation, m.
double distance_from(const fitting::FitState& fit, const LandmarkGraph& map) {
  std::vector<Vector2> here, there;
  for (std::size_t k = 0; k < fit.problem.landmarks.size(); ++k) {
    const std::optional<int> landmark = map.find(fit.problem.landmarks[k]);
    if (!landmark) continue;
    here.push_back(map.landmark(*landmark).position);
    there.push_back(fit.adjustment.state.landmarks[k]);
  }
  return here.size() < 2 ? 0.0 : align_rigidly(here, there).rms;
}

int sightings_of(const estimation::RecordingProblem& problem) {
  return static_cast<int>(std::count_if(problem.measurements.begin(), problem.measurements.end(),
                                        estimation::is_sighting));
}

std::string words_of(const FreedError& one) {
  const double value = one.effect.coefficients.front();
  const double sd = one.sd.front();
  const auto percent = [&] {
    return text::signed_fixed_text(100.0 * value, 2) + " +- " + text::fixed_text(100.0 * sd, 2) +
           " %";
  };
  if (facts_of(one.effect.channel).unit == "rad/s") {
    return one.effect.name + " " + text::signed_fixed_text(60.0 * value / geometry::kDegree, 1) +
           " +- " + text::fixed_text(60.0 * sd / geometry::kDegree, 1) + " deg/min";
  }
  if (one.effect.channel == Channel::compass) {
    return one.effect.name + " " +
           text::fixed_text(std::hypot(value, one.effect.coefficients.back()) / geometry::kDegree,
                            2) +
           " +- " + text::fixed_text(std::max(sd, one.sd.back()) / geometry::kDegree, 2) + " deg";
  }
  if (one.effect.channel == Channel::turn) return "turns " + percent() + " (wheelbase)";
  return one.effect.name + " " + percent();
}

/// Those that stand out on their own, or all where none does.
std::string words_of(const std::vector<FreedError>& freed) {
  constexpr double kStandsOut = 3.0;  // standard deviations
  std::string notable, all;
  for (const FreedError& one : freed) {
    double most = 0.0;
    for (std::size_t k = 0; k < one.sd.size(); ++k) {
      most = std::max(most, std::abs(one.effect.coefficients[k]) / one.sd[k]);
    }
    const std::string words = words_of(one);
    all += (all.empty() ? "" : ", ") + words;
    if (most > kStandsOut) notable += (notable.empty() ? "" : ", ") + words;
  }
  return notable.empty() ? all : notable;
}

/// Landmarks that lost more sightings than they kept, and those that hang on a single one from
/// afar.
struct Supports {
  std::vector<std::string> contradicted;
  std::vector<std::string> single;
};

Supports supports_of(const fitting::FitState& fit) {
  const estimation::RecordingProblem& problem = fit.problem;
  std::vector<int> kept(problem.landmarks.size());
  std::vector<int> lost(problem.landmarks.size());
  std::vector<bool> stood_on(problem.landmarks.size());
  for (const estimation::Measurement& one : problem.measurements) {
    if (!estimation::is_sighting(one)) continue;
    ++kept[idx(one.to)];
    if (estimation::is_standing(one)) stood_on[idx(one.to)] = true;
  }
  for (const int k : fit.adjustment.left_out) {
    const estimation::Measurement& one = problem.measurements[idx(k)];
    if (!estimation::is_sighting(one)) continue;
    --kept[idx(one.to)];
    ++lost[idx(one.to)];
  }
  Supports result;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (lost[k] >= kept[k]) result.contradicted.push_back(problem.landmarks[k]);
    if (kept[k] == 1 && lost[k] == 0 && !stood_on[k]) result.single.push_back(problem.landmarks[k]);
  }
  return result;
}

/// Fixes and loops that were left out; the sightings stand in BuiltMap::rejected.
void tell_left_out(const fitting::FitState& fit, std::vector<std::string>& warnings) {
  constexpr int kNamed = 5;
  int count = 0;
  for (const int k : fit.adjustment.left_out) {
    const estimation::Measurement& one = fit.problem.measurements[idx(k)];
    if (estimation::is_sighting(one)) continue;
    if (++count <= kNamed)
      warnings.push_back(estimation::describe(fit.problem, one) + " was left out");
  }
  if (count > kNamed) {
    warnings.push_back(text::joined("and ", count - kNamed, " more fixes or loops were left out"));
  }
}

/// What was built, of what, and when a gate should be given.
struct Words {
  std::string built;
  std::string of;
  std::string gate_if;
};

void doubt_fit(BuiltMap& built, const MapFitState& best) {
  constexpr double kManyOut = 0.08;
  constexpr double kSurelyFreed = 1e-3;
  constexpr double kImplausible = 1e-4;
  constexpr double kNoticeable = 1.1;  // of the dispersion
  const estimation::RecordingAdjustment& fit = best.fit.adjustment;
  const Words words = built.paths.empty()
                          ? Words{"map", "sightings", "labels are often misread"}
                          : Words{"path", "fixes and loops", "they are often wrong"};
  std::vector<std::string>& warnings = built.warnings;
  if (!fit.converged) {
    warnings.push_back(text::joined("no minimum was reached in ", fit.iterations,
                                    " iterations: the ", words.built, " is not the best one"));
  }
  if (!built.freed.empty()) {
    const std::string freed = words_of(built.freed);
    if (best.p_freed < kSurelyFreed) {
      warnings.push_back("the robot is not as its model says (" + freed +
                         ", estimated beside the " + words.built +
                         "); run discover for what is missing");
    } else {
      built.notes.push_back("estimated beside the " + words.built +
                            ", though hardly more than noise: " + freed);
    }
  }
  if (best.antenna) {
    const Mounting& at = best.antenna->place;
    warnings.push_back(
        text::joined("the antenna of the fixes sits ", text::signed_fixed_text(at.x, 3),
                     " m ahead of "
                     "the axle's centre and ",
                     text::signed_fixed_text(at.y, 3), " m to its left (+- ",
                     text::fixed_text(best.antenna->sd, 3),
                     "), by the sightings, and is taken "
                     "to be there: the model has it at the centre; state [robot.antenna], "
                     "or calibrate"));
  }
  const double share = built.quality.left_out_share;
  if (std::isinf(fit.gate_widened)) {
    warnings.push_back("so many " + words.of +
                       " contradict the rest that none was left out: the model is wrong, or its "
                       "noise is far too small; run discover, or give a gate (4, say) if " +
                       words.gate_if);
  } else if (fit.gate_widened > 1.0) {
    warnings.push_back(
        "more " + words.of + " contradict the rest than are ever wrong: only those beyond " +
        text::fixed_text(kAdjustmentGate * fit.gate_widened, 0) +
        " standard deviations were left out; the model is wrong, or its noise is too "
        "small; run discover");
  } else if (share > kManyOut) {
    warnings.push_back(text::fixed_text(100.0 * share, 0) + " % of the " + words.of +
                       " contradict the rest and were left out: that many are seldom wrong; run "
                       "discover");
  }
  if (fit.p_value < kImplausible && built.quality.dispersion > kNoticeable) {
    warnings.push_back("errors are " + text::times_text(std::sqrt(built.quality.dispersion)) +
                       " times what the model's noise allows: its noise is too small, or an effect "
                       "is missing; run discover");
  }
}

/// A path that hangs on too little.
void doubt_ties(BuiltMap& built) {
  constexpr double kLoose = 0.1;  // of the path's extent
  for (const BuiltPath& path : built.paths) {
    if (path.median_sd <= kLoose * extent_of(path.adjusted)) continue;
    built.warnings.push_back((built.paths.size() > 1 ? path.recording + ": " : std::string()) +
                             "the path is loosely tied: half of it is uncertain by " +
                             text::fixed_text(path.median_sd, 2) +
                             " m or more; it takes more fixes, or loops");
  }
}

std::vector<std::string> unique(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void doubt_shape(BuiltMap& built, const MapFitState& best) {
  constexpr double kTorn = 20.0;      // standard deviations
  constexpr double kMuchWorse = 3.0;  // times the adjusted map's standard error
  constexpr double kLoose = 0.1;      // of the map's extent
  const double extent = extent_of(built.map);
  std::vector<std::string>& warnings = built.warnings;
  if (built.quality.median_sd > kLoose * extent) {
    warnings.push_back("the landmarks are loosely tied together: half of them are uncertain by " +
                       text::fixed_text(built.quality.median_sd, 2) +
                       " m or more; drive more loops");
  }
  if (built.method != Method::adjustment) {
    const double off = built.quality.from_adjusted;
    const bool apart = off > kMuchWorse * built.quality.median_sd && off > kLoose * extent;
    if (!built.off_map.empty()) {
      warnings.push_back(text::joined(built.off_map.size(),
                                      " arrivals contradict the map and were left "
                                      "out of it, at: ") +
                         listed(unique(built.off_map)) +
                         "; have these landmarks moved, or were labels misread?");
    }
    if (apart && built.extended) {
      warnings.push_back("adjusted by itself, the recording puts its landmarks " +
                         text::fixed_text(off, 2) +
                         " m (rms) from where the map has them: have some moved, or is it another "
                         "place?");
    } else if (apart) {
      warnings.push_back("this method's map lies " + text::fixed_text(off, 2) +
                         " m (rms) from the adjusted one, which is the better one: take that");
    }
    if (!best.fit.model.noise.processes.empty()) {
      built.notes.push_back(
          "routes know the model's white noise alone; noise that lasts is known to "
          "the method adjustment");
    }
  }
  const double torn = contradiction(built.map);
  if (torn > kTorn) {
    warnings.push_back("the map contradicts its own routes, by " + text::fixed_text(torn, 0) +
                       " standard deviations in the middle; " +
                       (built.method == Method::elastic_printed
                            ? "the printed refinement diverges here, use the method elastic"
                            : "wrong units, a wrong wheelbase, exchanged columns or labels, or "
                              "noise that is believed too small"));
  }
  Supports supports = supports_of(best.fit);
  if (!supports.contradicted.empty()) {
    warnings.push_back("at least as many sightings were left out as kept of: " +
                       listed(supports.contradicted) + "; where they are is not certain");
  }
  std::vector<std::string> missing;
  for (const std::string& name : best.fit.problem.landmarks) {
    if (!built.map.find(name)) missing.push_back(name);
  }
  if (!missing.empty()) {
    built.notes.push_back("not in the map, for no leg and no stop of a leg has them: " +
                          listed(missing));
  }
  if (!supports.single.empty()) {
    built.notes.push_back("sighted only once, so that nothing checks where they are: " +
                          listed(supports.single));
  }
  built.unconfirmed = std::move(supports.single);
}

}  // namespace

double extent_of(const std::vector<Vector2>& places) {
  const double count = std::max(1.0, static_cast<double>(places.size()));
  Vector2 middle = Vector2::Zero();
  for (const Vector2& one : places) middle += one / count;
  double sum = 0.0;
  for (const Vector2& one : places) sum += (one - middle).squaredNorm();
  return std::sqrt(sum / count);
}

double extent_of(const LandmarkGraph& map) {
  std::vector<Vector2> places;
  places.reserve(idx(map.landmarks()));
  for (int k = 0; k < map.landmarks(); ++k) places.push_back(map.landmark(k).position);
  return extent_of(places);
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 5;
  std::string result;
  for (std::size_t k = 0; k < std::min(names.size(), kNamed); ++k) {
    result += (k == 0 ? "" : ", ") + names[k];
  }
  return names.size() > kNamed ? text::joined(result, " and ", names.size() - kNamed, " more")
                               : result;
}

MapQuality quality_of(const BuiltMap& built, const MapFitState& best, const ReckonedMap& reckoned) {
  const estimation::RecordingAdjustment& fit = best.fit.adjustment;
  MapQuality result;
  result.dispersion = fit.chi2 / std::max(1, fit.dof);
  const double scale = std::sqrt(std::max(1.0, result.dispersion));
  std::vector<double> sds;
  for (std::size_t k = 0; k < fit.landmark_sds.size(); ++k) {
    sds.push_back(scale * fit.landmark_sds[k]);
    if (sds.back() < result.worst_sd) continue;
    result.worst_sd = sds.back();
    result.worst_landmark = best.fit.problem.landmarks[k];
  }
  result.median_sd = statistics::median(std::move(sds));
  std::vector<double> headings;
  for (const double sd : fit.orientation_sds) {
    if (!std::isnan(sd)) headings.push_back(scale * sd);
  }
  result.oriented = static_cast<int>(headings.size());
  if (!headings.empty()) result.median_sd_heading = statistics::median(std::move(headings));
  result.loops = static_cast<int>(reckoned.misclosures.size());
  result.misclosure_share = statistics::median(reckoned.misclosures);
  result.sightings = sightings_of(best.fit.problem);
  const auto lost = std::count_if(fit.left_out.begin(), fit.left_out.end(), [&](int k) {
    return estimation::is_sighting(best.fit.problem.measurements[idx(k)]);
  });
  result.left_out_share = static_cast<double>(lost) / std::max(1, result.sightings);
  result.from_adjusted =
      built.method == Method::adjustment ? 0.0 : distance_from(best.fit, built.map);
  return result;
}

void doubt(BuiltMap& built, const MapFitState& best, const std::vector<DrivenRecording>& recordings,
           const Model& model) {
  doubt_units(recordings, model, built.warnings);
  doubt_fit(built, best);
  if (!built.paths.empty()) {
    doubt_ties(built);
    doubt_against_truth(built);
    return;
  }
  tell_left_out(best.fit, built.warnings);
  std::ranges::move(estimation::mirror_warnings(best.fit.problem, best.fit.adjustment),
                    std::back_inserter(built.warnings));
  doubt_shape(built, best);
  doubt_against_survey(built, model.noise);
  doubt_against_truth(built, best.fit, recordings);
}

}  // namespace trussmap::map_building
