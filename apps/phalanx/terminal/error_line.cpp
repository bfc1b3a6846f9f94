// SPDX-License-Identifier: Apache-2.0
#include "terminal/error_line.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "terminal/emphasis.h"

namespace phalanx {

void print_error_line(std::string message) {
  std::replace_if(
      message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; },
      ' ');
  message = emphasised(Emphasis::kError, message, takes_colour(STDERR_FILENO)) + '\n';
  std::fputs(message.c_str(), stderr);
}

void print_aside(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace phalanx
