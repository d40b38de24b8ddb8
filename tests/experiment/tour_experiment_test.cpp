// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The tour experiment against curves computed elsewhere (tests/reference/elastic_curves.json:
// 6x6 mesh, 5 % and 0.03 rad, 24 seeds, 20 tours). Two means that agree differ by less than 4 of
// their combined standard errors.
#include "trussmap/tour_experiment.hpp"

#include "geometry/index.hpp"
#include "shared_data.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::tour_experiment_test {
namespace {

using nlohmann::json;

struct Curve {
  const char* ours;
  const char* reference;
};

void expect_close(const SeedMean& ours, const json& curve, const std::string& key,
                  std::size_t tour) {
  const double reference = curve[key == "abs" ? "abs_m" : key][tour];
  const double error = curve[key + "_se"][tour];
  EXPECT_LE(std::abs(ours.mean - reference), 4.0 * std::hypot(ours.standard_error, error))
      << key << " after tour " << tour + 1 << ": " << ours.mean << ", reference " << reference;
}

void expect_curve(const TourResult& result, const Curve& compared) {
  SCOPED_TRACE(compared.ours);
  const json curve = testing::reference("elastic_curves.json")["methods"][compared.reference];
  ASSERT_EQ(result.tours.size(), 20U);
  for (std::size_t tour = 0; tour < 20; ++tour) {
    const TourMetrics& ours = result.tours[tour].at(compared.ours);
    ASSERT_TRUE(curve.contains("sigma") || curve.contains("abs_m"));
    if (curve.contains("sigma")) {
      ASSERT_GT(curve["sigma"].size(), tour);
      expect_close(ours.stretch_error, curve, "sigma", tour);
      expect_close(ours.orientation_error, curve, "rho", tour);
    }
    if (curve.contains("abs_m")) {
      ASSERT_GT(curve["abs_m"].size(), tour);
      ASSERT_TRUE(ours.position_error.has_value());
      expect_close(*ours.position_error, curve, "abs_m", tour);
    }
  }
}

TEST(SlowTour, EveryCurveAgreesWithTheReferenceAfterEveryTour) {
  TourOptions options;
  options.mesh = even_mesh({6, 6}, 1.0);
  const TourResult result = run_tours(options);
  for (const Curve& curve : {Curve{"raw", "raw"}, Curve{"weighted_average", "wavg"},
                             Curve{"elastic_printed", "paper_mean_v0"},
                             Curve{"gauss_markov", "gauss_markov_incremental"},
                             Curve{"adjustment", "batchGM"}, Curve{"dead_reckoning", "dr_first"}}) {
    expect_curve(result, curve);
  }
  // On the same measurements the exact increments stay with the batch.
  for (const MethodMetrics& tour : result.tours) {
    EXPECT_LE(tour.at("gauss_markov").position_error->mean,
              1.15 * tour.at("adjustment").position_error->mean);
  }
}

/// Refinement by relaxation against curves of a dense program (tests/reference/relaxation.json),
/// the first eight tours.
TEST(SlowTour, RelaxationAgreesWithTheReferenceAfterEveryTour) {
  const json curves = testing::reference("relaxation.json")["curves"];
  using Kind = RefinementScope::Kind;
  const Mesh even = even_mesh({6, 6}, 1.0);
  const Mesh larger = even_mesh({8, 8}, 1.0);
  const Mesh uneven = mesh_of_lines({0, 1, 9, 11, 21, 22}, {0, 6, 7, 8, 17, 20});
  const std::string six = "6x6, 1 m, 5 %, 0.03 rad";
  const std::string eight = "8x8, 1 m, 10 %, 0.02 rad";
  int compared = 0;
  for (const auto& [world, of_world] : curves.items()) {
    TourOptions options;
    if (world == six) {
      options.mesh = even;
    } else if (world == eight) {
      options.mesh = larger;
      options.odometry_error = 0.10;
      options.compass_error = 0.02;
    } else if (world.find("uneven") != std::string::npos ||
               world.find("1 to 10") != std::string::npos) {
      options.mesh = uneven;
    } else {
      continue;
    }
    for (const auto& [name, curve] : of_world.items()) {
      if (name.find("closings too") == std::string::npos) continue;
      SCOPED_TRACE(world + ": " + name);
      options.law = name.find("variance") == 0 ? StiffnessLaw::variance : StiffnessLaw::mean_error;
      const std::size_t at = name.find("eta ") + 4;
      options.scope = name.compare(at, 3, "all") == 0
                          ? RefinementScope{Kind::all}
                          : RefinementScope{Kind::nearest, std::stoi(name.substr(at)), false};
      options.tours = 8;
      const TourResult result = run_tours(options);
      ++compared;
      for (std::size_t tour = 0; tour < result.tours.size(); ++tour) {
        const TourMetrics& ours = result.tours[tour].at("elastic");
        expect_close(ours.stretch_error, curve, "sigma", tour);
        expect_close(ours.orientation_error, curve, "rho", tour);
        expect_close(*ours.position_error, curve, "abs", tour);
      }
    }
  }
  EXPECT_GE(compared, 12);
}

TEST(SlowTour, OnAnUnevenMeshThePrintedRefinementDivergesAndRelaxationDoesNot) {
  TourOptions options;
  options.mesh = mesh_of_lines({0, 1, 9, 11, 21, 22}, {0, 6, 7, 8, 17, 20});
  options.tours = 10;
  const TourResult result = run_tours(options);
  EXPECT_LT(result.tours[9].at("elastic").stretch_error.mean, 0.016);
  EXPECT_GT(result.tours[9].at("elastic_printed").stretch_error.mean, 0.1);
}

/// From wheels to map, with a compass once per landmark, once per tour, in each row, or without.
TEST(Tour, FromWheelsTheElasticMapIsNearlyTheBest) {
  for (const CompassReadings readings : {CompassReadings::none, CompassReadings::tour,
                                         CompassReadings::landmark, CompassReadings::row}) {
    TourOptions options;
    options.mesh = even_mesh({5, 5}, 5.0);
    options.tours = 3;
    options.seeds = 6;
    options.wheels = TourWheels{0.003, 0.34, readings};
    const TourResult result = run_tours(options);
    SCOPED_TRACE(static_cast<int>(readings));
    const MethodMetrics& last = result.tours[2];
    const double best = last.at("adjustment").position_error->mean;
    EXPECT_LT(last.at("elastic").position_error->mean, 1.5 * best);
    EXPECT_LT(last.at("gauss_markov").position_error->mean, 1.5 * best);
    for (const MethodMetrics& tour : result.tours) {
      EXPECT_LT(tour.at("elastic").position_error->mean,
                0.5 * tour.at("dead_reckoning").position_error->mean);
    }
    EXPECT_LT(last.at("elastic").orientation_error.mean,
              0.5 * last.at("raw").orientation_error.mean);
  }
}

TEST(Tour, SeedsDoNotDependOnOneAnother) {
  TourOptions options;
  options.mesh = even_mesh({3, 4}, 2.0);
  options.tours = 2;
  options.seeds = 3;
  const TourResult joint = run_tours(options);
  options.seeds = 1;
  double sum = 0.0;
  for (options.first_seed = 1; options.first_seed <= 3; ++options.first_seed) {
    sum += run_tours(options).tours[1].at("elastic").stretch_error.mean;
  }
  EXPECT_NEAR(sum / 3.0, joint.tours[1].at("elastic").stretch_error.mean, 1e-15);
}

TEST(Tour, TinyErrorsGiveTheTrueMap) {
  TourOptions options;
  options.mesh = even_mesh({4, 4}, 1.0);
  options.tours = 2;
  options.seeds = 1;
  options.odometry_error = options.compass_error = 1e-9;
  const TourResult result = run_tours(options);
  for (const std::string& method : tour_methods()) {
    EXPECT_LT(result.tours[1].at(method).stretch_error.mean, 1e-7) << method;
  }
}

TEST(Tour, RefusesWhatIsNoExperiment) {
  TourOptions options;
  options.mesh = even_mesh({3, 3}, 1.0);
  options.tours = 0;
  EXPECT_THROW((void)run_tours(options), std::invalid_argument);
  options.tours = 1;
  options.compass_error = 0.0;
  EXPECT_THROW((void)run_tours(options), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::tour_experiment_test
