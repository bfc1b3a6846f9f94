// SPDX-License-Identifier: Apache-2.0
#include <openssl/rand.h>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

#include "phalanx/serve/reach.h"

namespace phalanx {

std::string random_token() {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  constexpr std::size_t kBits = 128;
  std::array<unsigned char, kBits / 8> random{};
  if (RAND_bytes(random.data(), static_cast<int>(random.size())) != 1) {
    throw std::runtime_error("the system has no random numbers, so that no token can be made");
  }
  std::string token;
  for (std::size_t bit = 0; bit < kBits; bit += 6) {
    unsigned value = 0;
    for (std::size_t i = bit; i < bit + 6; ++i) {
      value <<= 1U;
      if (i < kBits) value |= (random[i / 8] >> (7 - i % 8)) & 1U;
    }
    token += kDigits[value];
  }
  return token;
}

}  // namespace phalanx
