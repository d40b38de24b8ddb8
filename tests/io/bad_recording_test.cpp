// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One small recording, spoilt in one way per case; each way has its own message.
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::bad_recording_test {
namespace {

using testing::ScratchFolder;

constexpr const char* kDrive =
    "t,left,right,heading,payload_kg\n"
    "0.1,0.01,0.011,0.5,2\n"
    "0.2,0.01,0.010,,2\n"
    "0.3,0.01,0.012,0.51,2.5\n";
constexpr const char* kSightings = "t,landmark\n0,A\n0.3,B\n";

struct Spoilt {
  const char* name;
  const char* file;     // below the recording
  const char* content;  // instead of the good one; nullptr: the file is absent
  const char* message;  // what the error must say, after the folder and a slash
};

void PrintTo(const Spoilt& spoilt, std::ostream* stream) {
  *stream << spoilt.name;
}

class BadRecording : public ::testing::TestWithParam<Spoilt> {};

std::string message_of(const std::filesystem::path& folder) {
  try {
    (void)read_recording(folder);
  } catch (const InputError& error) {
    std::string text = error.what();
    const std::string prefix = folder.string() + "/";
    if (text.rfind(prefix, 0) == 0) text.erase(0, prefix.size());
    return text;
  }
  return "read without complaint";
}

TEST_P(BadRecording, IsRefusedInOneClearLine) {
  const ScratchFolder scratch;
  scratch.write("r/drive.csv", kDrive);
  scratch.write("r/sightings.csv", kSightings);
  const std::string file = std::string("r/") + GetParam().file;
  if (GetParam().content == nullptr) {
    std::filesystem::remove(scratch.path() / file);
  } else {
    scratch.write(file, GetParam().content);
  }
  EXPECT_EQ(message_of(scratch.path() / "r"), GetParam().message);
}

const Spoilt kSpoilt[] = {
    {"NoDrive", "drive.csv", nullptr, "drive.csv: is missing, a recording needs it"},
    {"NoSightings", "sightings.csv", nullptr,
     "sightings.csv: is missing, a recording without truth.csv, fixes.csv or loops.csv needs it"},
    {"FixWithoutPlace", "fixes.csv", "t,x\n0.1,0\n",
     "fixes.csv:1: column \"y\" is missing, found \"t,x\""},
    {"FixWithAHeading", "fixes.csv", "t,x,y,heading\n0.1,0,0,0\n",
     "fixes.csv:1: column \"heading\" is unknown, expected t,x,y,sd,quality"},
    {"FixThatIsText", "fixes.csv", "t,x,y\n0.1,here,0\n",
     "fixes.csv:2: column x is \"here\", expected a number"},
    {"FixFarAway", "fixes.csv", "t,x,y\n0.1,0,2e9\n",
     "fixes.csv:2: column y is \"2e9\", expected a number of at most 1e+09 in size"},
    {"FixOfNoSpread", "fixes.csv", "t,x,y,sd\n0.1,0,0,\n0.2,0,0,0\n",
     "fixes.csv:3: sd is 0, expected more than 0"},
    {"FixQualityInWords", "fixes.csv", "t,x,y,quality\n0.1,0,0,good\n",
     "fixes.csv:2: column quality is \"good\", expected a number"},
    {"FixesBackwards", "fixes.csv", "t,x,y\n0.2,0,0\n0.1,0,0\n",
     "fixes.csv:3: time runs backwards from 0.2 to 0.1, expected a later time"},
    {"FixTwice", "fixes.csv", "t,x,y\n0.2,0,0\n0.2,0,0\n",
     "fixes.csv:3: time 0.2 is repeated, expected a later time"},
    {"NoFix", "fixes.csv", "t,x,y\n", "fixes.csv:1: no fix, expected one row at least"},
    {"LoopWithoutTurn", "loops.csv", "t,t2,dx,dy\n0.1,0.2,0,0\n",
     "loops.csv:1: column \"dtheta\" is missing, found \"t,t2,dx,dy\""},
    {"LoopOfALandmark", "loops.csv", "t,t2,dx,dy,dtheta,landmark\n0.1,0.2,0,0,0,A\n",
     "loops.csv:1: column \"landmark\" is unknown, expected t,t2,dx,dy,dtheta,sd,sd_heading"},
    {"LoopThatIsText", "loops.csv", "t,t2,dx,dy,dtheta\n0.1,0.2,0,0,left\n",
     "loops.csv:2: column dtheta is \"left\", expected a number"},
    {"LoopOfNoSpread", "loops.csv", "t,t2,dx,dy,dtheta,sd\n0.1,0.2,0,0,0,-1\n",
     "loops.csv:2: sd is -1, expected more than 0"},
    {"LoopOfNoTurnSpread", "loops.csv", "t,t2,dx,dy,dtheta,sd_heading\n0.1,0.2,0,0,0,0\n",
     "loops.csv:2: sd_heading is 0, expected more than 0"},
    {"LoopBeforeTheDrive", "loops.csv", "t,t2,dx,dy,dtheta\n-1,0.2,0,0,0\n",
     "loops.csv:2: time t -1 is outside the drive, expected 0 to 0.3"},
    {"LoopAfterTheDrive", "loops.csv", "t,t2,dx,dy,dtheta\n0.1,0.4,0,0,0\n",
     "loops.csv:2: time t2 0.4 is outside the drive, expected 0 to 0.3"},
    {"LoopOntoItself", "loops.csv", "t,t2,dx,dy,dtheta\n0.1,0.1,0,0,0\n",
     "loops.csv:2: t2 is t, 0.1, expected another time"},
    {"NoLoop", "loops.csv", "t,t2,dx,dy,dtheta\n",
     "loops.csv:1: no loop, expected one row at least"},
    {"EmptyFile", "drive.csv", "", "drive.csv:1: the file is empty, expected a header row"},
    {"OnlyComments", "drive.csv", "# nothing\n\n",
     "drive.csv:1: the file is empty, expected a header row"},
    {"HeaderOnly", "drive.csv", "t,left,right\n",
     "drive.csv:1: 0 rows, expected two at least (the first interval is as long as the second)"},
    {"OneRow", "drive.csv", "t,left,right\n0.1,0,0\n",
     "drive.csv:2: 1 row, expected two at least (the first interval is as long as the second)"},
    {"MissingColumn", "drive.csv", "t,left\n0.1,0\n0.2,0\n",
     "drive.csv:1: column \"right\" is missing, found \"t,left\""},
    {"ColumnTwice", "drive.csv", "t,left,right,left\n0.1,0,0,0\n",
     "drive.csv:1: column \"left\" stands twice in the header, expected each name once"},
    {"YawRateInWords", "drive.csv", "t,left,right,yaw_rate\n0.1,0,0,\n0.2,0,0,fast\n",
     "drive.csv:3: column yaw_rate is \"fast\", expected a number"},
    {"YawRateOutOfThisWorld", "drive.csv", "t,left,right,yaw_rate\n0.1,0,0,1\n0.2,0,0,-2000\n",
     "drive.csv:3: column yaw_rate is \"-2000\", expected a number of at most 1000 in size"},
    {"ReservedCovariate", "drive.csv", "t,left,right,speed\n0.1,0,0,0\n",
     "drive.csv:1: column \"speed\" is a reserved name, expected another for a covariate"},
    {"BadCovariateName", "drive.csv", "t,left,right,pay load\n0.1,0,0,0\n",
     "drive.csv:1: column \"pay load\" cannot be a covariate, expected a letter, then letters, "
     "digits or _"},
    {"TextForNumber", "drive.csv", "t,left,right\n0.1,0,0\n0.2,fast,0\n",
     "drive.csv:3: column left is \"fast\", expected a number"},
    {"NumberWithUnit", "drive.csv", "t,left,right\n0.1,0,0\n0.2,0.1m,0\n",
     "drive.csv:3: column left is \"0.1m\", expected a number"},
    {"TwoSigns", "drive.csv", "t,left,right\n0.1,0,+-1\n",
     "drive.csv:2: column right is \"+-1\", expected a number"},
    {"Surrogate", "sightings.csv", "t,landmark\n0,\xED\xA0\x80\n",
     "sightings.csv:2: a byte that is no UTF-8 text, expected UTF-8"},
    {"NaN", "drive.csv", "t,left,right\n0.1,0,nan\n",
     "drive.csv:2: column right is \"nan\", expected a finite number"},
    {"Infinity", "drive.csv", "t,left,right\n0.1,0,-inf\n",
     "drive.csv:2: column right is \"-inf\", expected a finite number"},
    {"TravelThatOverflows", "drive.csv", "t,left,right\n0.1,0,0\n0.2,1e308,0\n",
     "drive.csv:3: column left is \"1e308\", expected a number of at most 1e+06 in size"},
    {"TimeInNanoseconds", "drive.csv", "t,left,right\n1700000000000000000,0,0\n",
     "drive.csv:2: column t is \"1700000000000000000\", expected a number of at most 1e+12 in "
     "size: it looks like nanoseconds since 1970, not seconds"},
    {"SightingsInMilliseconds", "sightings.csv", "t,landmark\n0,A\n200,B\n",
     "sightings.csv:3: time 200 is outside the drive, expected 0 to 0.3: is it in milliseconds?"},
    {"FarAwaySurvey", "survey.csv", "landmark,x,y\nA,0,-1e10\n",
     "survey.csv:2: column y is \"-1e10\", expected a number of at most 1e+09 in size"},
    {"OutOfRange", "drive.csv", "t,left,right\n0.1,0,1e999\n",
     "drive.csv:2: column right is \"1e999\", expected a number within double's range"},
    {"EmptyField", "drive.csv", "t,left,right\n0.1,,0\n",
     "drive.csv:2: column left is empty, expected a number"},
    {"EmptyCovariate", "drive.csv", "t,left,right,load\n0.1,0,0,\n",
     "drive.csv:2: column load is empty, expected a number"},
    {"TimeBackwards", "drive.csv", "t,left,right\n0.1,0,0\n0.3,0,0\n0.2,0,0\n",
     "drive.csv:4: time runs backwards from 0.3 to 0.2, expected a later time"},
    {"TimeRepeated", "drive.csv", "t,left,right\n0.1,0,0\n# a comment counts\n0.1,0,0\n",
     "drive.csv:4: time 0.1 is repeated, expected a later time"},
    {"TooFewFields", "drive.csv", "t,left,right\n0.1,0\n0.2,0,0\n",
     "drive.csv:2: 2 fields, expected 3 as in the header"},
    {"TooManyFields", "drive.csv", "t,left,right\n0.1,0,0,0\n",
     "drive.csv:2: 4 fields, expected 3 as in the header"},
    {"CutOff", "drive.csv", "t,left,right\n0.1,0,0\n0.2,0.0",
     "drive.csv:3: the file is cut off in the middle of a row, expected 3 fields"},
    {"OpenQuote", "sightings.csv", "t,landmark\n0,\"A\n0.3,B\n",
     "sightings.csv:2: a quoted field is not closed, expected a second \""},
    {"TextAfterQuote", "sightings.csv", "t,landmark\n0,\"A\"x\n",
     "sightings.csv:2: text after a closing quote, expected a comma or the line's end"},
    {"QuoteInside", "sightings.csv", "t,landmark\n0,A\"B\n",
     "sightings.csv:2: a quote within an unquoted field, expected \"...\" around it"},
    {"InvalidUtf8", "sightings.csv", "t,landmark\n0,A\n0.3,B\xFF\n",
     "sightings.csv:3: a byte that is no UTF-8 text, expected UTF-8"},
    {"NoSighting", "sightings.csv", "t,landmark\n",
     "sightings.csv:1: no sighting, expected one row at least"},
    {"UnknownColumn", "sightings.csv", "t,landmark,rnage,bearing\n0,A,,\n",
     "sightings.csv:1: column \"rnage\" is unknown, expected t,landmark,range,bearing,"
     "yaw,dx,dy"},
    {"BearingInWords", "sightings.csv", "t,landmark,bearing\n0,A,ahead\n",
     "sightings.csv:2: column bearing is \"ahead\", expected a number"},
    {"NegativeRangeAlone", "sightings.csv", "t,landmark,range\n0,A,-1\n",
     "sightings.csv:2: the range is negative, expected 0 or more"},
    {"NegativeRange", "sightings.csv", "t,landmark,range,bearing\n0,A,-1,0\n",
     "sightings.csv:2: the range is negative, expected 0 or more"},
    {"SightingAfterTheDrive", "sightings.csv", "t,landmark\n0,A\n0.4,B\n",
     "sightings.csv:3: time 0.4 is outside the drive, expected 0 to 0.3"},
    {"SightingBeforeTheDrive", "sightings.csv", "t,landmark\n-0.05,A\n",
     "sightings.csv:2: time -0.05 is outside the drive, expected 0 to 0.3"},
    {"SightingsBackwards", "sightings.csv", "t,landmark\n0.2,A\n0.1,B\n",
     "sightings.csv:3: time runs backwards from 0.2 to 0.1, expected no earlier time"},
    {"NamelessLandmark", "sightings.csv", "t,landmark\n0,\n",
     "sightings.csv:2: column landmark is empty, expected a landmark's name"},
    {"ControlCharacter", "sightings.csv", "t,landmark\n0,A\x01\n",
     "sightings.csv:2: a landmark's name holds a control character, expected printable text in "
     "UTF-8"},
    {"SurveyedTwice", "survey.csv", "landmark,x,y\nA,0,0\nA,1,0\n",
     "survey.csv:3: landmark A is surveyed twice, expected each once"},
    {"SurveySd", "survey.csv", "landmark,x,y,sd\nA,0,0,0\n",
     "survey.csv:2: sd is 0, expected more than 0"},
    {"SurveyMissingY", "survey.csv", "landmark,x\nA,0\n",
     "survey.csv:1: column \"y\" is missing, found \"landmark,x\""},
    {"EmptySurvey", "survey.csv", "landmark,x,y\n",
     "survey.csv:1: no landmark, expected one row at least"},
    {"TruthBackwards", "truth.csv", "t,x,y,heading\n0.1,0,0,0\n0.1,0,0,0\n",
     "truth.csv:3: time 0.1 is repeated, expected a later time"},
    {"EmptyTruth", "truth.csv", "t,x,y,heading\n",
     "truth.csv:1: no pose, expected one row at least"},
};

INSTANTIATE_TEST_SUITE_P(EveryWay, BadRecording, ::testing::ValuesIn(kSpoilt),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(BadRecordingFolder, AbsentOrAFile) {
  const ScratchFolder scratch;
  EXPECT_EQ(message_of(scratch.path() / "none"),
            (scratch.path() / "none").string() + ": there is no such folder, expected a recording");
  const auto file = scratch.write("file", "");
  EXPECT_EQ(message_of(file), file.string() + ": is a file, expected a recording's folder");
}

TEST(BadRecordingFolder, SightingsWithoutARowMayBeLeftOutBesideATruth) {
  const ScratchFolder scratch;
  scratch.write("r/drive.csv", kDrive);
  scratch.write("r/truth.csv", "t,x,y,heading\n0.1,0,0,0\n");
  scratch.write("r/sightings.csv", "t,landmark\n");
  EXPECT_EQ(message_of(scratch.path() / "r"),
            "sightings.csv:1: no sighting, expected one row at least; beside a truth.csv, "
            "fixes.csv or loops.csv the file may be left out");
  std::filesystem::remove(scratch.path() / "r/sightings.csv");
  EXPECT_EQ(read_recording(scratch.path() / "r").truth.size(), 1U);
}

TEST(BadRecordingFolder, EveryPrefixOfADriveIsReadOrRefusedNeverWorse) {
  const ScratchFolder scratch;
  scratch.write("r/sightings.csv", "t,landmark\n0,A\n");
  const std::string whole = kDrive;
  int read = 0;
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    scratch.write("r/drive.csv", whole.substr(0, length));
    try {
      read += read_recording(scratch.path() / "r").drive.rows() > 0 ? 1 : 0;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(read, 2);  // with and without the last line's end, and where a number is shorter
}

}  // namespace
}  // namespace trussmap::bad_recording_test
