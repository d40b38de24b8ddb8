// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Columns of effects against differences of a brute-force reckoning of the rows, by the definitions
// of the channels alone: no closed arcs, no patterns.
#include "fit/effect_columns.hpp"

#include "criticism/inverted_recordings.hpp"
#include "effects/channel_physics.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/recording_system.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::effect_columns_test {
using namespace estimation;
using namespace effects;
using namespace fitting;
namespace {

using testing::invert;
using testing::InvertedRecording;
using testing::kInvertedRow;
using testing::kInvertedWheelbase;
using Point = std::complex<double>;

struct TruePose {
  Point place;
  double heading = 0.0;
};

/// What a shape may speak of here.
struct Here {
  double heading = 0.0;
  double turn_rate = 0.0;
  double payload = 0.0;
};

struct KnownShape {
  std::string text;
  std::function<double(const Here&)> value;
};

std::vector<KnownShape> shapes() {
  return {{"1", [](const Here&) { return 1.0; }},
          {"sin(heading)", [](const Here& here) { return std::sin(here.heading); }},
          {"turn_rate", [](const Here& here) { return here.turn_rate; }},
          {"payload_kg", [](const Here& here) { return here.payload; }}};
}

/// A recording with standing sightings, views at rest and on the way, and truth rows.
class World {
 public:
  World() {
    testing::InvertedOptions options;
    options.rounds = 1;
    options.views = options.on_the_way = true;
    made_ = invert({}, options, 3);
    for (std::size_t row = 7; row < made_.places.size(); row += 23) {
      const Point place = made_.places[row];
      made_.recording.truth.push_back(
          {drive().t[row], place.real(), place.imag(), made_.headings[row]});
    }
    for (std::size_t row = 11; row < made_.places.size(); row += 19) {
      const Point place = made_.places[row];
      made_.recording.fixes.push_back({drive().t[row], place.real() + 0.02, place.imag() - 0.01});
    }
    for (std::size_t row = 13; row + 60 < made_.places.size(); row += 97) {
      made_.recording.loops.push_back({drive().t[row], drive().t[row + 60], 0.3, -0.1, 0.2});
    }
    SessionPath path;
    path.start = pose_of(at_end(-1));
    for (std::size_t row = 0; row < made_.places.size(); ++row) {
      path.ends.push_back(pose_of(at_end(static_cast<int>(row))));
    }
    recordings_ = {made_.recording};
    paths_ = {path};
    problem_ = make_problem(recordings_, model_);
    for (const std::string& name : problem_.landmarks) {
      const Point place = made_.landmarks.at(name);
      state_.landmarks.emplace_back(place.real(), place.imag());
    }
    for (const PoseNode& node : problem_.poses) state_.poses.push_back(pose_of(at(node.t)));
  }

  [[nodiscard]] const RecordingProblem& problem() const { return problem_; }
  [[nodiscard]] const RecordingState& state() const { return state_; }
  [[nodiscard]] ShapeContext context() const { return {recordings_, model_.robot, paths_}; }

  /// At a view or truth row.
  [[nodiscard]] double shape_at(const Measurement& one, const KnownShape& shape) const {
    return one.kind == &kinds::survey ? 0.0 : shape.value(here_at(time_of(one.from)));
  }

  /// Predicted - measured where the coefficient is `a`.
  [[nodiscard]] Vector4 errors(const Measurement& one, Channel channel, const KnownShape& shape,
                               double a) const {
    if (one.kind == &kinds::segment) {
      return segment(time_of(one.from), time_of(one.to), channel, shape, a);
    }
    if (one.kind == &kinds::survey) return Vector4::Zero();
    return view(one, channel, a * shape.value(here_at(time_of(one.from))));
  }

 private:
  [[nodiscard]] const MotionRows& drive() const { return made_.recording.drive; }
  static Pose pose_of(const TruePose& at) { return {at.place.real(), at.place.imag(), at.heading}; }
  [[nodiscard]] double time_of(int node) const {
    return problem_.poses[idx(node - problem_.landmark_count())].t;
  }

  [[nodiscard]] TruePose at_end(int row) const {
    // The robot rests in its first rows.
    if (row < 0) return {made_.places[0], made_.headings[0]};
    return {made_.places[idx(row)], made_.headings[idx(row)]};
  }

  [[nodiscard]] std::size_t row_of(double t) const {
    std::size_t row = 0;
    while (row + 1 < drive().rows() && drive().t[row] < t) ++row;
    return row;
  }

