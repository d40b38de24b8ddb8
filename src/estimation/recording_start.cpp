// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_start.hpp"

#include "estimation/multilateration.hpp"
#include "estimation/pose_reckoner.hpp"
#include "estimation/recording_descent.hpp"
#include "estimation/recording_robust.hpp"
#include "estimation/triangulation.hpp"
#include "statistics/median.hpp"
#include "statistics/thinned.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace trussmap {
namespace {

bool in_map_frame(const Measurement& one) {
  return one.kind == MeasurementKind::survey || one.kind == MeasurementKind::truth ||
         one.kind == MeasurementKind::fix;
}

bool between_poses(const Measurement& one) {
  return one.kind == MeasurementKind::segment || one.kind == MeasurementKind::loop;
}

/// Measurements by the poses that they belong to.
struct ByPose {
  std::vector<int> segment_from;  ///< measurement that leads on from here, -1: none
  std::vector<std::vector<int>> others;
};

ByPose by_pose(const RecordingProblem& problem) {
  ByPose result;
  result.segment_from.assign(problem.poses.size(), -1);
  result.others.resize(problem.poses.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    const bool of_pose = one.kind != MeasurementKind::survey &&
                         one.kind != MeasurementKind::survey_heading &&
                         one.kind != MeasurementKind::gyro;
    if (!of_pose) continue;
    const std::size_t pose = idx(one.from - problem.landmark_count());
    if (one.kind == MeasurementKind::segment) {
      result.segment_from[pose] = static_cast<int>(k);
    } else {
      result.others[pose].push_back(static_cast<int>(k));
    }
  }
  return result;
}

/// Poses of one problem part, laid down one after the other.
class Layer {
 public:
  Layer(const RecordingProblem& problem, const EffectParameters& border,
        const StartOptions& options)
      : problem_(problem),
        border_(border),
        options_(options),
        links_(by_pose(problem)),
        landmarks_(problem.landmarks.size()),
        orientations_(problem.oriented.size()),
        poses_(problem.poses.size()),
        coefficients_(prior_of(border)) {}

  /// Poses first ... last, from a pose that is known that well.
  void lay(int first, int last, const Pose& start, const Matrix3& covariance, bool correct) {
    PoseReckoner robot(problem_, border_, {options_.map_sd, options_.gate}, landmarks_,
                       orientations_);
    robot.place(start, covariance, coefficients_);
    for (int k = first; k <= last; ++k) {
      const int segment = links_.segment_from[idx(k)];
      if (segment >= 0) robot.read_compass(problem_.measurements[idx(segment)]);
      robot.look(seen_at(k), correct);
      poses_[idx(k)] = robot.pose();
      if (k < last) robot.drive(problem_.measurements[idx(segment)]);
    }
    coefficients_ = robot.coefficients();
  }

  /// Poses before `first`, backwards, by the motions alone.
  void lay_backwards(int first) {
    for (int k = first - 1; k >= 0; --k) {
      const Measurement& segment = problem_.measurements[idx(links_.segment_from[idx(k)])];
      const Pose motion{segment.value[0], segment.value[1], segment.value[2]};
      poses_[idx(k)] = compose(poses_[idx(k + 1)], inverse(motion));
      for (const Measurement* one : seen_at(k)) {
        if (!locates(*one) || landmarks_[idx(one->to)]) continue;
        const Pose& pose = poses_[idx(k)];
        landmarks_[idx(one->to)] = pose.position() + rotation(pose.heading) * offset_of(*one);
      }
    }
  }

