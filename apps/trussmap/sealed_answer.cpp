// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "sealed_answer.hpp"

#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string to_base64(std::string_view bytes) {
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = k; j < k + 3; ++j) {
      three = three << 8U | (j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      const std::uint32_t digit = three >> (18U - 6U * static_cast<std::uint32_t>(j)) & 63U;
      text += k + j <= bytes.size() ? kDigits[digit] : '=';
    }
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  std::uint32_t bits = 0;
  std::uint32_t count = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = (bits << 6U | static_cast<std::uint32_t>(digit)) & 0xFFFFU;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

std::string checksum(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return fmt::format("{:016x}", hash);
}

constexpr std::uint64_t kKey = 0x7472757373206d61ULL;
constexpr const char* kCipher = "xor-mt19937-64";

/// XOR with a stream of the key and the answer's checksum: its own inverse.
std::string crossed(std::string bytes, const std::string& check) {
  std::seed_seq seed{static_cast<std::uint32_t>(kKey), static_cast<std::uint32_t>(kKey >> 32U),
                     static_cast<std::uint32_t>(std::stoul(check.substr(0, 8), nullptr, 16)),
                     static_cast<std::uint32_t>(std::stoul(check.substr(8), nullptr, 16))};
  std::mt19937_64 stream(seed);
  for (char& c : bytes) c = static_cast<char>(c ^ static_cast<char>(stream() & 0xFFU));
  return bytes;
}

bool is_checksum(const nlohmann::ordered_json& value) {
  if (!value.is_string()) return false;
  const auto& text = value.get_ref<const std::string&>();
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// The answer's JSON; none where the file is not as written.
std::optional<std::string> plain_of(const nlohmann::ordered_json& file) {
  if (!file.is_object() || !file.contains("sealed") || !file.contains("checksum") ||
      !file["sealed"].is_string() || !is_checksum(file["checksum"])) {
    return std::nullopt;
  }
  std::optional<std::string> plain = from_base64(file["sealed"].get<std::string>());
  if (plain && file.contains("cipher")) {
    if (file["cipher"] != kCipher) return std::nullopt;
    plain = crossed(std::move(*plain), file["checksum"].get<std::string>());
  }
  if (plain && file["checksum"] != checksum(*plain)) return std::nullopt;
  return plain;
}

}  // namespace

std::string sealed(const nlohmann::ordered_json& answer) {
  const std::string plain = answer.dump();
  const nlohmann::ordered_json file = {
      {"note", "The answer of trussmap simulate --hide, sealed; trussmap reveal opens it."},
      {"cipher", kCipher},
      {"sealed", to_base64(crossed(plain, checksum(plain)))},
      {"checksum", checksum(plain)}};
  return file.dump(2) + "\n";
}

nlohmann::ordered_json opened(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kSealedName;
  if (!std::filesystem::exists(path)) {
    throw InputError(path.string(), 0,
                     "there is none, expected a recording of trussmap simulate --hide");
  }
  const auto refuse = [&]() -> nlohmann::ordered_json {
    throw InputError(path.string(), 0,
                     "is broken, expected it as trussmap simulate --hide wrote it");
  };
  const auto file = nlohmann::ordered_json::parse(read_file(path), nullptr, false);
  const std::optional<std::string> plain = plain_of(file);
  if (!plain) return refuse();
  auto answer = nlohmann::ordered_json::parse(*plain, nullptr, false);
  if (!answer.is_object() || !answer.contains("effects")) return refuse();
  return answer;
}

}  // namespace trussmap::app
