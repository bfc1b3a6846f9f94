// SPDX-License-Identifier: Apache-2.0
#include "error_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace phalanx {

void print_error_line(std::string message) {
  std::replace_if(
      message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; },
      ' ');
  fmt::print(stderr, "{}\n", message);
}

}  // namespace phalanx
