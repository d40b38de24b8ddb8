// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A MATLAB file written by scipy.io.savemat (SciPy 1.10, do_compression=True) of
//   t       0.1, 0.2, ... 0.6
//   left    0.01, 0.02, ... 0.06
//   right   1, 2, ... 6, as int16
//   pose    6 x 2: t, 2 t
//   odo     a structure: t = 0, 0.2, 0.4, 0.6; v = 1, 2, 3, 4; pose.x = 5, 6, 7, 8
//   scan    three structures: t = 0.1, 0.2, 0.3; r = 1.5, 2.5, 3.5
//   name (a text), gain (3), z (two complex numbers)
#include "logs/mat_file.hpp"

#include "log_messages.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/write_files.hpp"

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::mat_file_test {
using namespace logs;
namespace {

using testing::messages_of;
using testing::ScratchFolder;
namespace fs = std::filesystem;

constexpr const char* kBySciPy =
    "4d41544c414220352e30204d41542d66696c6520506c6174666f726d3a20706f7369782c2043726561746564"
    "206f6e3a2053756e204e6f762032392031363a31393a32322032303236000000000000000000000000000000"
    "0000000000000000000000000000000000000000000000000000000000000000000000000001494d0f000000"
    "3e000000789ce36360604800623620e680d220c00ae53342c51881b004487302b10110cf9a09023bed21f449"
    "7b136310b80ce5dfb48798f2002afed81e00888914dc0f00000048000000789ce36360604800623620e680d2"
    "20c00ae53342c5181958187252d34a38816c0320ae1659e7feb0aac51e424fb1df21d7fa3a70c73c287f89fd"
    "ac9920b0122abece1e00df5f1a7d0f00000034000000789ce3636060f000623620e600622e06086085f219a1"
    "728c50b1a2ccf48c1220cd0cc43c607126209b0528c706d6070066a902cb0f0000004e000000789ce3636060"
    "9800c46c40cc01a541801589cf04c48c0c2c0c05f9c5a99c40760210cf9a09023bed21f4497b136310b80ce5"
    "dfb48798f2002afe18ae0e268f2afe12aafe0354fcb33d0058f12a790f0000002c000000789ce3636060b000"
    "623620e600621606086085f219a16c46a04c5e626eaa00945f949f945f02a40143da044d0f00000026000000"
    "789ce3636060b000623620e680d220c00ae533c2310b437a62661e27541c02381c0036b302670f0000003400"
    "0000789ce36360608800623620e600d120020858a17c46206602d38c0c55409a1388051860e0833d84e67040"
    "156770803100839502f80f00000086000000789ce363606098c0c8c0c006a439809889010258a17c46386666"
    "c84fc9078ab380e54062fc405c02525c06220af28b531918f880ac000684796c58cc6381d220c009c40a0c08"
    "306b26089cb487d037ed4d8c41e0b13d65e67eb087321c20140794167000993b818118ffc3c459c06a188164"
    "0503a5fe1581ba43024acb4069050700c41517240f0000005f000000789ce3636060d8c1c8c0c006a4398098"
    "89010258a17ca0140333986661284e4ecc6305d24c507e094311031f906dc180d0cf86453f0c830027547cd6"
    "4c10d8694fae7e08f841b67e88fd2729b49fc5815cfdc660709942fb791c004c7013a4";

std::string bytes_of_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t k = 0; k + 1 < hex.size(); k += 2) {
    bytes.push_back(static_cast<char>(std::stoi(std::string(hex.substr(k, 2)), nullptr, 16)));
  }
  return bytes;
}

fs::path written(const ScratchFolder& scratch, const std::string& bytes = bytes_of_hex(kBySciPy)) {
  const fs::path file = scratch.path() / "run.mat";
  write_file(file, bytes);
  return file;
}

std::map<std::string, std::vector<double>> columns_of(const MatTable& table) {
  std::map<std::string, std::vector<double>> columns;
  for (const MatColumn& one : table.columns) columns[one.name] = one.values;
  return columns;
}

TEST(MatFile, EachLengthAndStructureIsATable) {
  const ScratchFolder scratch;
  const MatFile read = read_mat_file(written(scratch));
  std::map<std::string, std::map<std::string, std::vector<double>>> tables;
  for (const MatTable& one : read.tables) tables[one.name] = columns_of(one);
  ASSERT_EQ(tables.size(), 3U);
  const auto& loose = tables.at("6 rows");
  ASSERT_EQ(loose.size(), 5U);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto n = static_cast<double>(k + 1);
    EXPECT_DOUBLE_EQ(loose.at("t")[k], 0.1 * n);
    EXPECT_DOUBLE_EQ(loose.at("left")[k], 0.01 * n);
    EXPECT_DOUBLE_EQ(loose.at("right")[k], n);
    EXPECT_DOUBLE_EQ(loose.at("pose(:,1)")[k], 0.1 * n);
    EXPECT_DOUBLE_EQ(loose.at("pose(:,2)")[k], 0.2 * n);
  }
  const auto& odo = tables.at("odo");
  ASSERT_EQ(odo.size(), 3U);
  EXPECT_EQ(odo.at("v"), (std::vector<double>{1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(odo.at("pose.x"), (std::vector<double>{5.0, 6.0, 7.0, 8.0}));
  EXPECT_EQ(tables.at("scan").at("r"), (std::vector<double>{1.5, 2.5, 3.5}));
  std::uint64_t passed_over = 0;
  for (const PassedOver& one : read.passed_over) passed_over += one.number;
  EXPECT_EQ(passed_over, 3U);
}

TEST(MatFile, ATableIsALogOfItsRows) {
  const ScratchFolder scratch;
  const fs::path file = written(scratch);
  EXPECT_TRUE(is_mat_log(file));
  EXPECT_TRUE(is_mat_log(file / "odo"));
  EXPECT_FALSE(is_mat_log(scratch.path() / "other.mat" / "odo"));
  const auto found = messages_of(read_mat_log, file / "scan");
  EXPECT_EQ(found.error, "");
  ASSERT_EQ(found.end.topics.size(), 1U);
  EXPECT_EQ(found.end.topics[0].messages, 3U);
  EXPECT_EQ(messages_of(read_mat_log, file / "none").error, ": is no table of that file");
  EXPECT_EQ(inspect_log(file).topics.size(), 3U);
}

TEST(MatFile, WhatItIsInsteadIsSaid) {
  const ScratchFolder scratch;
  const auto error_of = [&scratch](const std::string& bytes) {
    try {
      static_cast<void>(read_mat_file(written(scratch, bytes)));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(error_of(std::string("\x89HDF\r\n", 6) + std::string(600, '\0')).find("-v7"),
            std::string::npos);
  EXPECT_NE(error_of("t,left,right\n").find("no MATLAB file of level 5"), std::string::npos);
  EXPECT_NE(error_of("").find("no MATLAB file of level 5"), std::string::npos);
}

/// Cut off after every third byte, and each byte changed: an error of the input or a table, nothing
/// else.
TEST(MatFile, DamageIsAnErrorOfTheInput) {
  const ScratchFolder scratch;
  const std::string whole = bytes_of_hex(kBySciPy);
  int refused = 0;
  const auto try_one = [&](const std::string& bytes) {
    try {
      static_cast<void>(read_mat_file(written(scratch, bytes)));
    } catch (const InputError&) {
      ++refused;
    }
  };
  for (std::size_t size = 0; size < whole.size(); size += 3) try_one(whole.substr(0, size));
  for (std::size_t at = 124; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (at % 2 == 0 ? 0x80 : 0xff));
    try_one(bytes);
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace trussmap::mat_file_test
