// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/effect_drawings.hpp"

#include <cmath>

namespace trussmap::plot {
namespace {

void wheelbase(Sketch& s) {
  s.robot({100, 95}, 0, {.body = Ink::believed});
  s.robot({100, 95}, 0, {.track = 1.5, .left_ink = Ink::cause, .right_ink = Ink::cause});
  s.span({62, 67}, {62, 123}, Ink::cause);
  s.arc_arrow({100, 95}, 62, 0, 88, Ink::believed).arc_arrow({100, 95}, 74, 0, 58, Ink::real);
  s.text({40, 99}, "wider", Ink::cause).text({186, 62}, "turns less", Ink::real, "start");
  s.text({112, 24}, "than believed", Ink::believed, "start");
}

void constant_creep(Sketch& s) {
  s.robot({50, 125}, 0)
      .arrow({84, 125}, {292, 125}, Ink::believed)
      .arrow({84, 121}, {246, 66}, Ink::real);
  s.robot({274, 56}, 0, {.left_ink = Ink::real, .right_ink = Ink::real, .body = Ink::real});
  s.arrow({165, 122}, {165, 100}, Ink::cause).text({172, 115}, "sideways", Ink::cause, "start");
  s.text({112, 44}, "it points ahead, arrives beside");
}

void cross_slope(Sketch& s) {
  for (int k = 0; k < 7; ++k) s.line({16, 20 + 22.0 * k}, {304, 20 + 22.0 * k}, Ink::faint);
  s.arrow({160, 44}, {160, 134}, Ink::cause).text({160, 150}, "downhill", Ink::cause);
  s.robot({46, 50}, 0)
      .arrow({80, 50}, {148, 50}, Ink::believed)
      .arrow({80, 53}, {144, 78}, Ink::real);
  s.robot({276, 50}, 180)
      .arrow({242, 50}, {174, 50}, Ink::believed)
      .arrow({242, 53}, {178, 78}, Ink::real);
  s.text({70, 118}, "to its right").text({252, 118}, "to its left");
}

void side_slip(Sketch& s) {
  s.arc_arrow({90, 160}, 90, 62, 4, Ink::believed)
      .bent_arrow({132, 80}, {206, 106}, {250, 152}, Ink::real);
  s.robot({104, 68}, -15);
  s.arrow({168, 104}, {192, 76}, Ink::cause).arrow({146, 90}, {160, 58}, Ink::cause);
  s.text({196, 62}, "outwards", Ink::cause, "start")
      .text({196, 78}, "in the bend", Ink::cause, "start");
}

void slope(Sketch& s) {
  s.way({{20, 140}, {160, 64}, {300, 140}}, Ink::plain).line({20, 140}, {300, 140}, Ink::faint);
  s.block({84, 88}, 46, 14, Ink::faint, 28.5).block({236, 88}, 46, 14, Ink::faint, -28.5);
  s.dot({68, 105}, 9, Ink::cause).dot({98, 89}, 9, Ink::cause);
  s.dot({222, 89}, 9, Ink::plain).dot({252, 105}, 9, Ink::plain);
  s.arrow({50, 82}, {84, 63}, Ink::real).arrow({222, 54}, {286, 89}, Ink::real);
  s.text({66, 52}, "up: it slips", Ink::cause).text({256, 46}, "down: it runs on");
}

void arc_loss(Sketch& s) {
  s.robot({60, 130}, 0);
  s.arc_arrow({94, 20}, 110, -90, -4, Ink::believed).arc_arrow({94, 20}, 122, -90, -30, Ink::real);
  for (const double a : {-76.0, -60.0, -44.0})
    s.line(beside({94, 20}, a, 117), beside({94, 20}, a, 134), Ink::cause);
  s.text({190, 152}, "scrubbing in the arc", Ink::cause, "start")
      .text({214, 30}, "as believed", Ink::believed, "start");
}

void spin_loss(Sketch& s) {
  s.robot({96, 90}, 0, {.body = Ink::believed}).robot({152, 90}, 180);
  s.dot({124, 90}, 6, Ink::cause).arc_arrow({124, 90}, 46, 150, 30, Ink::real);
  s.text({124, 148}, "the point that it turns about", Ink::cause)
      .text({60, 60}, "before", Ink::believed)
      .text({240, 94}, "after half a turn", Ink::real);
}

void turn_scrub(Sketch& s) {
  for (const double x : {70.0, 220.0}) s.robot({x, 120}, 0);
  s.arc_arrow({70, 120}, 52, 0, 88, Ink::believed).arc_arrow({70, 120}, 62, 0, 82, Ink::real);
  s.arc_arrow({220, 120}, 52, 0, 88, Ink::believed).arc_arrow({220, 120}, 62, 0, 54, Ink::real);
  s.arc({220, 120}, 62, 58, 88, Ink::cause);
  s.text({78, 28}, "slow").text({232, 28}, "fast: it turns less", Ink::cause);
}

void turn_asymmetry(Sketch& s) {
  s.robot({160, 112}, 90);
  s.arc_arrow({160, 112}, 56, 90, 176, Ink::believed)
      .arc_arrow({160, 112}, 56, 90, 4, Ink::believed);
  s.arc_arrow({160, 112}, 70, 90, 196, Ink::real).arc_arrow({160, 112}, 70, 90, 28, Ink::real);
  s.arc({160, 112}, 63, 26, 4, Ink::cause);
  s.text({60, 40}, "left: more", Ink::real).text({262, 40}, "right: less", Ink::cause);
}

void twist_per_spin(Sketch& s) {
  s.robot({90, 104}, 0)
      .line({112, 104}, {124, 118}, Ink::cause)
      .block({126, 121}, 14, 7, Ink::cause, -50);
  s.arc_arrow({112, 104}, 24, -8, -66, Ink::cause);
  s.line({90, 104}, {170, 104}, Ink::believed)
      .line({90, 104}, beside({90, 104}, 16, 80), Ink::cause);
  s.arc({90, 104}, 76, 0, 16, Ink::cause).arc_arrow({90, 104}, 76, 18, 80, Ink::real);
  s.text({174, 98}, "a kick, at each start", Ink::cause, "start");
  s.text({130, 152}, "the castor swings round", Ink::cause)
      .text({160, 40}, "then the turn", Ink::real, "start");
}

void heading_drift(Sketch& s) {
  s.robot({110, 100}, 0).robot({110, 100}, 48, {.body = Ink::believed});
  s.arc_arrow({110, 100}, 60, 0, 54, Ink::believed).clock({230, 60}, Ink::cause);
  s.text({230, 96}, "standing still,").text({230, 112}, "it believes to turn", Ink::believed);
}

/// Axes of a small chart: what is read over something.
void chart(Sketch& s, const char* below) {
  s.arrow({150, 140}, {300, 140}, Ink::plain).arrow({150, 140}, {150, 24}, Ink::plain);
  s.text({225, 160}, below).text({158, 28}, "turn read at rest", Ink::plain, "start");
}

void gyro_box(Sketch& s) {
  s.block({66, 84}, 70, 52, Ink::faint).arc_arrow({66, 84}, 18, 200, -80, Ink::cause);
  s.text({66, 134}, "gyro");
}

void gyro_bias(Sketch& s) {
  gyro_box(s);
  chart(s, "time");
  s.line({150, 112}, {292, 112}, Ink::believed)
      .line({150, 72}, {292, 72}, Ink::cause)
      .span({225, 75}, {225, 109}, Ink::cause);
  s.text({290, 128}, "none", Ink::believed, "end");
}

void gyro_warm_up(Sketch& s) {
  gyro_box(s);
  s.clock({66, 34}, Ink::cause);
  chart(s, "time since switched on");
  s.line({150, 118}, {292, 118}, Ink::believed).arrow({150, 118}, {288, 52}, Ink::cause);
}

void gyro_temperature(Sketch& s) {
  gyro_box(s);
  s.line({112, 40}, {112, 100}, Ink::plain)
      .dot({112, 108}, 9, Ink::cause)
      .line({112, 64}, {112, 104}, Ink::cause);
  chart(s, "temperature");
  s.line({150, 96}, {292, 96}, Ink::believed).arrow({156, 124}, {288, 60}, Ink::cause);
}

void gyro_scale(Sketch& s) {
  s.robot({110, 88}, 90)
      .arc_arrow({110, 88}, 62, 90, 448, Ink::real)
      .arc_arrow({110, 88}, 48, 90, 410, Ink::believed);
  s.arc({110, 88}, 48, 54, 88, Ink::cause);
  s.text({186, 60}, "ten full turns", Ink::real, "start")
      .text({186, 80}, "read as fewer", Ink::believed, "start");
}

void gyro_asymmetry(Sketch& s) {
  for (const double x : {84.0, 236.0}) s.robot({x, 96}, 90);
  s.arc_arrow({84, 96}, 56, 90, 270, Ink::real)
      .arc_arrow({84, 96}, 44, 90, 300, Ink::believed)
      .arc({84, 96}, 44, 270, 300, Ink::cause);
  s.arc_arrow({236, 96}, 56, 90, -90, Ink::real)
      .arc_arrow({236, 96}, 44, 90, -60, Ink::believed)
      .arc({236, 96}, 44, -60, -90, Ink::cause);
  s.text({84, 20}, "read as more", Ink::cause).text({236, 20}, "read as less", Ink::cause);
}

void slippery_patch(Sketch& s) {
  s.circle({170, 88}, 52, Ink::cause);
  for (int k = 0; k < 4; ++k) s.line({138 + 20.0 * k, 118}, {150 + 20.0 * k, 60}, Ink::faint);
  s.robot({46, 88}, 0)
      .arrow({80, 80}, {300, 80}, Ink::believed)
      .arrow({80, 96}, {256, 96}, Ink::real);
  s.text({170, 28}, "slippery here", Ink::cause).text({310, 120}, "less far", Ink::real, "end");
}

void roller_slip(Sketch& s) {
  s.block({70, 85}, 64, 52, Ink::faint);
  for (const double x : {46.0, 94.0}) {
    for (const double y : {52.0, 118.0}) {
      s.block({x, y}, 30, 14, Ink::plain);
      const double lean = (x < 70.0) == (y < 85.0) ? 4.0 : -4.0;
      s.line({x - lean, y - 6}, {x + lean, y + 6}, Ink::cause);
    }
  }
  s.arrow({150, 140}, {150, 26}, Ink::believed)
      .arrow({172, 140}, {172, 58}, Ink::real)
      .span({172, 52}, {172, 28}, Ink::cause);
  s.text({188, 44}, "lost in the rollers", Ink::cause, "start")
      .text({188, 110}, "to the side", Ink::real, "start");
}

/// From above: one steered wheel ahead of two.
void tricycle(Sketch& s, Spot at, double said, double real) {
  s.way({{at.x - 30, at.y - 16}, {at.x + 30, at.y}, {at.x - 30, at.y + 16}, {at.x - 30, at.y - 16}},
        Ink::plain);
  s.block({at.x - 30, at.y - 20}, 20, 7, Ink::plain)
      .block({at.x - 30, at.y + 20}, 20, 7, Ink::plain);
  s.block({at.x + 30, at.y}, 24, 8, Ink::believed, said)
      .block({at.x + 30, at.y}, 24, 8, Ink::cause, real);
}

void steering_offset(Sketch& s) {
  tricycle(s, {70, 110}, 0, 18);
  s.arrow({130, 110}, {300, 110}, Ink::believed)
      .bent_arrow({130, 106}, {222, 82}, {286, 28}, Ink::real);
  s.text({104, 146}, "zero is not straight ahead", Ink::cause);
}

void steering_by_direction(Sketch& s) {
  tricycle(s, {60, 48}, 0, 14);
  tricycle(s, {60, 122}, 0, -14);
  s.bent_arrow({116, 46}, {210, 40}, {290, 18}, Ink::real)
      .arrow({116, 50}, {296, 50}, Ink::believed);
  s.arrow({296, 120}, {116, 120}, Ink::believed)
      .bent_arrow({290, 150}, {200, 130}, {116, 124}, Ink::real);
  s.text({250, 70}, "forwards").text({250, 108}, "backwards").text({60, 88}, "play", Ink::cause);
}

void steering_gain(Sketch& s) {
  tricycle(s, {70, 110}, 30, 44);
  for (const double angle : {15.0, 30.0, 45.0}) {
    s.line(beside({170, 140}, angle, 20), beside({170, 140}, angle, 112), Ink::believed);
    s.line(beside({170, 140}, 1.4 * angle, 20), beside({170, 140}, 1.4 * angle, 112), Ink::real);
    s.arc({170, 140}, 100, angle, 1.4 * angle, Ink::cause);
  }
  s.text({86, 52}, "the larger the angle,").text({86, 68}, "the further off", Ink::cause);
}

/// A car in a bend to the left: axles, and wheels in the ink of what they are.
void car(Sketch& s, Ink front_left, Ink front_middle, Ink rear_left, Ink rear_middle) {
  s.line({50, 52}, {50, 132}, Ink::plain).line({150, 52}, {150, 132}, Ink::plain);
  s.line({50, 92}, {150, 92}, Ink::plain);
  s.block({150, 52}, 26, 9, front_left, 38).block({150, 132}, 26, 9, Ink::plain, 20);
  s.block({50, 52}, 26, 9, rear_left).block({50, 132}, 26, 9, Ink::plain);
  if (front_middle != Ink::plain) s.block({150, 92}, 26, 9, front_middle, 28);
  if (rear_middle != Ink::plain) s.block({50, 92}, 26, 9, rear_middle);
}

void angle_beside(Sketch& s) {
  car(s, Ink::cause, Ink::believed, Ink::plain, Ink::plain);
  s.text({176, 40}, "read here", Ink::cause, "start");
  s.text({176, 96}, "believed here", Ink::believed, "start");
}

void travel_beside(Sketch& s) {
  car(s, Ink::plain, Ink::plain, Ink::cause, Ink::believed);
  s.text({50, 36}, "counted here", Ink::cause)
      .text({176, 96}, "the inner wheel", Ink::plain, "start");
  s.text({176, 112}, "goes less far", Ink::plain, "start");
}

void other_axle(Sketch& s) {
  car(s, Ink::plain, Ink::cause, Ink::plain, Ink::believed);
  s.text({176, 96}, "counted here", Ink::cause, "start");
  s.text({80, 158}, "believed here", Ink::believed);
}

constexpr EffectDrawing kMotionDrawings[] = {
    {"wheelbase", wheelbase},
    {"constant creep", constant_creep},
    {"cross-slope creep", cross_slope},
    {"centrifugal side-slip", side_slip},
    {"slope", slope},
    {"arc loss", arc_loss},
    {"spin loss", spin_loss},
    {"turn scrub", turn_scrub},
    {"turn asymmetry", turn_asymmetry},
    {"twist per spin", twist_per_spin},
    {"heading drift", heading_drift},
    {"gyro bias", gyro_bias},
    {"gyro warm-up", gyro_warm_up},
    {"gyro temperature drift", gyro_temperature},
    {"gyro scale", gyro_scale},
    {"gyro asymmetry", gyro_asymmetry},
    {"slippery patch", slippery_patch},
    {"roller slip", roller_slip},
    {"steering offset", steering_offset},
    {"steering offset by direction", steering_by_direction},
    {"steering gain", steering_gain},
    {"angle read beside the middle", angle_beside},
    {"travel read beside the middle", travel_beside},
    {"travel read at the other axle", other_axle}};

}  // namespace

std::span<const EffectDrawing> drawings_of_motion() {
  return kMotionDrawings;
}

}  // namespace trussmap::plot
