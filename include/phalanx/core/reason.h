// SPDX-License-Identifier: Apache-2.0
// Exceptions in words for people who use a program.
#pragma once

#include <exception>
#include <string>
#include <system_error>

#include "phalanx/core/error_text.h"

namespace phalanx {

/// Describes an exception for people. It is error_text(), and a sentence if the C++ library or the system has
/// only a name: no further file descriptor or thread.
/// Set-up only: allocates.
[[nodiscard]] inline std::string reason(const std::exception& error) {
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
