// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/instruments.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace trussmap {
using namespace planning;

namespace {

constexpr double kTape = 0.002;      // m
constexpr double kSurveyedBy = 2.0;  // survey's sds: landmarks known as well are surveyed
constexpr std::array kInstruments = {Instrument::compass,      Instrument::gyro,
                                     Instrument::range_sensor, Instrument::distance,
                                     Instrument::survey,       Instrument::truth};

/// A tape between the plan's first two landmarks.
void measure_distance(const DrivePlan& plan, DriveInformation& known) {
  const Waypoint& from = plan.waypoints[0];
  const Waypoint& to = plan.waypoints[1];
  const Eigen::Index a = known.column_of(from.landmark);
  const Eigen::Index b = known.column_of(to.landmark);
  if (a < 0 || b < 0) return;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(known.H.cols());
  const Vector2 along = (to.place - from.place).normalized() / kTape;
  row.segment<2>(a) = -along;
  row.segment<2>(b) = along;
  known.H += row * row.transpose();
}

void survey_all(double sd, DriveInformation& known) {
  known.H.diagonal().head(known.first_column()).array() += 1.0 / (sd * sd);
}

/// Whether a landmark is known as well as by a survey.
bool is_surveyed(const DriveInformation& known, double sd) {
  if (known.landmarks.empty()) return false;
  std::vector<Eigen::Index> gone;
  for (Eigen::Index k = 2; k < known.H.cols(); ++k) gone.push_back(k);
  const double information = without(known.H, gone).trace() / 2.0;
  return information * std::pow(kSurveyedBy * sd, 2) > 1.0;
}

/// The task with the instrument; whether it is there already.
bool add_instrument(Instrument instrument, const DrivePlan& plan, PlanWorld& world,
                    SearchTask& task) {
  const auto add_offset = [&task](const char* name, Channel channel) {
    task.own.push_back({name, channel, {"1"}, {}});
  };
  switch (instrument) {
    case Instrument::compass:
      if (world.robot.compass) return true;
      world.robot.compass = true;
      add_offset("compass offset", Channel::compass);
      return false;
    case Instrument::gyro:
      if (world.robot.gyro) return true;
      world.robot.gyro = true;
      add_offset("gyro bias", Channel::gyro);
      return false;
    case Instrument::range_sensor:
      if (world.robot.range_sensor) return true;
      world.robot.range_sensor = true;
      return false;
    case Instrument::distance:
      measure_distance(plan, task.known);
      return false;
    case Instrument::survey: {
      const double sd = world.model.noise.survey;
      if (is_surveyed(task.known, sd)) return true;
      survey_all(sd, task.known);
      return false;
    }
    case Instrument::truth:
      if (world.truth) return true;
      world.truth = true;
      return false;
  }
  return false;
}

double least_share(const SearchTask& task, const std::vector<double>& lambdas,
                   const std::vector<bool>& beyond) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < lambdas.size(); ++k) {
    if (!beyond[k]) least = std::min(least, lambdas[k] / task.questions[k].wanted);
  }
  return least;
}

}  // namespace

std::string_view name_of(Instrument instrument) {
  switch (instrument) {
    case Instrument::compass:
      return "compass";
    case Instrument::gyro:
      return "gyro";
    case Instrument::range_sensor:
      return "range sensor";
    case Instrument::distance:
      return "one measured distance";
    case Instrument::survey:
      return "survey";
    case Instrument::truth:
      break;
  }
  return "truth";
}

}  // namespace trussmap

namespace trussmap::planning {

std::vector<InstrumentWorth> worth_of_instruments(const SearchTask& task, const DrivePlan& plan,
                                                  const std::vector<bool>& beyond) {
  const double usual =
      least_share(task, lambdas_of(task, gram_with(task, task.world, plan)), beyond);
  std::vector<InstrumentWorth> all;
  for (const Instrument instrument : kInstruments) {
    InstrumentWorth one;
    one.instrument = instrument;
    PlanWorld world = task.world;
    SearchTask with = task;
    one.there = add_instrument(instrument, plan, world, with);
    if (!one.there) {
      const std::vector<double> lambdas = lambdas_of(with, gram_with(with, world, plan));
      if (std::isfinite(usual) && usual > 0.0) {
        one.factor = least_share(task, lambdas, beyond) / usual;
      }
      for (std::size_t k = 0; k < lambdas.size(); ++k) {
        one.tells += beyond[k] && lambdas[k] >= task.questions[k].wanted ? 1 : 0;
      }
    }
    all.push_back(one);
  }
  std::stable_sort(all.begin(), all.end(), [](const InstrumentWorth& a, const InstrumentWorth& b) {
    if (a.tells != b.tells) return a.tells > b.tells;
    return a.factor > b.factor;
  });
  return all;
}

}  // namespace trussmap::planning
