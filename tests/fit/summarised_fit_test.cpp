// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "driven.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::summarised_fit_test {
namespace {

struct Robot3x3 {
  bool compass = true;
  bool survey = false;
  bool gyro = false;
};

/// Tours of a mesh of 3 x 3, 5 m apart; a wheelbase 2 % larger than believed.
std::vector<DrivenRecording> days_of(const Robot3x3& what, int count, std::uint64_t seed) {
  const Mesh mesh = even_mesh({3, 3}, 5.0);
  WheeledRobot robot;
  robot.compass = what.compass;
  robot.gyro = what.gyro;
  std::vector<DrivenRecording> days;
  for (int day = 0; day < count; ++day) {
    const std::uint64_t own = seed + static_cast<std::uint64_t>(day);
    std::mt19937_64 random = random_stream(own, Stream::walk);
    const Tours tours = make_tours(mesh, WalkKind::euler, 1, random);
    days.push_back(testing::driven(simulate_drive(mesh, tours.walk, {}, robot, own).recording));
    days.back().name = "day " + std::to_string(day + 1);
    if (!what.survey) days.back().survey.clear();
  }
  return days;
}

Model model_of(const std::vector<std::string>& effects) {
  Model model;
  for (const std::string& name : effects) model.effects.push_back(catalogue_effect(name));
  return model;
}

SummarisedFit summarised(const std::vector<DrivenRecording>& days, const Model& model) {
  SummarisedFit fit(model);
  for (const DrivenRecording& day : days) fit.add(day);
  return fit;
}

/// About the first landmark, at the origin of both.
Matrix2 turn_onto(const std::vector<FittedLandmark>& map, const std::vector<FittedLandmark>& from) {
  double along = 0.0;
  double across = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) {
    along += from[k].position.dot(map[k].position);
    across += quarter_turn(from[k].position).dot(map[k].position);
  }
  return rotation(std::atan2(across, along));
}

std::string refusal(SummarisedFit& fit, const DrivenRecording& recording) {
  try {
    fit.add(recording);
  } catch (const SolveError& error) {
    return error.what();
  }
  return "accepted";
}

/// Rows that are laid on another map miss by a share of its uncertainty, not by more.
TEST(SummarisedFit, IsTheFitOfAllDaysAtOnce) {
  for (const Robot3x3& what :
       {Robot3x3{true, true, false}, Robot3x3{true, false, false}, Robot3x3{false, true, false},
        Robot3x3{true, true, true}, Robot3x3{false, false, false}}) {
    SCOPED_TRACE(::testing::Message() << what.compass << what.survey << what.gyro);
    const std::vector<DrivenRecording> days = days_of(what, 4, 11);
    const Model model = model_of(what.survey ? std::vector<std::string>{"wheelbase", "wheel scale"}
                                             : std::vector<std::string>{"wheelbase"});
    SummarisedFit fit = summarised(days, model);
    const ModelFit all = fit_model(days, model);
    EXPECT_LT(fit.exact_error(), 1e-8);
    const std::vector<FittedLandmark> landmarks = fit.landmarks();
    ASSERT_EQ(landmarks.size(), all.landmarks.size());
    const bool free = !what.compass && !what.survey;  // in another frame then
    const Matrix2 turn = free ? turn_onto(landmarks, all.landmarks) : Matrix2::Identity();
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
      EXPECT_EQ(landmarks[k].name, all.landmarks[k].name);
      const double sd = std::sqrt(all.landmarks[k].covariance.trace());
      const Vector2 there = turn * all.landmarks[k].position;
      EXPECT_LE((landmarks[k].position - there).norm(), 0.05 * sd + 1e-9);
      if (!free) {
        EXPECT_NEAR(std::sqrt(landmarks[k].covariance.trace()), sd, 0.02 * sd);
      }
      EXPECT_EQ(landmarks[k].survey.has_value(), what.survey);
    }
    const std::vector<EffectEstimate> effects = fit.effects();
    for (std::size_t k = 0; k < effects.size(); ++k) {
      const double sd = all.effects[k].sd[0];
      EXPECT_NEAR(effects[k].effect.coefficients[0], all.effects[k].effect.coefficients[0],
                  0.05 * sd);
      EXPECT_NEAR(effects[k].sd[0], sd, 0.02 * sd);
    }
    EXPECT_EQ(fit.dof(), all.dof);
    EXPECT_NEAR(fit.chi2(), all.chi2, 0.01 * all.chi2);
    EXPECT_EQ(fit.sessions(), 4);
  }
}