  /// Along a row by Simpson's rule: the heading is linear in it.
  static TruePose driven(TruePose from, double ahead, double left, double turn) {
    constexpr int kSteps = 16;
    Point sum;
    for (int k = 0; k <= kSteps; ++k) {
      const double weight = k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
      sum += weight * std::polar(1.0, from.heading + turn * k / kSteps);
    }
    from.place += Point(ahead, left) * sum / (3.0 * kSteps);
    from.heading += turn;
    return from;
  }

  [[nodiscard]] double ds(std::size_t row) const { return drive().forward[row]; }
  [[nodiscard]] double dtheta(std::size_t row) const { return drive().turn[row]; }

  [[nodiscard]] TruePose at(double t) const {
    if (t <= 0.0) return at_end(-1);
    const std::size_t row = row_of(t);
    const double share = 1.0 - (drive().t[row] - t) / kInvertedRow;
    return driven(at_end(static_cast<int>(row) - 1), share * ds(row), 0.0, share * dtheta(row));
  }

  [[nodiscard]] Here here_at(double t) const {
    const std::size_t row = row_of(t);
    return {at(t).heading, dtheta(row) / kInvertedRow, drive().covariates[0].values[row]};
  }

  [[nodiscard]] Vector4 segment(double from, double to, Channel channel, const KnownShape& shape,
                                double a) const {
    TruePose pose;  // in the frame of the start
    double innovations = 0.0;
    int readings = 0;
    const double start = at(from).heading;
    for (std::size_t row = 0; row < drive().rows(); ++row) {
      const double end = drive().t[row];
      const double begin = end - kInvertedRow;
      const double part = (std::min(end, to) - std::max(begin, from)) / kInvertedRow;
      if (part < 1e-9) continue;
      const double before = at_end(static_cast<int>(row) - 1).heading;
      const Here middle{0.5 * (before + made_.headings[row]), dtheta(row) / kInvertedRow,
                        drive().covariates[0].values[row]};
      const double g = a * shape.value(middle);
      double left = drive().pair.left[row];
      double right = drive().pair.right[row];
      if (channel == Channel::left || channel == Channel::wheels) left *= 1.0 + g;
      if (channel == Channel::right || channel == Channel::wheels) right *= 1.0 + g;
      if (channel == Channel::difference) {
        left *= 1.0 - 0.5 * g;
        right *= 1.0 + 0.5 * g;
      }
      double ahead = 0.5 * (left + right);
      double turn = (right - left) / kInvertedWheelbase;
      double slip = 0.0;
      if (channel == Channel::travel) ahead *= 1.0 + g;
      if (channel == Channel::turn) turn *= 1.0 + g;
      if (channel == Channel::drift) turn += g * kInvertedRow;
      if (channel == Channel::advance) ahead += g;
      if (channel == Channel::rotate) turn += g;
      if (channel == Channel::creep) slip = g * ahead;
      pose = driven(pose, part * ahead, part * slip, part * turn);
      if (to < end - 1e-9) continue;
      const Here reading{made_.headings[row], dtheta(row) / kInvertedRow,
                         drive().covariates[0].values[row]};
      const double offset = channel == Channel::compass ? a * shape.value(reading) : 0.0;
      innovations +=
          std::remainder(drive().heading[row] - offset - pose.heading - start, 2.0 * M_PI);
      ++readings;
    }
    const TruePose first = at(from);
    const TruePose last = at(to);
    const Point chord = (last.place - first.place) * std::polar(1.0, -first.heading);
    return {chord.real() - pose.place.real(), chord.imag() - pose.place.imag(),
            last.heading - first.heading - pose.heading, -innovations / readings};
  }

  [[nodiscard]] Vector4 fix(const Measurement& one, Channel channel, double g) const {
    const TruePose pose = at(time_of(one.from) - (channel == Channel::fix_delay ? g : 0.0));
    const Point lever(channel == Channel::antenna ? g : 0.0,
                      channel == Channel::antenna_left ? g : 0.0);
    const Point off(channel == Channel::fix_x ? g : 0.0, channel == Channel::fix_y ? g : 0.0);
    const Point found = pose.place + lever * std::polar(1.0, pose.heading) + off;
    return {found.real() - one.value[0], found.imag() - one.value[1], 0.0, 0.0};
  }

  [[nodiscard]] Vector4 loop(const Measurement& one, Channel channel, double g) const {
    const TruePose from = at(time_of(one.from));
    const TruePose to = at(time_of(one.to));
    const Point lever(channel == Channel::scanner ? g : 0.0,
                      channel == Channel::scanner_left ? g : 0.0);
    const double yaw = channel == Channel::scanner_yaw ? g : 0.0;
    const Point way = to.place + lever * std::polar(1.0, to.heading) - from.place -
                      lever * std::polar(1.0, from.heading);
    const Point seen = way * std::polar(1.0, -from.heading - yaw);
    return {seen.real() - one.value[0], seen.imag() - one.value[1],
            std::remainder(to.heading - from.heading - one.value[2], 2.0 * M_PI), 0.0};
  }

