// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/effect_drawings.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace trussmap::plot {
namespace {

/// A compass that reads beside where north is.
void misled(Sketch& s, Spot at, double off) {
  s.compass(at, 26, 90, Ink::believed);
  s.compass(at, 26, 90 - off, Ink::real);
}

/// The error over a full turn of the robot, so many times round.
void error_over_turn(Sketch& s, double times) {
  s.line({170, 85}, {304, 85}, Ink::believed).line({170, 30}, {170, 140}, Ink::plain);
  std::vector<Spot> curve;
  for (int k = 0; k <= 60; ++k) {
    const double turn = k / 60.0;
    curve.push_back({170 + 130 * turn, 85 - 40 * std::sin(2.0 * std::numbers::pi * times * turn)});
  }
  s.way(curve, Ink::real);
  s.text({237, 160}, "one turn of the robot").text({178, 34}, "error", Ink::real, "start");
}

void compass_offset(Sketch& s) {
  for (const Spot at : {Spot{60, 64}, Spot{172, 64}, Spot{276, 64}}) {
    misled(s, at, 22);
    s.arc(at, 33, 68, 90, Ink::cause);
  }
  s.robot({60, 124}, 0).robot({180, 124}, 90).robot({276, 124}, 180);
  s.text({160, 18}, "off by the same angle on every heading", Ink::cause);
}

void hard_iron(Sketch& s) {
  s.robot({70, 104}, 0).block({52, 104}, 12, 10, Ink::cause).block({64, 104}, 12, 10, Ink::plain);
  misled(s, {70, 46}, 30);
  s.text({70, 152}, "a magnet rides along", Ink::cause);
  error_over_turn(s, 1.0);
}

void soft_iron(Sketch& s) {
  s.robot({70, 104}, 0).block({62, 104}, 34, 7, Ink::cause, 35);
  misled(s, {70, 46}, 20);
  s.text({70, 152}, "iron rides along", Ink::cause);
  error_over_turn(s, 2.0);
}

void body_tilt(Sketch& s) {
  s.line({20, 134}, {180, 134}, Ink::plain);
  s.wheel(62, 134, 16, Ink::plain).wheel(142, 134, 16, Ink::plain);
  s.block({102, 102}, 112, 18, Ink::faint, -9).block({130, 80}, 40, 30, Ink::plain, -9);
  s.line({64, 88}, {64, 40}, Ink::believed)
      .line({64, 88}, {71, 42}, Ink::cause)
      .arc({64, 88}, 40, 90, 81, Ink::cause);
  s.compass({244, 78}, 34, 90, Ink::believed).compass({244, 78}, 34, 66, Ink::real);
  s.text({96, 156}, "from the side: it leans", Ink::cause)
      .text({246, 132}, "so does the")
      .text({246, 148}, "compass");
}

void compass_lag(Sketch& s) {
  s.robot({90, 100}, 60).arc_arrow({90, 100}, 54, 0, 58, Ink::plain);
  s.compass({220, 96}, 40, 100, Ink::real)
      .compass({220, 96}, 40, 62, Ink::believed)
      .arc_arrow({220, 96}, 50, 98, 64, Ink::cause);
  s.clock({280, 40}, Ink::cause)
      .text({90, 152}, "while it turns")
      .text({222, 156}, "the reading trails behind", Ink::believed);
}

void motor_current(Sketch& s) {
  s.robot({80, 100}, 0).line({66, 84}, {66, 116}, Ink::cause);
  for (const double r : {14.0, 24.0, 34.0}) s.arc({66, 100}, r, 200, 520, Ink::cause);
  s.arrow({112, 100}, {170, 100}, Ink::plain).text({142, 92}, "fast");
  misled(s, {236, 84}, 34);
  s.text({80, 158}, "the motors' field", Ink::cause)
      .text({236, 136}, "grows with the speed", Ink::real);
}

void magnetic_anomaly(Sketch& s) {
  for (const double r : {16.0, 32.0, 48.0}) s.circle({160, 92}, r, Ink::cause);
  s.line({150, 150}, {170, 34}, Ink::cause);
  const double off[] = {0, 12, 40, 12, 0};
  for (int k = 0; k < 5; ++k) {
    const Spot at{40 + 60.0 * k, 92};
    s.arrow(beside(at, 270, 16), beside(at, 90, 18), Ink::believed);
    s.arrow(beside(at, 270 - off[k], 16), beside(at, 90 - off[k], 18), Ink::real);
  }
  s.text({160, 22}, "steel or a cable, at this place", Ink::cause).text({284, 140}, "right again");
}

void compass_disturbance(Sketch& s) {
  for (const double x : {84.0, 236.0})
    s.circle({x, 120}, 12, x > 100 ? Ink::cause : Ink::plain).line({x, 132}, {x, 148}, Ink::plain);
  for (const double a : {0.0, 45.0, 135.0, 180.0})
    s.line(beside({236, 120}, a, 17), beside({236, 120}, a, 25), Ink::cause);
  s.compass({84, 64}, 30, 90, Ink::real);
  misled(s, {236, 64}, 36);
  s.text({84, 22}, "off").text({236, 22}, "on: the needle moves", Ink::cause);
}

void truth_heading(Sketch& s) {
  s.robot({100, 98}, 0).axes({100, 98}, 84, 0, Ink::plain).axes({100, 98}, 84, 18, Ink::cause);
  for (const Spot at : {Spot{90, 90}, Spot{112, 90}, Spot{104, 106}}) s.dot(at, 4, Ink::real);
  s.text({196, 102}, "the robot's axes", Ink::plain, "start")
      .text({192, 72}, "the tracker's", Ink::cause, "start");
}

constexpr EffectDrawing kHeadingDrawings[] = {{"compass offset", compass_offset},
                                              {"hard iron", hard_iron},
                                              {"soft iron", soft_iron},
                                              {"body tilt", body_tilt},
                                              {"compass lag", compass_lag},
                                              {"motor current", motor_current},
                                              {"local magnetic anomaly", magnetic_anomaly},
                                              {"compass disturbance", compass_disturbance},
                                              {"truth heading", truth_heading}};

}  // namespace

std::span<const EffectDrawing> drawings_of_headings() {
  return kHeadingDrawings;
}

}  // namespace trussmap::plot
