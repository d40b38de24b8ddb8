// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/effect_drawings.hpp"

#include <array>
#include <string>
#include <string_view>

namespace trussmap::plot {
namespace {

constexpr double kFloor = 140.0;

void floor_line(Sketch& s) {
  s.line({20, kFloor}, {300, kFloor}, Ink::plain);
}

void wheel_diameter_ratio(Sketch& s) {
  s.arrow({92, 120}, {292, 120}, Ink::believed)
      .bent_arrow({92, 118}, {195, 101}, {284, 50}, Ink::real);
  s.robot({60, 120}, 0, {.right = 1.5, .right_ink = Ink::cause});
  s.text({62, 160}, "larger", Ink::cause).text({250, 138}, "told to go straight", Ink::believed);
}

void travel_scale(Sketch& s) {
  s.robot({42, 85}, 0);
  for (int k = 0; k <= 4; ++k) {
    s.line({80 + 42.0 * k, 56}, {80 + 42.0 * k, 66}, Ink::believed);
    s.line({80 + 50.0 * k, 104}, {80 + 50.0 * k, 114}, Ink::real);
  }
  s.line({80, 61}, {248, 61}, Ink::believed).line({80, 109}, {280, 109}, Ink::real);
  s.span({250, 85}, {279, 85}, Ink::cause);
  s.text({165, 46}, "as the wheels say", Ink::believed).text({180, 134}, "driven", Ink::real);
}

void wheel_scale(Sketch& s) {
  floor_line(s);
  s.wheel(70, kFloor, 34, Ink::believed).wheel(70, kFloor, 44, Ink::cause);
  s.arrow({70, 152}, {230, 152}, Ink::believed).arrow({70, 162}, {292, 162}, Ink::real);
  s.wheel(250, kFloor, 44, Ink::faint);
  s.text({160, 26}, "one turn of the wheel").text({160, 42}, "goes further", Ink::real);
}

void slip_with_speed(Sketch& s) {
  for (const double y : {45.0, 120.0}) s.robot({48, y}, 0);
  s.arrow({82, 38}, {172, 38}, Ink::believed).arrow({82, 52}, {168, 52}, Ink::real);
  s.arrow({82, 113}, {290, 113}, Ink::believed).arrow({82, 127}, {236, 127}, Ink::real);
  s.span({240, 127}, {290, 127}, Ink::cause);
  s.line({8, 112}, {20, 112}, Ink::plain)
      .line({4, 120}, {20, 120}, Ink::plain)
      .line({8, 128}, {20, 128}, Ink::plain);
  s.text({200, 50}, "slow", Ink::plain, "start").text({265, 150}, "lost when fast", Ink::cause);
}

void loss_per_start(Sketch& s) {
  s.robot({40, 85}, 0);
  for (int k = 0; k < 4; ++k) {
    s.line({76 + 54.0 * k, 56}, {130 + 54.0 * k, 56}, Ink::believed)
        .dot({76 + 54.0 * k, 56}, 4, Ink::plain);
    s.line({76 + 46.0 * k, 112}, {114 + 46.0 * k, 112}, Ink::real)
        .block({118 + 46.0 * k, 112}, 8, 14, Ink::cause);
  }
  s.text({184, 42}, "four legs, as the wheels say", Ink::believed);
  s.text({175, 142}, "the same bit is lost at each start", Ink::cause);
}

void load_on_both(Sketch& s) {
  s.line({20, 130}, {300, 130}, Ink::plain);
  for (const double x : {90.0, 230.0}) {
    const double down = x > 100.0 ? 6.0 : 0.0;
    s.block({x, 86 + down}, 96, 16, Ink::faint);
    for (const double side : {-32.0, 32.0})
      s.wheel(x + side, 130, 22, down > 0.0 ? Ink::cause : Ink::plain, down > 0.0 ? 0.28 : 0.0);
  }
  s.block({230, 62}, 66, 32, Ink::plain).arrow({286, 60}, {286, 92}, Ink::cause);
  s.text({90, 152}, "empty").text({230, 152}, "loaded: smaller wheels", Ink::cause);
}

void load_on_one(Sketch& s) {
  s.line({20, 130}, {150, 130}, Ink::plain);
  s.block({85, 92}, 84, 16, Ink::faint, 5).block({58, 66}, 32, 30, Ink::plain, 5);
  s.wheel(54, 130, 20, Ink::cause, 0.4).wheel(116, 130, 20, Ink::plain);
  s.text({85, 152}, "from behind");
  s.robot({200, 122}, 0, {.left = 0.7, .left_ink = Ink::cause});
  s.arrow({230, 122}, {308, 122}, Ink::believed)
      .bent_arrow({230, 120}, {272, 108}, {304, 72}, Ink::real);
}

void tyre_drift(Sketch& s) {
  floor_line(s);
  const std::array<double, 4> radii{36, 33, 30, 27};
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double x = 60 + 68.0 * static_cast<double>(k);
    s.wheel(x, kFloor, 36, Ink::believed).wheel(x, kFloor, radii[k], Ink::cause);
  }
  s.arrow({40, 40}, {290, 40}, Ink::plain).text({160, 30}, "time, wear, warmth");
}

void teeth(Sketch& s, double x, double y) {
  s.gear({x, y - 26}, 32, Ink::plain, 0).gear({x, y + 34}, 32, Ink::cause, 26);
  s.text({x + 44, y + 8}, "play", Ink::cause, "start");
}

void backlash(Sketch& s, std::string_view part) {
  const bool left = part != "right";
  const bool right = part != "left";
  s.robot(
      {70, 85}, 90,
      {.left_ink = left ? Ink::cause : Ink::plain, .right_ink = right ? Ink::cause : Ink::plain});
  if (left) s.span({34, 60}, {34, 110}, Ink::cause);
  if (right) s.span({106, 60}, {106, 110}, Ink::cause);
  s.text({70, 140}, "to and fro");
  teeth(s, 212, 80);
}

void backlash_twist(Sketch& s) {
  s.robot({86, 96}, 90).robot({86, 96}, 115, {.body = Ink::believed});
  s.robot({86, 96}, 65, {.body = Ink::believed});
  s.arc_arrow({86, 96}, 56, 90, 122, Ink::cause).arc_arrow({86, 96}, 56, 90, 58, Ink::cause);
  teeth(s, 222, 80);
}

/// The signal of an encoder, two of its ticks gone.
void missed_ticks(Sketch& s, std::string_view part) {
  const bool left = part == "left";
  const double side = left ? -1.0 : 1.0;
  s.robot(
      {58, 118}, 0,
      {.left_ink = left ? Ink::cause : Ink::plain, .right_ink = left ? Ink::plain : Ink::cause});
  s.arrow({92, 118}, {250, 118}, Ink::real)
      .bent_arrow({92, 118 + side * 2}, {180, 118 + side * 12}, {246, 118 + side * 38},
                  Ink::believed);
  for (int k = 0; k < 8; ++k) {
    const double x = 40 + 30.0 * k;
    const bool lost = k == 3 || k == 6;
    s.way({{x, 50}, {x, 26}, {x + 15, 26}, {x + 15, 50}}, lost ? Ink::cause : Ink::plain);
    s.line({x + 15, 50}, {x + 30, 50}, Ink::plain);
    if (lost)
      s.line({x - 3, 56}, {x + 18, 20}, Ink::cause).line({x - 3, 20}, {x + 18, 56}, Ink::cause);
  }
  s.text({286, 42}, left ? "left" : "right", Ink::cause).text({286, 122}, "real", Ink::real);
}

void sampling_skew(Sketch& s) {
  for (const double y : {60.0, 110.0}) s.line({70, y}, {300, y}, Ink::plain);
  for (int k = 0; k < 4; ++k) {
    const double x = 90 + 54.0 * k;
    s.dot({x, 60}, 6, Ink::real).dot({x + 18, 110}, 6, Ink::cause);
    s.line({x, 66}, {x, 124}, Ink::believed);
  }
  s.span({91, 128}, {107, 128}, Ink::cause);
  s.text({58, 64}, "left", Ink::plain, "end").text({58, 114}, "right", Ink::plain, "end");
  s.text({185, 36}, "when each wheel is read").text({112, 152}, "later", Ink::cause);
}

/// The part is its number.
void radius_of_wheel(Sketch& s, std::string_view part) {
  const int which = part.empty() ? 0 : part.front() - '1';
  s.block({110, 88}, 112, 70, Ink::faint);
  const std::array<Spot, 6> places{
      {{66, 44}, {154, 44}, {66, 132}, {154, 132}, {110, 44}, {110, 132}}};
  for (int k = 0; k < 6; ++k) {
    const Spot at = places[static_cast<std::size_t>(k)];
    const bool it = k == which;
    s.block(at, it ? 38 : 26, it ? 20 : 14, it ? Ink::cause : Ink::plain);
  }
  const Spot at = places.at(static_cast<std::size_t>(which));
  s.text({at.x, at.y < 80 ? at.y - 16 : at.y + 26}, "wheel " + std::string(part), Ink::cause);
  s.wheel(250, 130, 30, Ink::believed).wheel(250, 130, 38, Ink::cause);
  s.line({200, 130}, {300, 130}, Ink::plain).text({250, 152}, "its radius", Ink::cause);
}

constexpr EffectDrawing kWheelDrawings[] = {
    {"wheel diameter ratio", wheel_diameter_ratio},
    {"travel scale", travel_scale},
    {"wheel scale", wheel_scale},
    {"slip with speed", slip_with_speed},
    {"loss per start", loss_per_start},
    {"load on both wheels", load_on_both},
    {"load on one wheel", load_on_one},
    {"tyre drift", tyre_drift},
    {.name = "backlash", .draw_part = backlash},
    {"backlash twist", backlash_twist},
    {.name = "missed ticks", .draw_part = missed_ticks},
    {"sampling skew", sampling_skew},
    {.name = "radius of a wheel", .draw_part = radius_of_wheel}};

}  // namespace

std::span<const EffectDrawing> drawings_of_wheels() {
  return kWheelDrawings;
}

}  // namespace trussmap::plot
