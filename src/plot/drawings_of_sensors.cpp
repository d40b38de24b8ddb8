// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/effect_drawings.hpp"

namespace trussmap::plot {
namespace {

void sighting_delay(Sketch& s) {
  s.robot({70, 118}, 0)
      .robot({210, 118}, 0, {.body = Ink::believed})
      .arrow({104, 118}, {174, 118}, Ink::plain);
  s.landmark({70, 36}, Ink::real).line({70, 98}, {70, 48}, Ink::real);
  s.landmark({210, 36}, Ink::believed).line({210, 98}, {210, 48}, Ink::believed);
  s.clock({140, 70}, Ink::cause).text({140, 102}, "stamped late", Ink::cause);
  s.text({70, 160}, "seen here", Ink::real).text({210, 160}, "put down here", Ink::believed);
}

void antenna_mast(Sketch& s, Spot at, Ink ink) {
  s.dot(at, 6, ink).arc({at.x, at.y}, 12, 40, 140, ink);
}

void antenna_ahead(Sketch& s) {
  s.robot({110, 90}, 0).circle({110, 90}, 44, Ink::believed);
  antenna_mast(s, {154, 90}, Ink::cause);
  s.span({112, 122}, {153, 122}, Ink::cause)
      .line({154, 96}, {154, 128}, Ink::faint)
      .arc_arrow({110, 90}, 54, 130, 220, Ink::plain);
  s.text({132, 146}, "ahead", Ink::cause)
      .text({180, 82}, "turning on the spot,", Ink::plain, "start");
  s.text({180, 98}, "fixes go in a circle", Ink::believed, "start");
}

void antenna_beside(Sketch& s) {
  s.line({20, 92}, {300, 92}, Ink::real)
      .line({20, 62}, {300, 62}, Ink::believed)
      .line({20, 122}, {300, 122}, Ink::believed);
  s.robot({70, 92}, 0).robot({270, 92}, 180);
  antenna_mast(s, {70, 62}, Ink::cause);
  antenna_mast(s, {270, 122}, Ink::cause);
  s.span({150, 65}, {150, 119}, Ink::cause);
  s.text({70, 34}, "there")
      .text({270, 150}, "and back")
      .text({158, 84}, "twice", Ink::cause, "start")
      .text({158, 110}, "its distance", Ink::cause, "start");
}

void fix_delay(Sketch& s) {
  s.robot({230, 112}, 0)
      .robot({100, 112}, 0, {.body = Ink::believed})
      .arrow({40, 140}, {290, 140}, Ink::plain);
  s.line({94, 106}, {106, 118}, Ink::cause).line({94, 118}, {106, 106}, Ink::cause);
  s.block({160, 30}, 22, 12, Ink::plain)
      .block({138, 30}, 14, 8, Ink::faint)
      .block({182, 30}, 14, 8, Ink::faint);
  s.line({154, 40}, {104, 102}, Ink::believed).clock({160, 74}, Ink::cause);
  s.text({100, 160}, "the fix", Ink::cause).text({240, 160}, "the robot by now");
}

void lever_arm(Sketch& s) {
  s.robot({90, 96}, 0)
      .block({80, 96}, 12, 12, Ink::believed)
      .block({126, 96}, 12, 12, Ink::cause)
      .span({80, 126}, {126, 126}, Ink::cause);
  s.line({132, 94}, {240, 50}, Ink::real).landmark({248, 46}, Ink::real);
  s.line({86, 94}, {194, 50}, Ink::believed).landmark({202, 46}, Ink::believed);
  s.text({104, 148}, "further ahead", Ink::cause)
      .text({202, 22}, "where it is put down", Ink::believed);
}

void lever_left(Sketch& s) {
  s.robot({90, 104}, 0)
      .block({92, 104}, 12, 12, Ink::believed)
      .block({92, 62}, 12, 12, Ink::cause)
      .span({58, 62}, {58, 104}, Ink::cause);
  s.line({98, 60}, {232, 40}, Ink::real).landmark({242, 38}, Ink::real);
  s.line({98, 102}, {232, 82}, Ink::believed).landmark({242, 80}, Ink::believed);
  s.text({92, 46}, "to the left", Ink::cause)
      .text({244, 112}, "where it is put down", Ink::believed);
}

/// Rays to a near and to a far landmark, read too long by so much each.
void ranges(Sketch& s, double near, double far) {
  s.robot({48, 85}, 0).block({48, 85}, 12, 12, Ink::plain);
  s.landmark({140, 44})
      .line({54, 82}, {130, 48}, Ink::real)
      .line({140, 44}, beside({140, 44}, 24, near), Ink::cause);
  s.landmark({236, 126})
      .line({54, 87}, {226, 124}, Ink::real)
      .line({236, 126}, beside({236, 126}, -12, far), Ink::cause);
}

void range_bias(Sketch& s) {
  ranges(s, 26, 26);
  s.text({176, 26}, "too long by", Ink::cause, "start")
      .text({176, 42}, "the same length", Ink::cause, "start");
  s.text({110, 132}, "near or far");
}

void range_scale(Sketch& s) {
  ranges(s, 14, 56);
  s.text({166, 26}, "near: a little too long", Ink::cause, "start");
  s.text({250, 156}, "far: much too long", Ink::cause);
}

void bearing_offset(Sketch& s) {
  s.robot({60, 92}, 0).block({66, 92}, 12, 12, Ink::cause, 14);
  for (const double a : {28.0, -14.0}) {
    s.landmark(beside({66, 92}, a, 150), Ink::real)
        .line(beside({66, 92}, a, 14), beside({66, 92}, a, 138), Ink::real);
    s.line(beside({66, 92}, a + 14, 14), beside({66, 92}, a + 14, 150), Ink::believed)
        .arc({66, 92}, 92, a, a + 14, Ink::cause);
  }
  s.text({76, 140}, "mounted askew", Ink::cause).text({258, 92}, "all turned alike", Ink::believed);
}

void yaw_offset(Sketch& s) {
  s.robot({50, 100}, 0).block({66, 100}, 14, 10, Ink::cause, 20);
  for (const Spot at : {Spot{170, 56}, Spot{262, 110}}) {
    s.block(at, 26, 26, Ink::faint);
    s.axes(at, 40, 0, Ink::real).axes(at, 40, 20, Ink::believed);
  }
  s.line({76, 96}, {154, 62}, Ink::plain).line({76, 102}, {246, 108}, Ink::plain);
  s.text({60, 146}, "a turned camera", Ink::cause)
      .text({216, 152}, "turns every landmark", Ink::believed);
}

constexpr EffectDrawing kSensorDrawings[] = {{"sighting delay", sighting_delay},
                                             {"antenna ahead of the axle", antenna_ahead},
                                             {"antenna beside the axle", antenna_beside},
                                             {"fix delay", fix_delay},
                                             {"lever arm", lever_arm},
                                             {"lever arm to the left", lever_left},
                                             {"range bias", range_bias},
                                             {"range scale", range_scale},
                                             {"bearing offset", bearing_offset},
                                             {"yaw offset", yaw_offset}};

}  // namespace

std::span<const EffectDrawing> drawings_of_sensors() {
  return kSensorDrawings;
}

}  // namespace trussmap::plot
