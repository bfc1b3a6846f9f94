// SPDX-License-Identifier: Apache-2.0
#include "terminal/emphasis.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace phalanx {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// @returns the control sequence of ECMA-48, Select Graphic Rendition.
const char* sequence(Emphasis emphasis) {
  switch (emphasis) {
    case Emphasis::kStrong:
      return "\033[1m";
    case Emphasis::kWarning:
      return "\033[33m";
    case Emphasis::kError:
      return "\033[31m";
  }
  return "";
}

}  // namespace

bool takes_sequences(int descriptor) {
  const std::string_view kind = environment("TERM");
  return ::isatty(descriptor) == 1 && !kind.empty() && kind != "dumb";
}

bool takes_colour(int descriptor) { return takes_sequences(descriptor) && environment("NO_COLOR").empty(); }

std::string emphasised(Emphasis emphasis, const std::string& text, bool colour) {
  return colour ? sequence(emphasis) + text + "\033[0m" : text;
}

}  // namespace phalanx
