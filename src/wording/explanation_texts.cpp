// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "wording/explanation_texts.hpp"

#include <algorithm>
#include <iterator>

namespace trussmap {
namespace {

constexpr ExplanationText kTexts[] = {
    {"wheel diameter ratio",
     "The larger wheel takes its side further at every turn of the wheels: told to go straight, "
     "the robot bends towards the smaller wheel.",
     "Measure how far each wheel rolls in ten turns under the usual load; compare tread and "
     "pressure.",
     "A long straight line, there and back; then a square in both directions."},
    {"wheelbase", "Every turn comes out too large or too small by the same share, to both sides.",
     "Measure between the points where the wheels touch the floor, not between their hubs.",
     "Ten full turns on the spot each way, from a mark on the floor and back to it."},
    {"travel scale",
     "Every drive is longer or shorter than said by the same share, turns are right.",
     "Check the distance per tick, the gear ratio, and the tyres under load.",
     "A taped straight line of ten metres or more, at the usual speed."},
    {"wheel scale",
     "Drives and turns alike are larger or smaller than said by the same share: both wheels have "
     "another size.",
     "Measure how far the wheels roll in ten turns under the usual load.",
     "A taped straight line, and ten full turns on the spot."},
    {"sighting delay",
     "What the sensor saw is put down where the robot was later: landmarks shift along the "
     "direction of travel, the more the faster the robot.",
     "Compare the clocks of sensor and odometry, and when each message is stamped.",
     "Past the same landmark at two clearly different speeds and in both directions; then seen at "
     "rest."},
    {"truth heading",
     "The tracker's headings are all turned by the same angle against the robot's; its positions "
     "are right.",
     "Check how the tracker's body was defined: which way its x axis points on the robot.",
     "A long straight line: the path's direction is the robot's true heading."},
    {"antenna ahead of the axle",
     "Fixes are of a point ahead of the axle (or behind it): when the robot turns on the spot they "
     "go round a circle.",
     "Measure from the axle to the antenna's phase centre, along the robot.",
     "Full turns on the spot: the circle's radius is how far off the antenna is."},
    {"antenna beside the axle",
     "Fixes are of a point to one side: lines there and back lie apart by twice its distance.",
     "Measure from the robot's middle line to the antenna, across.",
     "The same straight line there and back; full turns on the spot."},
    {"fix delay",
     "Each fix is of where the robot was a moment ago: it lags behind along the track, the more "
     "the faster the robot.",
     "Compare the receiver's clock with the odometry's, and when its messages are stamped.",
     "The same line in both directions and at two speeds, with stops."},
    {"constant creep",
     "The robot moves a little sideways as it drives, always to the same side: it arrives beside "
     "where it points.",
     "Look for wheels that are not parallel (toe-in), and at how the heading sensor is mounted.",
     "A long straight line, there and back, along a taut string."},
    {"cross-slope creep",
     "A sloping floor pulls the robot downhill: to its left on one heading, to its right on the "
     "opposite one.",
     "Put a level on the floor, on several headings.",
     "The same line along the slope in both directions, then across it."},
    {"centrifugal side-slip",
     "In bends the tyres give outwards, the more the faster and the tighter the bend.",
     "Look for soft or narrow tyres, a high load, and a smooth or dusty floor.",
     "The same circle slowly and fast, to both sides.", -1,
     "In bends the robot comes out further inwards than it says, the more the faster and "
     "the tighter the bend. Tyres give outwards, so it is no slip of theirs: headings may "
     "be stamped late, or the point that is tracked may lie off the axle."},
    {"slope",
     "Wheels slip while they push uphill and run on downhill: distances depend on the heading.",
     "Put a level on the floor; compare the motors' currents up and down.",
     "The same line up and down several times, then across the slope."},
    {"slip with speed", "The faster the robot, the more of its wheels' turning is lost in slip.",
     "Look at the tyres' tread, at dust on the floor, and at the load on the driven wheels.",
     "One straight line at three clearly different speeds.", -1,
     "The faster the robot, the further it goes than its wheels say. Slip loses way, so it "
     "is none: tyres may grow with speed, ticks of both wheels may be lost, or a speed may "
     "be read from a filter that lags."},
    {"loss per start",
     "At every start the wheels slip before they grip: each start loses the same bit of way, "
     "however long the leg.",
     "Watch the wheels at a start; compare the acceleration with what the floor holds.",
     "One line driven in one go, then the same with many stops.", -1,
     "Each start wins the same bit of way, however long the leg: the robot moves before "
     "its wheels count. It may roll while the encoders wake, or be pushed by a load that "
     "swings."},
    {"arc loss", "In arcs the wheels scrub: for every angle turned while driving some way is lost.",
     "Look for castors that drag, and tyres with wide treads.",
     "The same distance straight, in wide arcs and in tight ones.", -1,
     "In arcs the robot goes further than its wheels say, with every angle turned. "
     "Scrubbing loses way, so it is none: the point that is tracked may lie off the axle, "
     "or the wheels may slip outwards in bends."},
    {"spin loss",
     "The robot turns about a point that is not under its axle's middle: each turn on the spot "
     "moves it.",
     "Mark the floor under the axle's middle before and after a full turn; look at castors and "
     "load.",
     "Half turns and full turns on the spot, each way, many of them."},
    {"turn scrub",
     "The faster it turns, the more the tyres scrub: fast turns come out smaller than slow ones.",
     "Look for wide or soft tyres, and castors that resist.",
     "Full turns on the spot at three clearly different rates.", -1,
     "The faster it turns, the further it turns than its wheels say. Scrub makes turns "
     "smaller, so it is none: the robot may swing on when a fast turn ends, or ticks may "
     "be lost."},
    {"turn asymmetry", "Turns to one side come out larger, to the other side smaller.",
     "Look for a castor that sticks, a load to one side, or unequal tyre pressure.",
     "Ten full turns to the left, then ten to the right, at the same rate."},
    {"twist per spin",
     "When a turn on the spot begins, the castors swing round and kick the robot: the same twist "
     "each time, however large the turn.",
     "Watch the castors at the start of a turn; look for ones that stick.",
     "One turn by 360\u00b0, then the same in twelve turns of 30\u00b0."},
    {"load on both wheels",
     "The larger {} is, the flatter the tyres and the smaller both wheels: distances are "
     "overstated under load.",
     "Measure the axle's height without and with the load; check the pressure.",
     "The same line empty, half loaded and fully loaded.", -1,
     "The larger {} is, the larger both wheels seem. Tyres under load grow flatter, so "
     "look for what else goes with {}: ticks that are lost, wheels that skid on, warmth "
     "that raises the pressure."},
    {"load on one wheel",
     "The larger {} is, the flatter one tyre: the robot bends to its side under load.",
     "Look at where the load lies; measure each side's height without and with it.",
     "A straight line with the load in the middle, then to the left, then to the right.", -1,
     "The larger {} is, the larger one wheel seems. A tyre under load grows flatter, so "
     "look for what else goes with {} on that side: ticks that are lost, or the other "
     "wheel that carries the load."},
    {"tyre drift",
     "The wheels' size changes with {}: distances are right at first and wrong later.",
     "Check tread, pressure and warmth of the tyres before and after a drive.",
     "The same short line at the start, in the middle and at the end, with rests between."},
    {"backlash",
     "When a wheel changes direction its gear first takes up its play: ticks are counted while the "
     "robot does not move.",
     "Hold the motor and rock the wheel by hand: how far does it move freely?",
     "Many short moves to and fro, against as long a way in one direction."},
    {"backlash of the left wheel",
     "When the left wheel changes direction it first takes up its gear's play: some way is counted "
     "and not driven.",
     "Hold the left motor and rock its wheel by hand; compare with the right one.",
     "Many short moves to and fro, then many turns to and fro."},
    {"backlash of the right wheel",
     "When the right wheel changes direction it first takes up its gear's play: some way is "
     "counted and not driven.",
     "Hold the right motor and rock its wheel by hand; compare with the left one.",
     "Many short moves to and fro, then many turns to and fro."},
    {"backlash twist",
     "At each change of direction the robot swings a little before both gears bite again.",
     "Hold both motors and twist the robot by hand: how far does it turn?",
     "Many short turns left and right, against as large a turn to one side."},
    {"missed ticks",
     "Above some speed the left encoder loses ticks: the robot thinks that it bends left although "
     "it drives straight.",
     "Look at the left encoder's signal, cable and counter at full speed.",
     "A straight line at speeds below and above the threshold, there and back.", 1,
     "Above some speed the left encoder counts too many ticks: the robot thinks that it "
     "bends right although it drives straight. Look for interference that is counted, and "
     "for a left wheel that spins."},
    {"missed ticks of the right wheel",
     "Above some speed the right encoder loses ticks: the robot thinks that it bends right "
     "although it drives straight.",
     "Look at the right encoder's signal, cable and counter at full speed.",
     "A straight line at speeds below and above the threshold, there and back.", 1,
     "Above some speed the right encoder counts too many ticks: the robot thinks that it "
     "bends left although it drives straight. Look for interference that is counted, and "
     "for a right wheel that spins."},
    {"sampling skew",
     "One wheel is read a moment after the other: whenever the robot speeds up or brakes, a turn "
     "is seen that was none.",
     "Check in the firmware when each counter is latched.",
     "Straight lines with gentle and with hard starts and stops."},
    {"heading drift", "The heading turns with time by itself, standing or driving.",
     "Look at what the heading comes from: a gyroscope with an offset, or one that warms up.",
     "Stand still for a minute, several times, between drives."},
    {"gyro bias",
     "The gyro reads a slow turn even at rest: the heading runs away in proportion to time.",
     "Log the gyro for a minute at rest, before and after a drive.",
     "Rests of a minute between drives; the same tour slowly and fast."},
    {"gyro warm-up", "The gyro's reading at rest changes with the time since it was switched on.",
     "Log the gyro at rest for half an hour from a cold start.",
     "Tours at once after switching on, and again when warm, with rests between."},
    {"gyro temperature drift", "The gyro's reading at rest goes with {}.",
     "Log the gyro at rest while it warms up and cools down.",
     "Rests of a minute at clearly different temperatures."},
    {"gyro scale", "Every turn that the gyro reads is too large or too small by the same share.",
     "Check the gyro's range and scale, and that it sits level.",
     "Ten full turns each way from a mark on the floor and back to it."},
    {"gyro asymmetry", "The gyro reads turns to one side larger than turns to the other.",
     "Turn it by hand a full turn each way on a table and compare.",
     "Ten full turns to the left, then ten to the right."},
    {"compass offset", "Every heading is off by the same angle: the whole map is turned.",
     "Check how the compass is mounted, and the declination of the site.",
     "A surveyed straight line: its direction against what the compass reads."},
    {"hard iron",
     "A magnet or steel that turns with the robot pulls the needle: most on two opposite headings, "
     "in opposite senses, and not at all between them.",
     "Look for magnets, motors, loudspeakers and steel within half a metre of the compass.",
     "A slow full turn on the spot, each way: the error goes round once."},
    {"soft iron",
     "Soft iron on the robot bends the earth's field: the error goes round twice in one turn.",
     "Look for iron brackets, plates and screws near the compass.",
     "A slow full turn on the spot, stopping at eight headings."},
    {"body tilt",
     "The compass leans with the body and sees part of the field's dip: an error that goes round "
     "once in a turn, and changes with the load.",
     "Put a level on the compass, empty and loaded.",
     "A full turn on the spot empty, then the same loaded."},
    {"compass lag",
     "The compass is read late (or early): while the robot turns its heading trails behind.",
     "Compare the time stamps of compass and wheels; look for a filter in the compass.",
     "Full turns on the spot each way at two clearly different rates."},
    {"motor current",
     "The motors' current makes a field of its own: the faster the robot, the more the needle "
     "turns, by heading.",
     "Look at how the motor cables run, and how far they are from the compass.",
     "Read the compass at rest, then with the wheels lifted and driven."},
    {"local magnetic anomaly",
     "Steel or cables at one place pull the needle there, and nowhere else.",
     "Look under the floor and at the walls there: beams, cables, machines, doors.",
     "Over the place on several headings, and past it at some distance."},
    {"compass disturbance", "The compass is off while {} is on, in proportion to it.",
     "Switch it on and off at rest and watch the compass.",
     "The same tour with it off and with it on."},
    {"slippery patch", "At one place the wheels slip: distances driven across it are overstated.",
     "Look at the floor there: water, dust, polish, a mat.",
     "Across the place and round it, several times.", -1,
     "At one place the robot goes further than its wheels say: they skid, or count "
     "nothing, while it rolls on. Slip of driven wheels would lose way."},
    {"lever arm",
     "The sensor sits ahead of where it is believed (or behind): landmarks shift towards where the "
     "robot points.",
     "Measure from the axle to the sensor, along the robot.",
     "Stand at one landmark on four headings."},
    {"lever arm to the left",
     "The sensor sits to one side of where it is believed: landmarks shift to that side of the "
     "robot.",
     "Measure from the robot's middle line to the sensor, across.",
     "Stand at one landmark on four headings."},
    {"range bias", "Every range is too long or too short by the same length, near or far.",
     "Check the sensor's zero: where on its body do ranges begin?",
     "Range a landmark from one, two and five measured metres."},
    {"range scale",
     "Every range is too long or too short by the same share: far landmarks are off by more.",
     "Check the sensor's scale, its units and its temperature.",
     "Range a landmark from one, five and ten measured metres."},
    {"bearing offset",
     "Every bearing is off by the same angle: landmarks lie turned about the robot.",
     "Look at how the sensor is mounted: is its zero straight ahead?",
     "Drive straight at a landmark, then past it on both sides."},
    {"yaw offset", "Landmarks seem turned by the same angle, wherever they are seen from.",
     "Look at how the camera is mounted: is it turned about the vertical?",
     "See one marker from several sides, at rest."},
    {"roller slip",
     "The rollers slip as the robot moves sideways: it gets less far to the side than its wheels "
     "say.",
     "Look at the rollers: worn, dusty, stiff?",
     "A measured way to the side, both ways, then the same ahead.", -1,
     "The robot gets further to the side than its wheels say. Slip would lose way: the "
     "wheels may be larger than believed, or the floor may slope."},
    {"steering offset",
     "The wheel points a little to one side when the angle reads zero: the robot bends when it is "
     "told to go straight.",
     "Set the angle to zero and sight along the wheel.",
     "A long straight line with the angle at zero, there and back."},
    {"steering offset by direction",
     "Play in the steering lets the wheel stand otherwise when it is pushed than when it is "
     "pulled.",
     "Rock the steered wheel by hand: how far does it move freely?",
     "The same line forwards and backwards with the angle at zero."},
    {"steering gain",
     "The wheel turns further or less far than the angle says, by the same share: tight bends are "
     "off by more.",
     "Set the angle to its ends and measure them at the wheel.",
     "Full circles at three steering angles, to both sides."},
};

}  // namespace

const ExplanationText* explanation_text(std::string_view name) {
  const auto* const known =
      std::find_if(std::begin(kTexts), std::end(kTexts),
                   [name](const ExplanationText& one) { return one.name == name; });
  return known == std::end(kTexts) ? nullptr : known;
}

}  // namespace trussmap