  /// Landmarks of which the first `count` poses have ranges or bearings alone: those that these
  /// tell, or at last all that have some.
  void place_from_afar(int count, bool at_last) {
    std::map<int, std::vector<RangeReading>> readings;
    std::map<int, std::vector<DirectionReading>> sights;
    for (int k = 0; k < count; ++k) {
      const Pose& pose = poses_[idx(k)];
      for (const Measurement* one : seen_at(k)) {
        if (!is_sighting(one->kind) || locates(*one) || landmarks_[idx(one->to)]) continue;
        const double own = std::sqrt(covariance_of(*one)(0, 0));
        if (one->kind == MeasurementKind::direction) {
          constexpr double kHeadingSd = 0.05;  // rad, of the path so far
          sights[one->to].push_back(
              {pose.position(), pose.heading + one->value[0], std::hypot(own, kHeadingSd)});
          continue;
        }
        const double sd = std::hypot(own, options_.map_sd);
        readings[one->to].push_back({pose.position(), one->value[0], sd});
      }
    }
    for (const auto& [landmark, of_it] : readings) {
      if (const std::optional<Multilateration> found = multilaterate(of_it)) {
        if (found->certain || at_last) landmarks_[idx(landmark)] = found->place;
      } else if (at_last) {
        // Anywhere but along an axis, so that rounding shows which unknown is free.
        landmarks_[idx(landmark)] = of_it.front().from + of_it.front().range * rotation(1.0).col(0);
      }
    }
    for (const auto& [landmark, of_it] : sights) {
      if (landmarks_[idx(landmark)]) continue;
      if (const std::optional<Triangulation> found = triangulate(of_it)) {
        if (found->certain || at_last) landmarks_[idx(landmark)] = found->place;
      } else if (at_last) {
        landmarks_[idx(landmark)] = of_it.front().from + rotation(of_it.front().direction).col(0);
      }
    }
  }

  [[nodiscard]] std::vector<const Measurement*> seen_at(int pose) const {
    std::vector<const Measurement*> seen;
    for (const int k : links_.others[idx(pose)]) seen.push_back(&problem_.measurements[idx(k)]);
    return seen;
  }

  /// The compass at the first pose that has one, less the turn up to there.
  [[nodiscard]] Pose first_pose() const {
    Pose pose;
    double turned = 0.0;
    for (const int segment : links_.segment_from) {
      if (segment < 0) break;
      const Measurement& one = problem_.measurements[idx(segment)];
      if (one.rows == 4) {
        pose.heading = wrap_angle(one.value[3] - turned);
        break;
      }
      turned += one.value[2];
    }
    return pose;
  }

  [[nodiscard]] const Measurement* truth_at(int pose) const {
    for (const Measurement* one : seen_at(pose)) {
      if (one->kind == MeasurementKind::truth) return one;
    }
    return nullptr;
  }

  struct Laid {
    PlacedLandmarks landmarks;
    KnownOrientations orientations;
    std::vector<Pose> poses;
    KnownCoefficients coefficients;
  };
  [[nodiscard]] Laid laid() const { return {landmarks_, orientations_, poses_, coefficients_}; }
  void take_back(const Laid& before) {
    landmarks_ = before.landmarks;
    orientations_ = before.orientations;
    poses_ = before.poses;
    coefficients_ = before.coefficients;
  }

  [[nodiscard]] int pose_count() const { return static_cast<int>(poses_.size()); }
  PlacedLandmarks& landmarks() { return landmarks_; }
  KnownOrientations& orientations() { return orientations_; }
  std::vector<Pose>& poses() { return poses_; }
  KnownCoefficients& coefficients() { return coefficients_; }
  [[nodiscard]] const EffectParameters& border() const { return border_; }

