// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/single_events.hpp"

#include "validation/leg_spans.hpp"

#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostSteps = 16;  // tried for one landmark in one session
constexpr std::size_t kBumps = 5;       // places tried in a drive; on the spot only the 3 numbers
constexpr double kLeastPath = 0.1;      // m

class Collector {
 public:
  Collector(const fitting::FitState& fit, const ScoreTest& tests,
            const fitting::FitProjection& projection)
      : fit_(fit), problem_(fit.problem), tests_(tests), projection_(projection) {}

  std::vector<SingleEvent> run() {
    add_sessions();
    add_landmarks();
    add_surveys();
    add_sightings();
    add_legs();
    return std::move(events_);
  }

 private:
  [[nodiscard]] const estimation::Measurement& at(std::size_t k) const {
    return problem_.measurements[k];
  }

  [[nodiscard]] std::string of_session(int session) const {
    return problem_.sessions.size() > 1 ? " of " + problem_.sessions[idx(session)] : std::string();
  }

  /// The measured values change by the columns of `change`.
  [[nodiscard]] DummyRows changed(std::size_t k, const Eigen::MatrixXd& change) const {
    const int rows = at(k).rows;
    return {k, -at(k).whitener.topLeftCorner(rows, rows) * change};
  }

  /// A leg's bump, in each of its segments.
  void add_legs() {
    std::map<int, std::size_t> segment_from;
    for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
      if (estimation::is_segment(at(k))) segment_from[at(k).from] = k;
    }
    for (const validation::LegSpan& leg : validation::leg_spans(fit_)) {
      const estimation::Measurement& from = at(leg.from);
      const estimation::Measurement& to = at(leg.to);
      const bool sighted = from.to >= 0 && to.to >= 0;
      const std::string between =
          sighted ? problem_.landmarks[idx(from.to)] + " -> " + problem_.landmarks[idx(to.to)]
                  : "drive";
      SingleEvent event{EventKind::leg,
                        fmt::format("{} {} t = {:.1f} s{}", between, sighted ? "at" : "to",
                                    leg.time.to, of_session(leg.session)),
                        {}};
      for (int node = from.from; node != to.from;) {
        const auto found = segment_from.find(node);
        if (found == segment_from.end()) break;
        const estimation::Measurement& segment = at(found->second);
        node = segment.to;
        if (projection_.left_out(found->second)) continue;
        add_bumps(found->second, event.places);
      }
      if (!event.places.empty()) events_.push_back(std::move(event));
    }
  }

  /// Motion beyond the record after some of a segment's rows: of one wheel, or any.
  void add_bumps(std::size_t k, std::vector<Dummies>& places) const {
    const estimation::Measurement& segment = at(k);
    const std::vector<estimation::SegmentRow>& rows = problem_.segments[segment.source];
    std::vector<Pose> ends;
    std::vector<int> readings;
    Pose end;
    int count = 0;
    for (const estimation::SegmentRow& row : rows) {
      const double half = 0.5 * row.turn;
      end = compose(end, {row.path * std::cos(half), row.path * std::sin(half), row.turn});
      ends.push_back(end);
      readings.push_back(count);
      count += std::isnan(row.reading) ? 0 : 1;
    }
    const double by_turn = 1.0 / fit_.model.robot.wheelbase;  // rad per m of a wheel
    const auto by_motion = [&](std::size_t row) {
      Eigen::MatrixXd change = Eigen::MatrixXd::Zero(segment.rows, 3);
      change.topLeftCorner<2, 2>() = rotation(ends[row].heading);
      change.block<2, 1>(0, 2) = quarter_turn(end.position() - ends[row].position());
      change(2, 2) = 1.0;
      if (segment.rows == 4) change(3, 2) = -static_cast<double>(count - readings[row]) / count;
      return change;
    };
    double path = 0.0;
    for (const estimation::SegmentRow& row : rows) path += std::abs(row.path);
    const bool drives = path > kLeastPath && fit_.model.robot.drive == DriveKind::differential;
    const int group = 2 * static_cast<int>(places.size());
    for (std::size_t part = 0; drives && part < kBumps; ++part) {
      const Eigen::MatrixXd change = by_motion((2 * part + 1) * rows.size() / (2 * kBumps));
      places.push_back({{changed(k, change * Eigen::Vector3d(0.5, 0.0, -by_turn))},
                        {},
                        group,
                        EventChange::left_wheel});
      places.push_back({{changed(k, change * Eigen::Vector3d(0.5, 0.0, by_turn))},
                        {},
                        group,
                        EventChange::right_wheel});
    }
    places.push_back(
        {{changed(k, by_motion(rows.size() / 2))}, {}, group + 1, EventChange::motion});
  }

  void add_sightings() {
    for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
      const estimation::Measurement& one = at(k);
      if (projection_.left_out(k) || one.to < 0 || !problem_.is_landmark(one.to)) continue;
      const std::string_view last = one.kind->noise(one.rows - 1);
      const EventChange change = one.rows == 1 && last == "range" ? EventChange::range_off
                                 : last != "bearing"              ? EventChange::position_off
                                 : one.rows > 1                   ? EventChange::view_off
                                                                  : EventChange::bearing_off;
      events_.push_back(
          {EventKind::sighting,
           estimation::describe(problem_, one),
           {{{changed(k, Eigen::MatrixXd::Identity(one.rows, one.rows))}, {}, 0, change}}});
    }
  }

  void add_surveys() {
    for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
      const estimation::Measurement& one = at(k);
      if (!estimation::is_surveyed_place(one) || projection_.left_out(k)) continue;
      events_.push_back(
          {EventKind::landmark,
           problem_.landmarks[idx(one.from)],
           {{{changed(k, Eigen::MatrixXd::Identity(2, 2))}, {}, 0, EventChange::survey_off}}});
    }
  }

  struct Visit {
    int session = 0;
    int pose = -1;
    std::vector<std::size_t> sightings;
  };

  /// The landmark's place from this visit on, and back where `until` begins.
  [[nodiscard]] Dummies step(const std::vector<Visit>& visits, std::size_t from) const {
    Dummies result;
    result.change = EventChange::moved;
    for (std::size_t v = from; v < visits.size(); ++v) {
      for (const std::size_t k : visits[v].sightings) {
        result.parts.push_back({k, projection_.rows_by_landmark(k)});
      }
    }
    return result;
  }

  void add_landmarks() {
    std::vector<std::vector<Visit>> visits(problem_.landmarks.size());
    std::set<int> surveyed;
    for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
      const estimation::Measurement& one = at(k);
      if (projection_.left_out(k)) continue;
      if (estimation::is_surveyed_place(one)) surveyed.insert(one.from);
      if (one.to < 0 || !problem_.is_landmark(one.to)) continue;
      std::vector<Visit>& of = visits[idx(one.to)];
      if (of.empty() || of.back().pose != one.from) of.push_back({one.session, one.from, {}});
      of.back().sightings.push_back(k);
    }
    for (std::size_t landmark = 0; landmark < visits.size(); ++landmark) {
      add_steps(problem_.landmarks[landmark], visits[landmark],
                surveyed.contains(static_cast<int>(landmark)));
    }
  }

  void add_steps(const std::string& name, const std::vector<Visit>& visits, bool surveyed) {
    for (std::size_t v = 1; v < visits.size(); ++v) {
      if (visits[v].session == visits[v - 1].session) continue;
      Dummies moved = step(visits, v);
      moved.when.session = problem_.sessions[idx(visits[v - 1].session)];
      moved.when.next_session = problem_.sessions[idx(visits[v].session)];
      events_.push_back({EventKind::landmark, name, {std::move(moved)}});
    }
    for (std::size_t begin = 0; begin < visits.size();) {
      std::size_t end = begin;
      while (end < visits.size() && visits[end].session == visits[begin].session) ++end;
      // A step that leaves a single visit on one side is that visit's wrong sighting.
      std::vector<std::size_t> steps;
      for (std::size_t v = begin + 1; v < end; ++v) {
        if (v >= (surveyed ? 1U : 2U) && visits.size() - v >= 2) steps.push_back(v);
      }
      std::vector<Dummies> places;
      const std::size_t count = std::min(steps.size(), kMostSteps);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t v = steps[(2 * k + 1) * steps.size() / (2 * count)];
        places.push_back(step(visits, v));
        MovedWhen& when = places.back().when;
        when.before_t = problem_.time_of(visits[v].pose);
        if (problem_.sessions.size() > 1) {
          when.session = problem_.sessions[idx(visits[begin].session)];
        }
      }
      if (count > 0) events_.push_back({EventKind::landmark, name, std::move(places)});
      begin = end;
    }
  }

  void add_sessions() {
    const auto count = static_cast<int>(problem_.sessions.size());
    for (int session = 0; count > 1 && session < count; ++session) {
      std::vector<Channel> channels{Channel::travel, Channel::turn};
      if (fit_.recordings[idx(session)].drive.has_compass()) channels.push_back(Channel::compass);
      channels.push_back(Channel::delay);
      Eigen::MatrixXd M(tests_.residuals().size(), static_cast<Eigen::Index>(channels.size()));
      Eigen::VectorXd prior_sd(static_cast<Eigen::Index>(channels.size()));
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto column = static_cast<Eigen::Index>(c);
        Effect effect;
        effect.name = name_of(channels[c]);
        effect.channel = channels[c];
        effect.shape = {"1"};
        M.col(column) = tests_.columns(effect);
        prior_sd[column] = facts_of(channels[c]).prior_sd;
      }
      Dummies dummies{{}, prior_sd, 0, EventChange::session_off};
      for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
        if (at(k).session != session || projection_.left_out(k)) continue;
        dummies.parts.push_back({k, M.middleRows(tests_.system().first_row(k), at(k).rows)});
      }
      events_.push_back(
          {EventKind::session, problem_.sessions[idx(session)], {std::move(dummies)}});
    }
  }

  const fitting::FitState& fit_;
  const estimation::RecordingProblem& problem_;
  const ScoreTest& tests_;
  const fitting::FitProjection& projection_;
  std::vector<SingleEvent> events_;
};

}  // namespace

std::vector<SingleEvent> single_events(const fitting::FitState& fit, const ScoreTest& tests,
                                       const fitting::FitProjection& projection) {
  return Collector(fit, tests, projection).run();
}

}  // namespace trussmap::criticism
