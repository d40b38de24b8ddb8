// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What must hold of every arrival: refinement lets the energy of the map's truss fall, whatever the
// covariances and wherever the robot goes. The energy before the correction is that of a twin that
// takes the same arrival in without refining.
#include "geometry/index.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::map_builder_energy_test {
namespace {

constexpr double kRounding = 1e-9;  // of the energy before
constexpr double kNoGate = std::numeric_limits<double>::infinity();
constexpr double kNothing = 1e-12;  // of a map that is at rest but for rounding

enum class Shape { cloud, star, chain, grid, clusters };

/// Where a robot goes next, over landmarks of one of several shapes.
class Wanderer {
 public:
  Wanderer(Shape shape, unsigned seed) : shape_(shape), random_(seed) {
    std::uniform_real_distribution<double> anywhere(0.0, 20.0);
    for (int k = 0; k < kLandmarks; ++k) {
      if (shape == Shape::grid) {
        places_.emplace_back(k % 6, k / 6);
      } else if (shape == Shape::chain) {
        places_.emplace_back(k, 0.0);
      } else if (shape == Shape::clusters) {  // islands, a few ways between them
        places_.emplace_back(1000.0 * (k % 3) + anywhere(random_), anywhere(random_));
      } else {
        places_.emplace_back(anywhere(random_), anywhere(random_));
      }
    }
    if (shape == Shape::cloud) places_[7] = places_[3];  // a route of no length
  }

  [[nodiscard]] int here() const { return here_; }

  int next() {
    const int from = here_;
    while (here_ == from) {
      const int any = static_cast<int>(random_() % kLandmarks);
      switch (shape_) {
        case Shape::star:
          here_ = from == 0 ? any : 0;
          break;
        case Shape::chain:
          here_ = std::clamp(from + (random_() % 2 == 0 ? 1 : -1), 0, kLandmarks - 1);
          break;
        case Shape::clusters:
          here_ = random_() % 20 == 0 || any % 3 == from % 3 ? any : from;
          break;
        default:
          here_ = any;
      }
    }
    return here_;
  }

  /// Stiffness ratios from 1 to 10^8, errors of any size beside them.
  Traversal leg(int from, int to) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> power(-8.0, 0.0);
    const Matrix2 R = rotation(normal(random_));
    const Vector2 sds(0.1, 0.1 * std::pow(10.0, 0.5 * power(random_)));
    const Matrix2 C = R * sds.cwiseAbs2().asDiagonal() * R.transpose();
    const Vector2 error = R * Vector2(sds[0] * normal(random_), sds[1] * normal(random_));
    const double gross = random_() % 50 == 0 ? 30.0 : 1.0;
    return {places_[idx(to)] - places_[idx(from)] + gross * error, 0.5 * (C + C.transpose())};
  }

  /// The same by wheels whose noise differs from leg to leg.
  Motion motion(int from, int to) {
    std::uniform_real_distribution<double> power(-3.0, -1.0);
    std::normal_distribution<double> normal;
    const Vector2 way = places_[idx(to)] - places_[idx(from)];
    const double turn = wrap_angle(direction(way) - heading_);
    heading_ += turn;
    const double k = std::pow(10.0, power(random_));
    const double l = std::max(way.norm(), 1e-3);
    const auto noisy = [&](double d) { return d + k * std::sqrt(std::abs(d)) * normal(random_); };
    const WheelNoise noise{k, k};
    const Motion spin = arc_motion({noisy(-0.2 * turn), noisy(0.2 * turn)}, 0.4, noise);
    return then(spin, arc_motion({noisy(l), noisy(l)}, 0.4, noise));
  }

 private:
  static constexpr int kLandmarks = 30;
  Shape shape_;
  std::mt19937_64 random_;
  std::vector<Vector2> places_;
  int here_ = 0;
  double heading_ = 0.0;
};

std::string name(int k) {
  return "n" + std::to_string(k);
}

struct Trial {
  Shape shape;
  RefinementScope scope;
  StiffnessLaw law;
  bool wheels;
};