 private:
  const RecordingProblem& problem_;
  const EffectParameters& border_;
  StartOptions options_;
  ByPose links_;
  PlacedLandmarks landmarks_;
  KnownOrientations orientations_;
  std::vector<Pose> poses_;
  KnownCoefficients coefficients_;
};

/// Where a pose that a fix belongs to is now, and where the fix has it.
struct FixedPlace {
  Vector2 here;
  Vector2 there;
};

double truncated_cost(const Alignment& over, const std::vector<FixedPlace>& places, double limit) {
  double sum = 0.0;
  for (const FixedPlace& one : places) {
    sum += std::min((over.apply(one.here) - one.there).squaredNorm(), limit * limit);
  }
  return sum;
}

/// The rotation and translation that suit most fixes, from pairs of them; those that are further
/// off than `limit` (m) have no say. Shifted only where no two of them are `apart`.
Alignment align_to_most(const std::vector<FixedPlace>& all, double limit, double apart) {
  constexpr std::size_t kPaired = 30;
  constexpr std::size_t kJudged = 300;
  const std::vector<FixedPlace> some = thinned(all, kPaired);
  const std::vector<FixedPlace> judges = thinned(all, kJudged);
  Alignment best;
  double least = std::numeric_limits<double>::infinity();
  const auto judge = [&](const Alignment& over) {
    const double cost = truncated_cost(over, judges, limit);
    if (cost >= least) return;
    least = cost;
    best = over;
  };
  for (std::size_t i = 0; i < some.size(); ++i) {
    judge({1.0, 0.0, some[i].there - some[i].here, 0.0});
    for (std::size_t j = i + 1; j < some.size(); ++j) {
      const Vector2 here = some[j].here - some[i].here;
      const Vector2 there = some[j].there - some[i].there;
      if (here.norm() < apart || there.norm() < apart) continue;
      judge(align_rigidly({some[i].here, some[j].here}, {some[i].there, some[j].there}));
    }
  }
  std::vector<Vector2> here;
  std::vector<Vector2> there;
  for (const FixedPlace& one : judges) {
    if ((best.apply(one.here) - one.there).norm() > limit) continue;
    here.push_back(one.here);
    there.push_back(one.there);
  }
  if (best.angle != 0.0 && here.size() >= 2) judge(align_rigidly(here, there));
  return best;
}

bool has_compass(const RecordingProblem& problem) {
  return std::any_of(
      problem.measurements.begin(), problem.measurements.end(),
      [](const Measurement& one) { return one.kind == MeasurementKind::segment && one.rows == 4; });
}

bool has_loops(const RecordingProblem& problem) {
  return std::any_of(problem.measurements.begin(), problem.measurements.end(),
                     [](const Measurement& one) { return one.kind == MeasurementKind::loop; });
}

/// Roughly: what is beyond the gate is held out, or weighs less.
RecordingDescent descend_roughly(RecordingSystem& system, const RecordingProblem& problem,
                                 const StartOptions& options, RecordingDescent fit) {
  constexpr DescentOptions kRough{30, 1e-4, kNegligibleDecrease};
  if (std::isfinite(options.gate) && has_loops(problem)) {
    system.linearise(fit.state, fit.coefficients);
    RobustFit robust{fit.state, fit.coefficients, {}, options.gate};
    robust.weights.reserve(problem.measurements.size());
    for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
      const bool out =
          may_be_wrong(problem.measurements[k].kind) && system.squared_errors()[k] > options.gate;
      robust.weights.push_back(out ? 0.0 : 1.0);
    }
    robust = look_again(system, problem, std::move(robust));
    return descend(system, robust.state, robust.coefficients, kRough);
  }
  if (std::isfinite(options.gate)) {
    heed_majority(problem, fit.state);
    constexpr DescentOptions kRound{5, 1e-4, kNegligibleDecrease};
    return descend_softly(system, problem, std::move(fit), options.gate, 4, kRound);
  }
  return descend(system, fit.state, fit.coefficients, kRough);
}

/// Adjusts the poses laid down so far, the landmarks they see and the coefficients. Returns the
/// share of the sightings that are beyond the gate then.
double adjust_stretch(const RecordingProblem& session, const StartOptions& options, int count,
                      Layer& layer) {
  const ProblemPart part = part_of(session, 0, count, &layer.landmarks());
  if (part.landmarks.empty() && !has_loops(part.problem)) return 0.0;
  RecordingDescent fit;
  for (const int landmark : part.landmarks) {
    fit.state.landmarks.push_back(*layer.landmarks()[idx(landmark)]);
  }
  fit.state.poses.assign(layer.poses().begin(), layer.poses().begin() + count);
  fit.state.orientations = orientations_seen_from(part.problem, fit.state.poses);
  for (std::size_t k = 0; k < part.orientations.size(); ++k) {
    const std::optional<double>& known = layer.orientations()[idx(part.orientations[k])];
    if (known) fit.state.orientations[k] = *known;
  }
  fit.coefficients = layer.coefficients().values;
  RecordingSystem system(part.problem, layer.border());
  system.set_slack(RecordingSystem::kRoughSlack);
  try {
    fit = descend_roughly(system, part.problem, options, fit);
  } catch (
      const NotPositiveDefinite&) {  // rounding leaves no step to take: it stays as it was laid
    return share_beyond(part.problem, system.squared_errors(), options.gate);
  }
  for (std::size_t k = 0; k < part.landmarks.size(); ++k) {
    layer.landmarks()[idx(part.landmarks[k])] = fit.state.landmarks[k];
  }
  for (std::size_t k = 0; k < part.orientations.size(); ++k) {
    layer.orientations()[idx(part.orientations[k])] = fit.state.orientations[k];
  }
  std::copy(fit.state.poses.begin(), fit.state.poses.end(), layer.poses().begin());
  const double lost = share_beyond(part.problem, system.squared_errors(), options.gate);
  if (fit.coefficients.size() == 0) return lost;
  const KnownCoefficients prior = prior_of(layer.border());
  try {
    system.factorise();
  } catch (const NotPositiveDefinite&) {  // rounding has eaten what the stretch says of them
    layer.coefficients() = {fit.coefficients, prior.covariance};
    return lost;
  }
  // A misfit makes them less certain, but never less than they were at first.
  const double dispersion =
      std::max(1.0, fit.chi2 / std::max(1, system.rows() - system.unknowns()));
  Eigen::MatrixXd covariance = dispersion * system.coefficient_covariance();
  for (Eigen::Index k = 0; k < covariance.cols(); ++k) {
    const double ratio = std::sqrt(std::min(1.0, prior.covariance(k, k) / covariance(k, k)));
    covariance.col(k) *= ratio;
    covariance.row(k) *= ratio;
  }
  layer.coefficients() = {fit.coefficients, covariance};
  return lost;
}