  [[nodiscard]] Vector4 view(const Measurement& one, Channel channel, double g) const {
    if (one.kind == &kinds::loop) return loop(one, channel, g);
    if (one.kind == &kinds::fix) return fix(one, channel, g);
    if (acts_on_fixes(channel)) g = 0.0;
    const TruePose pose = at(time_of(one.from) - (channel == Channel::delay ? g : 0.0));
    const Point lever(channel == Channel::lever ? g : 0.0,
                      channel == Channel::lever_left ? g : 0.0);
    const Point sensor = pose.place + lever * std::polar(1.0, pose.heading);
    if (one.kind == &kinds::truth) {
      return {sensor.real() - one.value[0], sensor.imag() - one.value[1],
              std::remainder(
                  pose.heading + (channel == Channel::truth_heading ? g : 0.0) - one.value[2],
                  2.0 * M_PI),
              0.0};
    }
    const Vector2& landmark = state_.landmarks[idx(one.to)];
    const Point seen =
        (Point(landmark.x(), landmark.y()) - sensor) * std::polar(1.0, -pose.heading);
    if (one.kind == &kinds::standing) return {seen.real(), seen.imag(), 0.0, 0.0};
    double range = std::abs(seen);
    double bearing = std::arg(seen);
    if (channel == Channel::range) range += g;
    if (channel == Channel::range_scale) range *= 1.0 + g;
    if (channel == Channel::bearing) bearing += g;
    return {range - one.value[0], std::remainder(bearing - one.value[1], 2.0 * M_PI), 0.0, 0.0};
  }