/// After each arrival the energy of the builder that refines against that of one that does not, but
/// is otherwise the same: both go on from one map every hundred arrivals.
void expect_falling_energy(const Trial& trial, int arrivals, unsigned seed) {
  MapBuilderOptions options;
  options.scope = trial.scope;
  options.law = trial.law;
  options.pooled = true;
  options.gate = kNoGate;
  Wanderer wanderer(trial.shape, seed);
  MapBuilder builder(options);
  builder.start(name(0));
  MapBuilderOptions still = options;
  still.refine = false;
  int checked = 0;
  for (int k = 0; k < arrivals; ++k) {
    const int from = wanderer.here();
    const int to = wanderer.next();
    const bool known = builder.find(name(to)).has_value();
    const bool new_route =
        known && !builder.route_between(*builder.find(name(from)), *builder.find(name(to)));
    const auto arrive = [&] {
      return trial.wheels ? builder.arrive(name(to), wanderer.motion(from, to))
                          : builder.arrive(name(to), wanderer.leg(from, to));
    };
    try {
      // A known route: the same arrival without refinement first, then refinement by itself, which
      // is what comes after any arrival.
      builder.set_options(still);
      static_cast<void>(arrive());
      builder.set_options(options);
      const double before = builder.energy();
      if (!new_route || known) {
        builder.relax();
        const double after = builder.energy();
        ASSERT_LE(after, before * (1.0 + kRounding) + kNothing) << "arrival " << k;
        ++checked;
      }
    } catch (const SolveError&) {
      // refused whole: nothing has changed
    }
  }
  EXPECT_GT(checked, arrivals / 2);
}

void expect_falling_energies(int arrivals, unsigned seed) {
  for (const Shape shape :
       {Shape::cloud, Shape::star, Shape::chain, Shape::grid, Shape::clusters}) {
    for (const StiffnessLaw law : {StiffnessLaw::mean_error, StiffnessLaw::variance}) {
      for (const bool wheels : {false, true}) {
        if (wheels && (shape == Shape::cloud || shape == Shape::clusters)) continue;
        SCOPED_TRACE(std::to_string(static_cast<int>(shape)) + (wheels ? " wheels" : ""));
        expect_falling_energy({shape, {}, law, wheels}, arrivals, seed++);
      }
    }
  }
}

TEST(MapBuilderEnergy, FallsWhenAllComesToEquilibrium) {
  expect_falling_energies(150, 1);
}

/// Within a scope: against a twin that stays at the first sight's map, the energy is never above.
void expect_energies_below_the_uncorrected(int arrivals, unsigned seed) {
  using Kind = RefinementScope::Kind;
  for (const RefinementScope& scope :
       {RefinementScope{Kind::nearest, 5, false}, RefinementScope{Kind::nearest, 5, true},
        RefinementScope{Kind::estimated, 5, false}, RefinementScope{Kind::all}}) {
    for (const Shape shape : {Shape::cloud, Shape::star, Shape::chain, Shape::grid}) {
      MapBuilderOptions options{.scope = scope, .gate = kNoGate};
      MapBuilderOptions still = options;
      still.refine = false;
      MapBuilder builder(options);
      MapBuilder twin(still);
      Wanderer wanderer(shape, seed++);
      builder.start(name(0));
      twin.start(name(0));
      for (int k = 0; k < arrivals; ++k) {
        const int from = wanderer.here();
        const int to = wanderer.next();
        const Traversal leg = wanderer.leg(from, to);
        builder.arrive(name(to), leg);
        twin.arrive(name(to), leg);
        ASSERT_TRUE(std::isfinite(builder.energy()));
        ASSERT_LE(builder.energy(), twin.energy() * (1.0 + kRounding)) << "arrival " << k;
      }
    }
  }
}

TEST(MapBuilderEnergy, OfEveryScopeStaysBelowThatOfTheUncorrectedMap) {
  expect_energies_below_the_uncorrected(200, 100);
}

/// Some 10^5 arrivals.
TEST(SlowMapBuilderEnergy, NeverRises) {
  expect_falling_energies(2500, 1000);
  expect_energies_below_the_uncorrected(4000, 2000);
}

}  // namespace
}  // namespace trussmap::map_builder_energy_test