constexpr double kFarOff = 5.0;       // sds of a fix
constexpr double kDriftShare = 0.05;  // of a stretch: what dead reckoning may be off

/// A session's fixes, by pose.
struct SessionFixes {
  std::vector<int> poses;  ///< ascending
  std::vector<Vector2> places;
  double sd = 0.0;  ///< m, the median
};

SessionFixes fixes_of(const RecordingProblem& session) {
  SessionFixes result;
  std::map<int, const Measurement*> fixes;
  std::vector<double> sds;
  for (const Measurement& one : session.measurements) {
    if (one.kind != MeasurementKind::fix) continue;
    fixes[one.from - session.landmark_count()] = &one;
    sds.push_back(1.0 / one.whitener(0, 0));
  }
  result.poses.reserve(fixes.size());
  result.places.reserve(fixes.size());
  for (const auto& [pose, one] : fixes) {
    result.poses.push_back(pose);
    result.places.emplace_back(one->value.head<2>());
  }
  if (sds.empty()) return result;
  std::nth_element(sds.begin(), sds.begin() + std::ssize(sds) / 2, sds.end());
  result.sd = sds[sds.size() / 2];
  return result;
}

/// Where the poses before `end` are to go, by the fixes; `span` (m) is how far they reach.
Alignment onto_fixes(const SessionFixes& fixes, const std::vector<Pose>& poses, int end,
                     double span) {
  std::vector<FixedPlace> places;
  for (std::size_t k = 0; k < fixes.poses.size() && fixes.poses[k] < end; ++k) {
    places.push_back({poses[idx(fixes.poses[k])].position(), fixes.places[k]});
  }
  const double limit = std::max(kFarOff * fixes.sd, kDriftShare * span);
  return align_to_most(places, limit, kFarOff * fixes.sd);
}

Pose moved_by(const Alignment& over, const Pose& pose) {
  const Vector2 place = over.apply(pose.position());
  return {place.x(), place.y(), pose.heading + over.angle};
}

/// From where its first stretch suits the fixes on, corrected by them. That stretch is as long as
/// tells the heading.
void lay_along_fixes(const SessionFixes& fixes, bool compass, Layer& layer) {
  constexpr double kTellsHeading = 20.0;  // sds of a fix
  constexpr double kShortest = 2.0;       // m
  constexpr std::size_t kFewest = 8;      // fixes
  constexpr double kHeadingSd = 0.3;      // rad
  const int poses = layer.pose_count();
  const Layer::Laid before = layer.laid();
  const Matrix3 unknown_heading = Eigen::Vector3d(0.0, 0.0, compass ? 10.0 : 0.0).asDiagonal();
  layer.lay(0, poses - 1, layer.first_pose(), unknown_heading, false);
  const double wanted = std::max(kTellsHeading * fixes.sd, kShortest);
  const Vector2 begin = layer.poses()[idx(fixes.poses.front())].position();
  double span = 0.0;
  std::size_t count = 0;
  while (count < fixes.poses.size() && (span < wanted || count < kFewest)) {
    span = std::max(span, (layer.poses()[idx(fixes.poses[count])].position() - begin).norm());
    ++count;
  }
  const Alignment over = onto_fixes(fixes, layer.poses(), fixes.poses[count - 1] + 1, span);
  const double sd = std::max(fixes.sd, kDriftShare * span);
  const Pose start = moved_by(over, layer.poses().front());
  layer.take_back(before);
  const Matrix3 covariance =
      Eigen::Vector3d(sd * sd, sd * sd, kHeadingSd * kHeadingSd).asDiagonal();
  layer.lay(0, poses - 1, start, covariance, true);
  layer.place_from_afar(poses, true);
}

