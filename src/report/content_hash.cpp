// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/content_hash.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace trussmap::report {
namespace {

using Word = std::uint32_t;
constexpr std::size_t kBlock = 64;  // bytes

// Fractions of the cube roots of the first 64 primes, and of the square roots of the first eight.
constexpr std::array<Word, 64> kRound = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};
constexpr std::array<Word, 8> kBegin = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};

/// The 64 words W of a block of 16.
std::array<Word, 64> schedule(std::string_view block) {
  std::array<Word, 64> w{};
  for (std::size_t k = 0; k < kBlock; ++k) {
    w[k / 4] = w[k / 4] << 8U | static_cast<unsigned char>(block[k]);
  }
  for (std::size_t k = 16; k < w.size(); ++k) {
    const Word a = w[k - 15];
    const Word b = w[k - 2];
    w[k] = w[k - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3U) + w[k - 7] +
           (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10U);
  }
  return w;
}

void take(std::array<Word, 8>& hash, std::string_view block) {
  const std::array<Word, 64> w = schedule(block);
  auto [a, b, c, d, e, f, g, h] = hash;
  for (std::size_t k = 0; k < w.size(); ++k) {
    const Word first = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                       ((e & f) ^ (~e & g)) + kRound[k] + w[k];
    const Word second =
        (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + first;
    d = c;
    c = b;
    b = a;
    a = first + second;
  }
  const std::array<Word, 8> after = {a, b, c, d, e, f, g, h};
  for (std::size_t k = 0; k < hash.size(); ++k) hash[k] += after[k];
}

/// What follows the last whole block: the rest, a bit, zeros, the length in bits.
std::string end_of(std::string_view text) {
  std::string end(text.substr(text.size() - text.size() % kBlock));
  end += '\x80';
  while (end.size() % kBlock != kBlock - 8) end += '\0';
  const std::uint64_t bits = 8U * static_cast<std::uint64_t>(text.size());
  for (unsigned shift = 64; shift > 0; shift -= 8) {
    end += static_cast<char>(bits >> (shift - 8) & 0xFFU);
  }
  return end;
}

}  // namespace

std::string content_hash(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<Word, 8> hash = kBegin;
  for (std::size_t k = 0; k + kBlock <= text.size(); k += kBlock)
    take(hash, text.substr(k, kBlock));
  const std::string end = end_of(text);
  for (std::size_t k = 0; k < end.size(); k += kBlock) {
    take(hash, std::string_view(end).substr(k, kBlock));
  }
  // 256 bits and two zeros are 43 digits.
  std::string name = "sha256-";
  for (std::size_t bit = 0; bit < 256; bit += 6) {
    Word digit = 0;
    for (std::size_t k = bit; k < bit + 6; ++k) {
      digit = digit << 1U | (k < 256 ? hash[k / 32] >> (31 - k % 32) & 1U : 0U);
    }
    name += kDigits[digit];
  }
  return name + '=';
}

}  // namespace trussmap::report
