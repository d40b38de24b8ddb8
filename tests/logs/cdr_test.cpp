// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Messages laid out by hand, from the specification.
#include "logs/cdr.hpp"

#include "logs/bag_lines.hpp"

#include <gtest/gtest.h>

namespace trussmap::cdr_test {
using namespace logs;
namespace {

using std::string_literals::operator""s;

const std::string kLittle = "\0\1\0\0"s;
const std::string kBig = "\0\0\0\0"s;
const std::string kLine = std::string(80, '=') + "\nMSG: my_msgs/";

/// Its fields as lines, or what is wrong with it.
std::string decoded(const std::string& definition, const std::string& message,
                    std::size_t elements = 100) {
  const Ros2Layout layout = parse_ros2_definition("my_msgs/msg/A", definition);
  FieldTree tree;
  try {
    decode_cdr(message, layout, elements, tree);
  } catch (const CdrError& error) {
    return error.what();
  }
  std::string lines;
  testing::add_lines(lines, tree.root(), "");
  return lines;
}

TEST(Cdr, NumbersStandAtMultiplesOfTheirSizes) {
  const std::string definition = "int8 a\nint16 b\nuint8 c\nfloat32 d\nbool e\nfloat64 f\n";
  const std::string lines =
      " a integer -2\n b integer 258\n c integer 3\n d number 3ff8000000000000\n e integer 1\n"
      " f number c000000000000000\n";
  EXPECT_EQ(decoded(definition, kLittle + "\xFE\0\x02\x01\x03\0\0\0\0\0\xC0\x3F\1\0\0\0"s +
                                    "\0\0\0\0\0\0\0\xC0"s),
            lines);
  EXPECT_EQ(decoded(definition,
                    kBig + "\xFE\0\x01\x02\x03\0\0\0\x3F\xC0\0\0\1\0\0\0"s + "\xC0\0\0\0\0\0\0\0"s),
            lines);
}

TEST(Cdr, AnEmptyListOfNumbersIsFollowedByNoGap) {
  EXPECT_EQ(decoded("float64[] a\nuint32 b\n", kLittle + "\0\0\0\0\5\0\0\0"s),
            " a list 0\n b integer 5\n");
  EXPECT_EQ(decoded("float64[] a\nuint8 b\n", kLittle + "\1\0\0\0????\0\0\0\0\0\0\xF0\x3F\5"s),
            " a list 1\n a[0] number 3ff0000000000000\n b integer 5\n");
}

TEST(Cdr, TextsHaveTheirZeroCounted) {
  EXPECT_EQ(decoded("string a\nstring b\n", kLittle + "\3\0\0\0hi\0?\1\0\0\0\0"s),
            " a text 6869\n b text \n");
  // Some senders leave the zero out, or write an empty text without it.
  EXPECT_EQ(decoded("string a\nstring b\n", kLittle + "\2\0\0\0hi??\0\0\0\0"s),
            " a text 6869\n b text \n");
}

TEST(Cdr, WideTextsAreReadWhereTheirCharactersHaveOneSize) {
  const std::string definition = "wstring a\nuint32 b\n";
  const std::string lines = " a text 61e282ac\n b integer 7\n";
  EXPECT_EQ(decoded(definition, kLittle + "\2\0\0\0a\0\xAC\x20\7\0\0\0"s), lines);
  EXPECT_EQ(decoded(definition, kLittle + "\2\0\0\0a\0\0\0\xAC\x20\0\0\7\0\0\0"s), lines);
  EXPECT_EQ(decoded(definition, kBig + "\0\0\0\2\0a\x20\xAC\0\0\0\7"s), lines);
  // U+1D11E as a pair.
  EXPECT_EQ(decoded("wstring a\n", kLittle + "\2\0\0\0\x34\xD8\x1E\xDD"s), " a text f09d849e\n");
  // "a", then 0, 0 and 5 and two bytes that fill, or 5, 0 and 0.
  EXPECT_EQ(
      decoded("wstring a\nuint8 b\nuint8 c\nuint16 d\n", kLittle + "\1\0\0\0a\0\0\0\5\0\0\0"s),
      "has wide texts whose characters may have 2 bytes or 4");
}

TEST(Cdr, AGroupWithoutFieldsHasAByte) {
  const std::string definition = "B a\nuint8 b\nB[] c\n" + kLine + "B\nuint8 X=3\n";
  EXPECT_EQ(decoded(definition, kLittle + "\0\7\0\0\2\0\0\0\0\0"s), " b integer 7\n c list 2\n");
  EXPECT_EQ(decoded("# none\n", kLittle + "\0"s), "");
  EXPECT_EQ(decoded("# none\n", kLittle), "");
}

TEST(Cdr, OfNumbersTheFirstAreKept) {
  EXPECT_EQ(decoded("uint8[] a\nint16[4] b\nB[] c\n" + kLine + "B\nint8 d\n",
                    kLittle + "\5\0\0\0\1\2\3\4\5?\1\0\2\0\3\0\4\0??\3\0\0\0\7\7\7"s, 2),
            " a list 5\n a[0] integer 1\n a[1] integer 2\n b list 4\n b[0] integer 1\n"
            " b[1] integer 2\n c list 3\n c[0].d integer 7\n c[1].d integer 7\n"
            " c[2].d integer 7\n");
}

TEST(Cdr, LengthsAreCheckedAgainstTheBytesThatAreThere) {
  const std::string most = "\xFF\xFF\xFF\xFF";
  EXPECT_EQ(decoded("float64[] a\n", kLittle + most + "????"),
            "needs 34359738360 bytes for a, 0 are left");
  EXPECT_EQ(decoded("string a\n", kLittle + most), "needs 4294967295 bytes for a, 0 are left");
  EXPECT_EQ(decoded("wstring a\n", kLittle + most), "needs 8589934590 bytes for a, 0 are left");
  EXPECT_EQ(decoded("string[] a\n", kLittle + most), "needs 1 bytes for a, 0 are left");
  EXPECT_EQ(decoded("B[] a\n" + kLine + "B\n", kLittle + most + "abc"),
            "needs 4 bytes for a, 3 are left");
  EXPECT_EQ(decoded("float64 a\n", kLittle + "1234567"), "needs 8 bytes for my_msgs/A, 7 are left");
  EXPECT_EQ(decoded("uint8 a\nfloat64 b\n", kLittle + "123456789"),
            "needs 8 bytes for b, 1 are left");
}

TEST(Cdr, BoundsAreKept) {
  EXPECT_EQ(decoded("int8[<=2] a\n", kLittle + "\3\0\0\0abc"s),
            "has 3 elements in a, expected 2 at most");
  EXPECT_EQ(decoded("string<=2 a\n", kLittle + "\4\0\0\0abc\0"s),
            "has 3 characters in a, expected 2 at most");
}

TEST(Cdr, AMessageEndsWithItsFields) {
  EXPECT_EQ(decoded("int8 a\n", kLittle + "\1???"), " a integer 1\n");
  EXPECT_EQ(decoded("int8 a\n", kLittle + "\1????"),
            "has 4 bytes after its last field, expected the fields of my_msgs/A alone");
}

TEST(Cdr, OtherEncodingsAreRefused) {
  EXPECT_EQ(decoded("int8 a\n", "\0\7\0\0\1"s),
            "is encoded in another kind of CDR (0, 7), expected plain CDR (0, 0 or 0, 1)");
  EXPECT_EQ(decoded("int8 a\n", "\0\3\0\0\1"s),
            "is encoded in another kind of CDR (0, 3), expected plain CDR (0, 0 or 0, 1)");
  EXPECT_EQ(decoded("int8 a\n", "{\"a\": 1}"),
            "is encoded in no CDR (123, 34), expected plain CDR (0, 0 or 0, 1)");
  EXPECT_EQ(decoded("int8 a\n", "\0\1"s), "has 2 bytes, expected 4 or more");
}

/// Neither 64 MiB of points nor a million groups become a tree.
TEST(Cdr, LargeMessagesCostWhatIsKept) {
  const Ros2Layout layout = parse_ros2_definition(
      "my_msgs/A", "uint8[] points\nB[] more\nuint8 last\n" + kLine + "B\nuint8 a\nuint8 b\n");
  constexpr std::size_t kPoints = std::size_t{64} << 20U;
  constexpr std::size_t kGroups = 1000000;
  std::string message = kLittle + "\0\0\0\4"s + std::string(kPoints, 'p') + "\x40\x42\x0F\0"s +
                        std::string(2 * kGroups, 'g') + "l";
  FieldTree tree;
  decode_cdr(message, layout, 10, tree);
  EXPECT_EQ(tree.root().member("points")->field().length, kPoints);
  EXPECT_EQ(tree.root().member("more")->field().length, kGroups);
  EXPECT_EQ(tree.root().member("last")->number(), 'l');
  EXPECT_LT(tree.size(), kMostMessageFields + 100);
}

}  // namespace
}  // namespace trussmap::cdr_test
