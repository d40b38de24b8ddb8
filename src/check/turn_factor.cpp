// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/turn_factor.hpp"

#include "odometry/merge.hpp"
#include "statistics/median.hpp"
#include "statistics/thinned.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

namespace trussmap::check {
namespace {

using Complex = std::complex<double>;

constexpr double kLeastApart = 0.3;        // m, and
constexpr double kNoiseApart = 8.0;        // times the places' noise
constexpr std::size_t kFewestInPiece = 5;  // places
constexpr double kLongestPiece = 60.0;     // m driven
constexpr std::size_t kMostPieces = 100;
constexpr std::size_t kFewestPieces = 4;
constexpr double kRoundShare = 0.5;       // of a piece, by its own mirror image: 0 of a line
constexpr double kPlacesFit = 0.2;        // e of the sign that holds
constexpr double kPlacesMiss = 0.15;      // e of the other one, at least: steps of f make some
constexpr double kPlacesFitBetter = 0.5;  // than the other sign
constexpr double kFactorStep = 0.04;      // of log f
constexpr int kNearSteps = 8;             // steps from 1: 0.73 to 1.38
constexpr int kFarSteps = 23;             // 0.4 to 2.5

/// What is left of places once others are turned, moved and scaled onto them, by their extent; both
/// about their means.
double left_of(const std::vector<Complex>& others, const std::vector<Complex>& places,
               bool mirrored) {
  Complex product = 0.0;
  double ours = 0.0;
  double theirs = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    product += (mirrored ? others[k] : std::conj(others[k])) * places[k];
    theirs += std::norm(others[k]);
    ours += std::norm(places[k]);
  }
  if (!(ours > 0.0) || !(theirs > 0.0)) return 1.0;
  return std::sqrt(std::max(0.0, 1.0 - std::norm(product) / (ours * theirs)));
}

void about_mean(std::vector<Complex>& places) {
  Complex mean = 0.0;
  for (const Complex& one : places) mean += one / static_cast<double>(places.size());
  for (Complex& one : places) one -= mean;
}

std::vector<Complex> centred(const std::vector<TimedPlace>& places, const CornerPiece& piece) {
  std::vector<Complex> result;
  for (std::size_t k = piece.first; k < piece.end; ++k) {
    result.emplace_back(places[k].at.x(), places[k].at.y());
  }
  about_mean(result);
  return result;
}

/// Turns at the places in their middle, and goes round no less in width than noise could make.
bool goes_round(const std::vector<TimedPlace>& places, const CornerPiece& piece, double noise) {
  const std::vector<Complex> all = centred(places, piece);
  double squares = 0.0;
  for (const Complex& one : all) squares += std::norm(one);
  const double extent = std::sqrt(squares / static_cast<double>(all.size()));
  return extent > 4.0 * noise && left_of(all, all, true) > kRoundShare;
}

/// A piece's rows, joined into what hardly turns.
struct Step {
  Complex ahead;      ///< m, to the left as its imaginary part
  double turn = 0.0;  ///< rad
};

struct Course {
  std::vector<Step> steps;
  std::vector<std::size_t> marks;  ///< steps driven at each place
  std::vector<Complex> places;
};

Course course_of(const MotionRows& drive, const std::vector<TimedPlace>& places,
                 const CornerPiece& piece) {
  constexpr double kStraight = 0.05;  // rad
  Course course{{}, {0}, centred(places, piece)};
  for (std::size_t k = piece.first + 1; k < piece.end; ++k) {
    Step sum;
    for (const odometry::DriveRow& row :
         odometry::rows_between(drive, places[k - 1].t, places[k].t)) {
      const BodyMotion motion = odometry::motion_of(drive, row);
      sum.ahead += Complex(motion.forward, motion.sideways);
      sum.turn += motion.turn;
      if (std::abs(sum.turn) > kStraight) course.steps.push_back(std::exchange(sum, {}));
    }
    course.steps.push_back(sum);
    course.marks.push_back(course.steps.size());
  }
  return course;
}

/// The places by the wheels, with turns times the factor.
std::vector<Complex> driven(const Course& course, double factor) {
  std::vector<Complex> result{0.0};
  Complex at = 0.0;
  double heading = 0.0;
  std::size_t next = 1;
  for (std::size_t k = 0; k < course.steps.size(); ++k) {
    const Step& step = course.steps[k];
    at += step.ahead * std::polar(1.0, heading + 0.5 * factor * step.turn);
    heading += factor * step.turn;
    while (next < course.marks.size() && course.marks[next] == k + 1) {
      result.push_back(at);
      ++next;
    }
  }
  about_mean(result);
  return result;
}

/// e of the best factor of each sign among those up to so many steps from 1.
struct BestFactors {
  double straight = 1.0;  ///< above 0
  double mirrored = 1.0;
};

BestFactors best_factors(const std::vector<Course>& courses, int steps) {
  BestFactors best;
  for (int k = -steps; k <= steps; ++k) {
    const double factor = std::exp(kFactorStep * k);
    std::vector<double> straight;
    std::vector<double> mirrored;
    for (const Course& one : courses) {
      const std::vector<Complex> by_wheels = driven(one, factor);
      straight.push_back(left_of(by_wheels, one.places, false));
      mirrored.push_back(left_of(by_wheels, one.places, true));
    }
    best.straight = std::min(best.straight, statistics::median(std::move(straight)));
    best.mirrored = std::min(best.mirrored, statistics::median(std::move(mirrored)));
  }
  return best;
}

/// The sign that fits, where the other one does not, and not nearly as well.
int sign_of(const BestFactors& best) {
  const auto fits = [](double one, double other) {
    return one < kPlacesFit && other > std::max(kPlacesMiss, one / kPlacesFitBetter);
  };
  if (fits(best.straight, best.mirrored)) return 1;
  return fits(best.mirrored, best.straight) ? -1 : 0;
}

/// A factor near 1 counts before one that is far from it, but for one that fits better.
int sign_of(const BestFactors& near, const BestFactors& far) {
  constexpr double kNearlyAsGood = 1.1;
  constexpr double kBySteps = 0.02;  // e that the steps of f make
  const int sign = sign_of(near);
  const double fits = sign > 0 ? near.straight : near.mirrored;
  const double other = sign > 0 ? far.mirrored : far.straight;
  return sign != 0 && fits < kNearlyAsGood * other + kBySteps ? sign : sign_of(far);
}

}  // namespace

