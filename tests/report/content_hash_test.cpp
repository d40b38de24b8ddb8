// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Hashes of a content security policy, against the standard's examples and Python's hashlib.
#include "report/content_hash.hpp"

#include <map>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::content_hash_test {
namespace {

TEST(ContentHash, IsThatOfTheStandardsExamples) {
  // FIPS 180-4: ba7816bf 8f01cfea ... and 248d6a61 d20638b8 ...
  EXPECT_EQ(report::content_hash("abc"), "sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
  EXPECT_EQ(report::content_hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "sha256-JI1qYdIGOLjlwCaTDD5gOaM85Flk/yFn9uzt1BnbBsE=");
}

TEST(ContentHash, IsThatOfHashlibAtEveryEdgeOfABlock) {
  const std::map<std::size_t, std::string> expected = {
      {0, "47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU="},
      {1, "ypeBEsobvcr6wjGzmiPcTaeG7/gUfE5yuYB3ha/uSLs="},
      {55, "n0OQ+NMMLdkuyfCVtl4rmumwqSWlJY4kHJ8ekQ9zQxg="},
      {56, "s1Q5pKxvCUi21vnjxq8PX1kM4g8b3nCQ73lwaG7Gc4o="},
      {63, "fT50oF19sVvOStnsBljqmOPwbu7PFrTG//LaRX3cLzQ="},
      {64, "/+BU/nrgy23GXDr5th1SCfQ5hR20PQulmXM33xVGaOs="},
      {65, "Y1NhxIu56rFBmOduqKt/GkFoXWrWKqkUbTAdTxfrCuA="},
      {119, "MeulHDE6XAgiat8Y1KNZz9/Y0ugWsT9K+VL36mWE3Ps="},
      {120, "Lz0zVDLHC1gK8Ojhs2dKfAINaDql9zqq7f3FWvkEwhw="},
      {1000000, "zcduXJkU+5KBocfihNc+Z/GAmkiklyAOBG05zMcRLNA="},
  };
  for (const auto& [length, hash] : expected) {
    EXPECT_EQ(report::content_hash(std::string(length, 'a')), "sha256-" + hash) << length;
  }
}

}  // namespace
}  // namespace trussmap::content_hash_test