void move_all(const Alignment& over, Layer& layer) {
  for (std::optional<Vector2>& landmark : layer.landmarks()) {
    if (landmark) landmark = over.apply(*landmark);
  }
  for (std::optional<double>& orientation : layer.orientations()) {
    if (orientation) orientation = wrap_angle(*orientation + over.angle);
  }
  for (Pose& pose : layer.poses()) pose = moved_by(over, pose);
}

/// All of a session that lies in a frame of its own.
void lay_onto_fixes(const SessionFixes& fixes, Layer& layer) {
  double span = 0.0;
  for (const Pose& pose : layer.poses()) {
    span = std::max(span, (pose.position() - layer.poses().front().position()).norm());
  }
  move_all(onto_fixes(fixes, layer.poses(), layer.pose_count(), span), layer);
}

/// One session in a frame of its own (with truth rows: theirs).
void lay_freely(const RecordingProblem& session, const StartOptions& options, Layer& layer) {
  constexpr int kShortestStretch = 7;
  constexpr double kLost = 0.12;  // share of the sightings: the robot took a wrong turn
  const int poses = layer.pose_count();
  for (int k = 0; k < poses; ++k) {
    if (const Measurement* truth = layer.truth_at(k)) {
      const Pose pose{truth->value[0], truth->value[1], truth->value[2]};
      layer.lay(k, poses - 1, pose, covariance_of(*truth), true);
      layer.lay_backwards(k);
      layer.place_from_afar(poses, true);
      return;
    }
  }
  const Matrix3 unknown_heading =
      Eigen::Vector3d(0.0, 0.0, has_compass(session) ? 10.0 : 0.0).asDiagonal();
  const Matrix3 adjusted = Eigen::Vector3d(1e-2, 1e-2, 1e-3).asDiagonal();
  int laid = std::min(poses, options.first_stretch);
  layer.lay(0, laid - 1, layer.first_pose(), unknown_heading, true);
  layer.place_from_afar(laid, laid == poses);
  if (laid < poses) adjust_stretch(session, options, laid, layer);
  int longest = poses;
  while (laid < poses) {
    const Layer::Laid before = options.careful ? layer.laid() : Layer::Laid();
    const int stretch = std::min(longest, std::max(2 * options.first_stretch / 3, laid / 3));
    const int next = std::min(poses, laid + stretch);
    layer.lay(laid - 1, next - 1, layer.poses()[idx(laid - 1)], adjusted, true);
    layer.place_from_afar(next, next == poses);
    if (next == poses && !options.careful) return;
    const double lost = adjust_stretch(session, options, next, layer);
    if (options.careful && lost > kLost && stretch > kShortestStretch) {
      layer.take_back(before);
      longest = std::max(kShortestStretch, stretch / 3);
    } else {
      laid = next;
      longest = std::min(poses, 2 * longest);
    }
  }
}

/// One session; whether it lies in the map's frame then, by truth or fixes.
bool lay_session(const RecordingProblem& session, const StartOptions& options, Layer& layer) {
  std::ptrdiff_t sightings = 0;
  bool truth = false;
  for (const Measurement& one : session.measurements) {
    if (locates(one)) ++sightings;
    truth = truth || one.kind == MeasurementKind::truth;
  }
  const SessionFixes fixes = fixes_of(session);
  if (!truth && !fixes.poses.empty() && std::ssize(fixes.poses) >= sightings) {
    lay_along_fixes(fixes, has_compass(session), layer);
    return true;
  }
  lay_freely(session, options, layer);
  if (!truth && !fixes.poses.empty()) lay_onto_fixes(fixes, layer);
  return truth || !fixes.poses.empty();
}