std::vector<TimedPlace> places_apart(const PlacesSeen& places, const Track& track) {
  const double apart = std::max(kLeastApart, kNoiseApart * places.noise);
  std::vector<TimedPlace> result;
  for (const TimedPlace& one : places.all) {
    if (!result.empty() && track.way_at(one.t) - track.way_at(result.back().t) < apart) continue;
    result.push_back(one);
  }
  return result;
}

std::vector<CornerPiece> corner_pieces(const std::vector<TimedPlace>& places, const Track& track,
                                       double noise) {
  std::vector<CornerPiece> pieces;
  std::size_t first = 0;
  for (std::size_t end = kFewestInPiece; end <= places.size(); ++end) {
    if (end - first < kFewestInPiece) continue;
    const CornerPiece piece{first, end};
    const double way = track.way_at(places[end - 1].t) - track.way_at(places[first].t);
    if (goes_round(places, piece, noise)) {
      pieces.push_back(piece);
      first = end - 1;
    } else if (way > kLongestPiece && end - first > kFewestInPiece) {
      ++first;
    }
  }
  return statistics::thinned(std::move(pieces), kMostPieces);
}

int turn_sign(const MotionRows& drive, const Track& track, const PlacesSeen& places) {
  const std::vector<TimedPlace> apart = places_apart(places, track);
  const std::vector<CornerPiece> pieces = corner_pieces(apart, track, places.noise);
  if (pieces.size() < kFewestPieces) return 0;
  std::vector<Course> courses;
  courses.reserve(pieces.size());
  for (const CornerPiece& piece : pieces) {
    courses.push_back(course_of(drive, apart, piece));
  }
  return sign_of(best_factors(courses, kNearSteps), best_factors(courses, kFarSteps));
}

}  // namespace trussmap::check
