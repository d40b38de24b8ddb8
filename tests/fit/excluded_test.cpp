// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Times that are excluded from a fit: what was driven and sighted there counts nowhere.
#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/error.hpp"
#include "trussmap/held_out.hpp"
#include "validation/leg_spans.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace trussmap::excluded_test {
using namespace validation;
namespace {

using testing::simulate_recording;
using testing::SimulatedRecording;

FitOptions without(const TimeSpan& span) {
  FitOptions options;
  options.excluded = {{span}};
  return options;
}

/// Some legs in the middle, from one sighting to another.
TimeSpan middle_of(const ModelFit& fit) {
  const std::vector<LegSpan> legs = leg_spans(*fit.state);
  return {legs[legs.size() / 2].time.from, legs[legs.size() / 2 + 3].time.to};
}

/// Wheels that spun and a sighting of another landmark, in the middle of a span.
DrivenRecording spoilt(DrivenRecording recording, const TimeSpan& span) {
  const double middle = 0.5 * (span.from + span.to);
  for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
    if (recording.drive.t[row] > middle && recording.drive.t[row] < middle + 1.0) {
      recording.drive.pair.left[row] += 0.2;
    }
  }
  testing::retake(recording.drive);
  for (Sighting& one : recording.sightings) {
    if (one.t > span.from && one.t < span.to) one.landmark = recording.sightings.front().landmark;
  }
  return recording;
}

void expect_same(const ModelFit& a, const ModelFit& b, double within) {
  EXPECT_EQ(a.dof, b.dof);
  EXPECT_NEAR(a.chi2, b.chi2, within);
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (std::size_t k = 0; k < a.landmarks.size(); ++k) {
    EXPECT_EQ(a.landmarks[k].name, b.landmarks[k].name);
    EXPECT_LT((a.landmarks[k].position - b.landmarks[k].position).norm(), within);
  }
}

TEST(ExcludedTimes, WhateverHappenedThereChangesNothing) {
  const SimulatedRecording one = simulate_recording({true, true, false}, 21);
  const ModelFit whole = fit_model({one.recording}, one.model);
  const TimeSpan span = middle_of(whole);
  const DrivenRecording bad = spoilt(one.recording, span);
  ASSERT_LT(fit_model({bad}, one.model).p_value, 1e-6);  // it is bad indeed
  const ModelFit clean = fit_model({one.recording}, one.model, without(span));
  const ModelFit mended = fit_model({bad}, one.model, without(span));
  EXPECT_LT(clean.dof, whole.dof);
  EXPECT_GT(mended.p_value, 0.01);
  expect_same(clean, mended, 1e-6);
}

TEST(ExcludedTimes, ADriveThatIsPartlyWithinIsOutAsAWhole) {
  const SimulatedRecording one = simulate_recording({true, true, false}, 22);
  const ModelFit whole = fit_model({one.recording}, one.model);
  const TimeSpan span = middle_of(whole);
  const auto next =
      std::find_if(one.recording.sightings.begin(), one.recording.sightings.end(),
                   [&span](const Sighting& sighting) { return sighting.t > span.from; });
  const TimeSpan begun_later{0.5 * (span.from + next->t), span.to};
  expect_same(fit_model({one.recording}, one.model, without(span)),
              fit_model({one.recording}, one.model, without(begun_later)), 1e-9);
}

TEST(ExcludedTimes, LegsKeepTheirNumbersAndHeldOutOnesOutsideArePredictedAllTheSame) {
  const SimulatedRecording one = simulate_recording({true, true, false}, 23);
  const ModelFit whole = fit_model({one.recording}, one.model);
  const TimeSpan span = middle_of(whole);
  const ModelFit fit = fit_model({one.recording}, one.model, without(span));
  const HeldOut all = predict_held_out({one.recording}, whole);
  const HeldOut some = predict_held_out({one.recording}, fit);
  // What happened within judges nothing either.
  std::set<std::size_t> within;
  for (const LegSpan& leg : leg_spans(*whole.state)) {
    if (leg.held_out && leg.time.from < span.to && span.from < leg.time.to) {
      within.insert(leg.number);
    }
  }
  ASSERT_GT(within.size(), 0U);
  ASSERT_EQ(some.legs.size() + within.size(), all.legs.size());
  ASSERT_GT(some.legs.size(), 5U);
  std::size_t at = 0;
  for (const LegPrediction& leg : all.legs) {
    if (within.contains(leg.leg)) continue;
    EXPECT_EQ(some.legs[at].leg, leg.leg);
    EXPECT_EQ(some.legs[at].to, leg.to);
    EXPECT_LT((some.legs[at].arrival_error - leg.arrival_error).norm(), 0.05);
    ++at;
  }
  const Comparison before = compare({one.recording}, whole);
  const Comparison after = compare({one.recording}, fit);
  EXPECT_EQ(after.legs, before.legs - 4);
  std::set<std::size_t> gone;
  for (const LegMisfit& leg : before.worst) gone.insert(leg.leg);
  for (const LegMisfit& leg : after.worst) {
    EXPECT_EQ(gone.erase(leg.leg), 1U);
    EXPECT_FALSE(leg.t > span.from && leg.t <= span.to);
  }
  EXPECT_EQ(gone.size(), 4U);
  EXPECT_EQ(*gone.rbegin() - *gone.begin(), 3U);
}

TEST(ExcludedTimes, ALateClockMovesThemWithItsSightings) {
  SimulatedRecording one = simulate_recording({true, true, false}, 24);
  constexpr double kLate = 0.2;  // s
  for (Sighting& sighting : one.recording.sightings) sighting.t += kLate;
  std::erase_if(one.recording.sightings, [&one](const Sighting& sighting) {
    return sighting.t > one.recording.drive.t.back();
  });
  Model model = one.model;
  model.effects.push_back({"late", Channel::delay, {"1"}, {}, false});
  const ModelFit whole = fit_model({one.recording}, model);
  ASSERT_GT(whole.effects.front().effect.coefficients.front(), 0.05);  // it stands at landmarks
  // As recorded: from a sighting to one a few further on.
  const auto& sightings = one.recording.sightings;
  const TimeSpan span{sightings[sightings.size() / 2].t, sightings[sightings.size() / 2 + 6].t};
  ASSERT_LT(span.from, span.to);
  const ModelFit clean = fit_model({one.recording}, model, without(span));
  const ModelFit mended = fit_model({spoilt(one.recording, span)}, model, without(span));
  EXPECT_LT(clean.dof, whole.dof);
  // The bad sightings in the span are out by their recorded times, and no other is.
  EXPECT_GT(mended.p_value, 0.001);
  EXPECT_EQ(clean.dof, mended.dof);
  EXPECT_NEAR(mended.effects.front().effect.coefficients.front(),
              clean.effects.front().effect.coefficients.front(), 1e-3);
  const HeldOut predicted = predict_held_out({one.recording}, clean);
  const std::size_t all = predict_held_out({one.recording}, whole).legs.size();
  EXPECT_LT(predicted.legs.size(), all);  // some of those held out are within
  EXPECT_GT(predicted.legs.size(), all / 2);
}

TEST(ExcludedTimes, OfRecordingsThatAreNotThereAreRefused) {
  const SimulatedRecording one = simulate_recording({true, true, false}, 25);
  FitOptions options;
  options.excluded = {{}, {{1.0, 2.0}}};
  EXPECT_THROW(static_cast<void>(fit_model({one.recording}, one.model, options)),
               std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::excluded_test