/// A label that is misread is left out on its day, and for good.
TEST(SummarisedFit, LeavesOutWhatContradictsTheMap) {
  std::vector<DrivenRecording> days = days_of({}, 4, 21);
  const Model model;
  const std::vector<DrivenRecording> right = days;
  const auto read = std::ranges::find(days[2].sightings, std::string("L2_2"), &Sighting::landmark);
  ASSERT_NE(read, days[2].sightings.end());
  read->landmark = "L0_0";
  SummarisedFitOptions how;
  how.fit.gate = 16.0;
  SummarisedFit fit(model, how);
  for (const DrivenRecording& day : days) fit.add(day);
  const SummarisedFit clean = summarised(right, model);
  std::map<std::string, Vector2> places;
  for (const FittedLandmark& one : clean.landmarks()) places[one.name] = one.position;
  for (const FittedLandmark& one : fit.landmarks()) {
    EXPECT_LT((one.position - places.at(one.name)).norm(), 0.02);
  }
  EXPECT_LT(fit.dof(), clean.dof());
  ASSERT_FALSE(fit.left_out().empty());
  EXPECT_EQ(fit.left_out().front().rfind("day 3: standing on landmark L0_0 at t = ", 0), 0U)
      << fit.left_out().front();
  EXPECT_TRUE(clean.left_out().empty());
}

TEST(SummarisedFit, EffectsThatAreHeldActAndStay) {
  const std::vector<DrivenRecording> days = days_of({true, true, false}, 3, 31);
  Model model;
  model.effects.push_back(catalogue_effect("wheelbase", {0.01}));
  SummarisedFitOptions how;
  how.fit.fit_effects = false;
  SummarisedFit fit(model, how);
  for (const DrivenRecording& day : days) fit.add(day);
  EXPECT_EQ(fit.model().effects[0].coefficients, std::vector<double>{0.01});
  EXPECT_EQ(fit.effects()[0].sd, std::vector<double>{0.0});
  const ModelFit all = fit_model(days, model, how.fit);
  EXPECT_EQ(fit.dof(), all.dof);
  EXPECT_NEAR(fit.chi2(), all.chi2, 0.01 * all.chi2);
}

TEST(SummarisedFit, RefusesWhatCannotBeSummarised) {
  Model model = model_of({"wheelbase"});
  model.effects[0].per_session = true;
  EXPECT_THROW(SummarisedFit{model}, std::invalid_argument);
  model = model_of({"wheelbase"});
  model.effects[0].shape = {Shape("session")};
  EXPECT_THROW(SummarisedFit{model}, std::invalid_argument);
  model.effects[0].channel = Channel::delay;
  model.effects[0].shape = {Shape("1")};
  EXPECT_THROW(SummarisedFit{model}, std::invalid_argument);
  model = Model{};
  model.noise.processes = {{Channel::bearing, ProcessKind::white, 0.01, 0.0, 4.0}};
  EXPECT_THROW(SummarisedFit{model}, std::invalid_argument);
  for (const double tolerance : {0.0, -1e-8, std::nan("")}) {
    EXPECT_THROW(SummarisedFit(Model{}, {{}, tolerance}), std::invalid_argument);
  }
}

TEST(SummarisedFit, OfNoSessionIsEmpty) {
  SummarisedFit fit(model_of({"wheelbase"}));
  EXPECT_EQ(fit.sessions(), 0);
  EXPECT_TRUE(fit.landmarks().empty());
  EXPECT_EQ(fit.chi2(), 0.0);
  EXPECT_EQ(fit.dof(), 0);
  EXPECT_EQ(fit.exact_error(), 0.0);
  ASSERT_EQ(fit.effects().size(), 1U);
  EXPECT_EQ(fit.effects()[0].effect.name, "wheelbase");
}

TEST(SummarisedFit, ASessionWithoutSightingsOrRowsIsRefused) {
  const std::vector<DrivenRecording> days = days_of({}, 2, 61);
  for (const bool first : {true, false}) {
    SummarisedFit fit{Model{}};
    if (!first) fit.add(days[0]);
    DrivenRecording blind = days[1];
    blind.sightings.clear();
    EXPECT_THROW(fit.add(blind), InputError);
    EXPECT_THROW(fit.add(DrivenRecording{}), std::invalid_argument);
    EXPECT_EQ(fit.sessions(), first ? 0 : 1);
  }
}

/// Rooms that a survey alone ties together.
TEST(SummarisedFit, ASessionElsewhereIsTiedByItsSurvey) {
  std::vector<DrivenRecording> days = days_of({false, true, false}, 2, 71);
  for (Sighting& one : days[1].sightings) one.landmark.insert(0, "B");
  for (SurveyPoint& one : days[1].survey) {
    one.landmark.insert(0, "B");
    const Vector2 there = Vector2(40.0, 0.0) + rotation(2.5) * Vector2(one.x, one.y);
    one.x = there.x();
    one.y = there.y();
  }
  SummarisedFit fit = summarised(days, Model{});
  EXPECT_LT(fit.exact_error(), 1e-8);
  const ModelFit all = fit_model(days, Model{});
  ASSERT_EQ(fit.landmarks().size(), all.landmarks.size());
  for (std::size_t k = 0; k < all.landmarks.size(); ++k) {
    const double sd = std::sqrt(all.landmarks[k].covariance.trace());
    EXPECT_LT((fit.landmarks()[k].position - all.landmarks[k].position).norm(), 0.05 * sd);
  }
  EXPECT_EQ(fit.dof(), all.dof);
}

