// SPDX-License-Identifier: Apache-2.0
#include "terminal/error_line.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <system_error>

#include "phalanx/core/error_text.h"
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

std::string reason(const std::exception& error) {
  const std::string text = error_text(error);
  // The code that could not open something has put the system's reason into a text of its own.
  for (const std::errc limit : {std::errc::too_many_files_open, std::errc::too_many_files_open_in_system})
    if (text.find(std::make_error_code(limit).message()) != std::string::npos)
      return text + "; allow more with `ulimit -n`, or end other programs";
  const auto* of_system = dynamic_cast<const std::system_error*>(&error);
  if (of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again)
    return text +
           ": no thread or process could be made; allow more of them (`ulimit -u`) or memory (`ulimit -v`)";
  return text;
}

}  // namespace phalanx