Vector2 median_place(const std::vector<Vector2>& places) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Vector2& at : places) {
    x.push_back(at.x());
    y.push_back(at.y());
  }
  return {median(x), median(y)};
}

/// Landmarks that lie here, of those that lie there, ten times as far apart as any there: bearings
/// alone may put one anywhere, and it would take the rest with it.
void leave_out_strays(std::vector<Vector2>& here, std::vector<Vector2>& there) {
  constexpr double kStray = 10.0;
  const Vector2 middle = median_place(here);
  const Vector2 middle_there = median_place(there);
  double reach = 0.0;
  for (const Vector2& at : there) reach = std::max(reach, (at - middle_there).norm());
  std::size_t kept = 0;
  for (std::size_t k = 0; k < here.size(); ++k) {
    if ((here[k] - middle).norm() > kStray * reach) continue;
    here[kept] = here[k];
    there[kept++] = there[k];
  }
  if (kept == 0) return;
  here.resize(kept);
  there.resize(kept);
}

/// rad, what turns a session's orientations into those known; nothing where it has none of them.
std::optional<double> turn_onto(const KnownOrientations& known, Layer& layer) {
  Vector2 sum = Vector2::Zero();
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (!known[k] || !layer.orientations()[k]) continue;
    sum += rotation(*known[k] - *layer.orientations()[k]).col(0);
  }
  if (sum.norm() <= 0.0) return std::nullopt;
  return direction(sum);
}

/// Lays a session over landmarks that have their place, and over orientations that are known.
void lay_over(const PlacedLandmarks& known, const KnownOrientations& orientations, bool turn,
              Layer& layer) {
  constexpr std::size_t kTellsTurn = 3;  // landmarks
  std::vector<Vector2> here;
  std::vector<Vector2> there;
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (!known[k] || !layer.landmarks()[k]) continue;
    here.push_back(*layer.landmarks()[k]);
    there.push_back(*known[k]);
  }
  if (here.empty()) return;
  leave_out_strays(here, there);
  Alignment over;
  std::optional<double> angle;
  if (turn && here.size() < kTellsTurn) angle = turn_onto(orientations, layer);
  if (turn && !angle && here.size() >= 2) {
    over = align_rigidly(here, there);
  } else {
    over.angle = angle.value_or(0.0);
    const Matrix2 R = rotation(over.angle);
    for (std::size_t k = 0; k < here.size(); ++k) {
      over.translation += (there[k] - R * here[k]) / static_cast<double>(here.size());
    }
  }
  move_all(over, layer);
}

/// First and count of each session's poses.
std::vector<std::pair<int, int>> session_spans(const RecordingProblem& problem) {
  std::vector<std::pair<int, int>> spans(problem.sessions.size(), {0, 0});
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    auto& [first, count] = spans[idx(problem.poses[k].session)];
    if (count++ == 0) first = static_cast<int>(k);
  }
  return spans;
}

/// part_of keeps neither truth nor fixes; a session's start needs them.
ProblemPart session_of(const RecordingProblem& problem, int first, int count) {
  ProblemPart part = part_of(problem, first, count);
  for (const Measurement& one : problem.measurements) {
    const int pose = one.from - problem.landmark_count() - first;
    const bool place = one.kind == MeasurementKind::truth || one.kind == MeasurementKind::fix;
    if (!place || pose < 0 || pose >= count) continue;
    part.problem.measurements.push_back(one);
    part.problem.measurements.back().from = part.problem.pose_node(pose);
  }
  // The compass tells headings, and may be off by more than yaws are.
  if (has_compass(part.problem)) {
    std::erase_if(part.problem.measurements,
                  [](const Measurement& one) { return is_of_orientation(one.kind); });
    part.problem.oriented.clear();
    part.orientations.clear();
  }
  return part;
}

KnownOrientations surveyed_orientations(const RecordingProblem& problem) {
  KnownOrientations known(problem.oriented.size());
  for (const Measurement& one : problem.measurements) {
    if (one.kind != MeasurementKind::survey_heading) continue;
    known[idx(one.from - problem.pose_end())] = one.value[0];
  }
  return known;
}