/// What is held in place of a direction or position would contradict what measures it: what a
/// survey lists and no session has sighted lays no frame.
TEST(SummarisedFit, AFrameThatComesLaterIsRefused) {
  const auto keep = [](DrivenRecording& day, const std::vector<std::string>& names) {
    std::erase_if(day.survey, [&](const SurveyPoint& one) {
      return std::ranges::find(names, one.landmark) == names.end();
    });
  };
  std::vector<DrivenRecording> days = days_of({false, true, false}, 3, 81);
  const auto unsight = [](DrivenRecording& day, const std::string& name) {
    std::erase_if(day.sightings, [&](const Sighting& one) { return one.landmark == name; });
  };
  {  // of two surveyed landmarks one is sighted: a compass, or the other, would turn the map
    DrivenRecording first = days[0];
    keep(first, {"L1_1", "L2_2"});
    unsight(first, "L2_2");
    DrivenRecording same = days[1];
    same.survey = first.survey;
    DrivenRecording compass = days_of({true, false, false}, 1, 82).front();
    SummarisedFit fit{Model{}};
    fit.add(first);
    EXPECT_NE(refusal(fit, same).find("expected such a session first"), std::string::npos);
    EXPECT_NE(refusal(fit, compass).find("expected such a session first"), std::string::npos);
    unsight(same, "L2_2");
    EXPECT_EQ(refusal(fit, same), "accepted");
    EXPECT_LT(fit.exact_error(), 1e-8);
  }
  {  // none is
    DrivenRecording first = days[0];
    keep(first, {"L2_2"});
    unsight(first, "L2_2");
    DrivenRecording sights = days[1];
    sights.survey.clear();
    SummarisedFit fit{Model{}};
    fit.add(first);
    EXPECT_NE(refusal(fit, sights).find("expected such a session first"), std::string::npos);
  }
  {  // a fix a day
    for (DrivenRecording& day : days) {
      day.survey.clear();
      day.fixes = {{day.sightings[3].t, 1.0, 2.0}};
    }
    SummarisedFit fit{Model{}};
    fit.add(days[0]);
    EXPECT_NE(refusal(fit, days[1]).find("expected such a session first"), std::string::npos);
    days[1].fixes.clear();
    EXPECT_EQ(refusal(fit, days[1]), "accepted");
    EXPECT_LT(fit.exact_error(), 1e-8);
  }
}

TEST(SummarisedFit, ASessionThatDoesNotJoinIsRefusedAndTheMapStays) {
  const std::vector<DrivenRecording> days = days_of({false, false, false}, 3, 41);
  SummarisedFit fit{Model{}};
  fit.add(days[0]);
  fit.add(days[1]);
  const double chi2 = fit.chi2();
  DrivenRecording apart = days[2];
  for (Sighting& one : apart.sightings) one.landmark = "other " + one.landmark;
  EXPECT_EQ(refusal(fit, apart), "day 3 stands apart: no landmark ties it to the sessions before");
  const DrivenRecording compass = days_of({true, false, false}, 1, 42).front();
  EXPECT_NE(refusal(fit, compass).find("expected such a session first"), std::string::npos);
  const DrivenRecording surveyed = days_of({false, true, false}, 1, 43).front();
  EXPECT_NE(refusal(fit, surveyed).find("a survey, truth or fixes"), std::string::npos);
  DrivenRecording broken = days[2];
  broken.drive.pair.left[3] = std::nan("");
  EXPECT_THROW(fit.add(broken), std::invalid_argument);
  EXPECT_EQ(fit.sessions(), 2);
  EXPECT_EQ(fit.chi2(), chi2);
  fit.add(days[2]);
  EXPECT_LT(fit.exact_error(), 1e-8);
}

TEST(SummarisedFit, TheFirstSessionHasToShowEveryCoefficient) {
  const std::vector<DrivenRecording> days = days_of({true, false, false}, 1, 51);
  Model model;
  model.effects.push_back({"scale", Channel::travel, {Shape("1")}, {}});
  SummarisedFit fit(model);  // no survey: no scale
  EXPECT_NE(refusal(fit, days[0]).find("does not show a coefficient of scale"), std::string::npos);
  EXPECT_EQ(fit.sessions(), 0);
}

}  // namespace
}  // namespace trussmap::summarised_fit_test