  InvertedRecording made_;
  Model model_ = testing::inverted_model();
  std::vector<DrivenRecording> recordings_;
  std::vector<SessionPath> paths_;
  RecordingProblem problem_;
  RecordingState state_;
};

const World& world() {
  static const World one;
  return one;
}

/// Differences of fourth order. A time shift is taken backwards alone, whatever the shape's sign:
/// where the motion changes, the rates are those before.
Vector4 slope(const Measurement& one, Channel channel, const KnownShape& shape, double at) {
  const double step = shape.text == "payload_kg" ? 5e-6 : 1e-4;
  const auto errors = [&](double steps) {
    return world().errors(one, channel, shape, at + steps * step);
  };
  if (is_delay(channel)) {
    const double back = world().shape_at(one, shape) < 0.0 ? -1.0 : 1.0;
    const Vector4 rise = -25.0 * errors(0.0) + 48.0 * errors(back) - 36.0 * errors(2.0 * back) +
                         16.0 * errors(3.0 * back) - 3.0 * errors(4.0 * back);
    return back / (12.0 * step) * rise;
  }
  return (8.0 * (errors(1.0) - errors(-1.0)) - errors(2.0) + errors(-2.0)) / (12.0 * step);
}

class EachChannel : public ::testing::TestWithParam<Channel> {};

TEST_P(EachChannel, ColumnsAreThoseOfDifferences) {
  const Channel channel = GetParam();
  const ShapeContext context = world().context();
  bool acts_on_segment = false;
  bool acts_on_view = false;
  for (const KnownShape& shape : shapes()) {
    // Shapes grow to 20 (kg) and a delay is exact at its reference alone.
    const double at = is_delay(channel) ? 0.0 : 0.001;
    const EffectParameters border = {effect_column(channel, shape.text, -1, context)};
    RecordingSystem system(world().problem(), border);
    system.linearise(world().state(), Eigen::VectorXd::Constant(1, at));
    double largest = 0.0;
    double worst = 0.0;
    for (std::size_t k = 0; k < world().problem().measurements.size(); ++k) {
      const Measurement& one = world().problem().measurements[k];
      // Unused rows of a whitener are zero: it is made square without them.
      Matrix4 W = one.whitener;
      for (int row = one.rows; row < 4; ++row) W(row, row) = 1.0;
      Vector4 whitened = Vector4::Zero();
      for (int row = 0; row < one.rows; ++row) {
        whitened[row] = system.border()(system.first_row(k) + row, 0);
      }
      const Vector4 found = W.inverse() * whitened;
      const Vector4 expected = slope(one, channel, shape, at);
      worst = std::max(worst, (found - expected).norm());
      largest = std::max(largest, expected.norm());
      if (expected.norm() > 1e-9) {
        (one.kind == &kinds::segment ? acts_on_segment : acts_on_view) = true;
      }
    }
    EXPECT_GT(largest, 1e-3) << shape.text;
    EXPECT_LT(worst, 1e-6 * largest) << shape.text;
  }
  const bool of_views = channel >= Channel::lever && channel != Channel::compass;
  EXPECT_EQ(acts_on_view, of_views);
  EXPECT_EQ(acts_on_segment, !of_views);
}

std::vector<Channel> all_channels() {
  std::vector<Channel> all;
  // This robot has no gyro, two wheels, and landmarks without yaw: gyro_test.cpp,
  // other_drives_test.cpp, landmark_yaw_test.cpp.
  for (const ChannelFacts& one : channels()) {
    if (one.channel != Channel::gyro && one.channel != Channel::gyro_scale &&
        one.channel != Channel::sighting_yaw && is_of_drive(one.channel, Robot())) {
      all.push_back(one.channel);
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(EffectColumns, EachChannel, ::testing::ValuesIn(all_channels()),
                         [](const auto& which) { return std::string(facts_of(which.param).name); });

TEST(EffectColumns, PerSessionActsInThatSessionAlone) {
  const std::vector<DrivenRecording> recordings = {invert({}, {1}, 4).recording,
                                                   invert({}, {1}, 5).recording};
  std::vector<SessionPath> paths(2);
  for (std::size_t s = 0; s < 2; ++s) paths[s].ends.resize(recordings[s].drive.rows());
  const ShapeContext context(recordings, Robot{kInvertedWheelbase}, paths);
  Effect effect;
  effect.name = "own";
  effect.channel = Channel::travel;
  effect.shape = {"1", "speed"};
  effect.coefficients = {0.1, 0.2, 0.3, 0.4};
  effect.per_session = true;
  const EffectColumns columns = effect_columns({effect}, context);
  ASSERT_EQ(columns.border.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(columns.coefficients[k].place, k);
    EXPECT_EQ(columns.coefficients[k].shape, k % 2);
    for (std::size_t s = 0; s < 2; ++s) {
      double sum = 0.0;
      for (const DrivePattern& row : columns.border[k].drives[s]) sum += std::abs(row.advance);
      EXPECT_EQ(sum > 0.0, s == k / 2) << k << " in session " << s;
    }
  }
  // All of one: the two together, and `session` says the same.
  const EffectPattern both = effect_column(Channel::travel, "1", -1, context);
  const EffectPattern second = effect_column(Channel::travel, "session", -1, context);
  for (std::size_t row = 0; row < recordings[1].drive.rows(); ++row) {
    EXPECT_EQ(both.drives[1][row].advance, columns.border[2].drives[1][row].advance);
    EXPECT_EQ(second.drives[1][row].advance, columns.border[2].drives[1][row].advance);
  }
  EXPECT_EQ(second.drives[0].back().advance, 0.0);
}

TEST(EffectColumns, LargestIsThatOfTheShape) {
  const std::vector<DrivenRecording> recordings = {invert({}, {1}, 6).recording};
  std::vector<SessionPath> paths(1);
  paths[0].ends.resize(recordings[0].drive.rows());
  const ShapeContext context(recordings, Robot{kInvertedWheelbase}, paths);
  double heaviest = 0.0;
  for (const double kg : recordings[0].drive.covariates[0].values) {
    heaviest = std::max(heaviest, kg);
  }
  Effect effect;
  effect.name = "own";
  effect.channel = Channel::wheels;
  effect.shape = {"-3*payload_kg"};
  EXPECT_EQ(effect_columns({effect}, context).coefficients[0].largest, 3.0 * heaviest);
}

TEST(EffectColumns, RetimingMovesSightingsAndTruthBack) {
  DrivenRecording recording = invert({}, {1}, 7).recording;
  const double end = recording.drive.t.back();
  recording.truth = {{0.05, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, {end, 0.0, 0.0, 0.0}};
  Effect effect;
  effect.name = "late";
  effect.channel = Channel::delay;
  effect.shape = {"1"};
  effect.coefficients = {0.25};
  const Robot robot{kInvertedWheelbase};
  const DrivenRecording back = retimed({recording}, {effect}, robot)[0];
  ASSERT_EQ(back.truth.size(), 2U);  // the first would lie before the drive
  EXPECT_DOUBLE_EQ(back.truth[0].t, 0.75);
  EXPECT_DOUBLE_EQ(back.truth[1].t, end - 0.25);
  ASSERT_EQ(back.sightings.size() + 1, recording.sightings.size());
  EXPECT_DOUBLE_EQ(back.sightings[0].t, recording.sightings[1].t - 0.25);
  effect.shape = {"payload_kg"};
  effect.coefficients = {0.01};
  const DrivenRecording loaded = retimed({recording}, {effect}, robot)[0];
  EXPECT_EQ(loaded.sightings.size(), recording.sightings.size());  // unloaded at first
}

}  // namespace
}  // namespace trussmap::effect_columns_test