PlacedLandmarks surveyed(const RecordingProblem& problem) {
  PlacedLandmarks known(problem.landmarks.size());
  for (const Measurement& one : problem.measurements) {
    if (one.kind == MeasurementKind::survey) known[idx(one.from)] = one.value.head<2>();
  }
  return known;
}

/// Orientations not yet known, as a session's poses first read them: with a compass, too.
void take_orientations(const RecordingProblem& problem, const std::vector<Pose>& poses, int first,
                       int count, KnownOrientations& known) {
  if (known.empty()) return;
  for (const Measurement& one : problem.measurements) {
    if (one.kind != MeasurementKind::sighting_yaw) continue;
    const int pose = one.from - problem.landmark_count();
    if (pose < first || pose >= first + count) continue;
    std::optional<double>& orientation = known[idx(one.to - problem.pose_end())];
    if (!orientation) orientation = wrap_angle(poses[idx(pose)].heading + one.value[0]);
  }
}

}  // namespace

std::vector<double> orientations_seen_from(const RecordingProblem& problem,
                                           const std::vector<Pose>& poses) {
  std::vector<Vector2> sums(problem.oriented.size(), Vector2::Zero());
  for (const Measurement& one : problem.measurements) {
    if (one.kind != MeasurementKind::sighting_yaw) continue;
    const Pose& pose = poses[idx(one.from - problem.landmark_count())];
    sums[idx(one.to - problem.pose_end())] += rotation(pose.heading + one.value[0]).col(0);
  }
  std::vector<double> result;
  result.reserve(sums.size());
  for (const Vector2& sum : sums) result.push_back(direction(sum));
  for (const Measurement& one : problem.measurements) {
    if (one.kind != MeasurementKind::survey_heading) continue;
    result[idx(one.from - problem.pose_end())] = one.value[0];
  }
  return result;
}

ProblemPart part_of(const RecordingProblem& problem, int first, int count,
                    const PlacedLandmarks* placed) {
  ProblemPart part;
  part.first_pose = first;
  std::vector<int> place(problem.landmarks.size(), -1);
  const int offset = problem.landmark_count() + first;
  const auto inside = [&](int node) { return node >= offset && node < offset + count; };
  std::vector<int> orientation(problem.oriented.size(), -1);
  std::vector<const Measurement*> kept;
  const auto keep_yaw = [&](const Measurement& one) {
    const int whole = one.to - problem.pose_end();
    const int landmark = place[idx(problem.oriented[idx(whole)])];
    if (landmark < 0) return;  // its sighting, just before, is not kept
    kept.push_back(&one);
    if (orientation[idx(whole)] >= 0) return;
    orientation[idx(whole)] = static_cast<int>(part.orientations.size());
    part.orientations.push_back(whole);
    part.problem.oriented.push_back(landmark);
  };
  for (const Measurement& one : problem.measurements) {
    if (in_map_frame(one) || one.kind == MeasurementKind::survey_heading) continue;
    if (!inside(one.from) || (between_poses(one) && !inside(one.to))) continue;
    // What a segment's gyro says goes with it.
    if (one.kind == MeasurementKind::gyro && !inside(one.from + 1)) continue;
    if (placed != nullptr && is_sighting(one.kind) && !(*placed)[idx(one.to)]) continue;
    if (one.kind == MeasurementKind::sighting_yaw) {
      keep_yaw(one);
      continue;
    }
    kept.push_back(&one);
    if (!is_sighting(one.kind) || place[idx(one.to)] >= 0) continue;
    place[idx(one.to)] = static_cast<int>(part.landmarks.size());
    part.landmarks.push_back(one.to);
    part.problem.landmarks.push_back(problem.landmarks[idx(one.to)]);
  }
  part.problem.sessions = problem.sessions;
  part.problem.poses.assign(problem.poses.begin() + first, problem.poses.begin() + first + count);
  for (const Measurement* one : kept) {
    Measurement moved = *one;
    moved.from = part.problem.pose_node(one->from - offset);
    if (one->kind == MeasurementKind::loop) {
      moved.to = part.problem.pose_node(one->to - offset);
    } else if (one->kind == MeasurementKind::segment) {
      moved.to = part.problem.pose_node(one->to - offset);
      moved.source = part.problem.segments.size();
      part.problem.segments.push_back(problem.segments[one->source]);
      part.problem.gyro_weights.push_back(problem.gyro_weights[one->source]);
    } else if (one->kind == MeasurementKind::gyro) {
      moved.source = part.problem.segments.size() - 1;  // right after its segment
    } else if (one->kind == MeasurementKind::sighting_yaw) {
      moved.to = part.problem.pose_end() + orientation[idx(one->to - problem.pose_end())];
    } else {
      moved.to = place[idx(one->to)];
    }
    part.problem.measurements.push_back(moved);
  }
  return part;
}

RecordingStart start_of(const RecordingProblem& problem, const EffectParameters& border,
                        const StartOptions& options) {
  PlacedLandmarks known = surveyed(problem);
  KnownOrientations orientations = surveyed_orientations(problem);
  const bool frame_given =
      std::any_of(problem.measurements.begin(), problem.measurements.end(), in_map_frame);
  RecordingState state;
  state.poses.resize(problem.poses.size());
  KnownCoefficients coefficients = prior_of(border);
  for (const auto& [first, count] : session_spans(problem)) {
    if (count == 0) continue;
    const ProblemPart part = session_of(problem, first, count);
    Layer layer(part.problem, border, options);
    layer.coefficients() = coefficients;
    const bool in_map = lay_session(part.problem, options, layer);
    coefficients = layer.coefficients();
    PlacedLandmarks in_part;
    for (const int landmark : part.landmarks) in_part.push_back(known[idx(landmark)]);
    KnownOrientations known_in_part;
    for (const int k : part.orientations) known_in_part.push_back(orientations[idx(k)]);
    if (!in_map) lay_over(in_part, known_in_part, !has_compass(part.problem), layer);
    for (std::size_t k = 0; k < part.landmarks.size(); ++k) {
      std::optional<Vector2>& place = known[idx(part.landmarks[k])];
      if (!place) place = layer.landmarks()[k];
    }
    std::copy(layer.poses().begin(), layer.poses().end(), state.poses.begin() + first);
    take_orientations(problem, state.poses, first, count, orientations);
  }
  for (const std::optional<Vector2>& landmark : known) {
    state.landmarks.push_back(landmark.value_or(Vector2::Zero()));
  }
  if (!frame_given && !state.landmarks.empty()) {
    const Vector2 origin = state.landmarks.front();
    for (Vector2& landmark : state.landmarks) landmark -= origin;
    for (Pose& pose : state.poses) {
      pose.x -= origin.x();
      pose.y -= origin.y();
    }
  }
  state.orientations = orientations_seen_from(problem, state.poses);
  return {std::move(state), std::move(coefficients.values)};
}

RecordingState dead_reckoned(const RecordingProblem& problem) {
  RecordingState state;
  state.poses.resize(problem.poses.size());
  std::vector<Vector2> sums(problem.landmarks.size(), Vector2::Zero());
  std::vector<double> counts(problem.landmarks.size(), 0.0);
  for (const auto& [first, count] : session_spans(problem)) {
    if (count == 0) continue;
    const ProblemPart part = part_of(problem, first, count);
    const EffectParameters no_effects;
    Layer layer(part.problem, no_effects, {});
    const Matrix3 start =
        Eigen::Vector3d(0.0, 0.0, has_compass(part.problem) ? 10.0 : 0.0).asDiagonal();
    layer.lay(0, count - 1, layer.first_pose(), start, false);
    for (int k = 0; k < count; ++k) {
      const Pose& pose = layer.poses()[idx(k)];
      state.poses[idx(first + k)] = pose;
      for (const Measurement* one : layer.seen_at(k)) {
        if (!locates(*one)) continue;
        const std::size_t landmark = idx(part.landmarks[idx(one->to)]);
        sums[landmark] += pose.position() + rotation(pose.heading) * offset_of(*one);
        counts[landmark] += 1.0;
      }
    }
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    state.landmarks.emplace_back(sums[k] / std::max(counts[k], 1.0));
  }
  state.orientations = orientations_seen_from(problem, state.poses);
  return state;
}

}  // namespace trussmap
