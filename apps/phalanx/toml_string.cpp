// SPDX-License-Identifier: Apache-2.0
#include "toml_string.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace phalanx {

// JSON's escapes are a subset of those of a TOML basic string, which must escape the character DEL, too.
std::string toml_string(const std::string& option, const std::string& text) {
  try {
    std::string quoted;
    for (const char c : nlohmann::json(text).dump()) {
      if (c == '\x7f')
        quoted += "\\u007F";
      else
        quoted += c;
    }
    return quoted;
  } catch (const nlohmann::json::type_error&) {
    const auto replace = nlohmann::json::error_handler_t::replace;
    throw std::invalid_argument(fmt::format("{} {}: the name is not valid UTF-8; rename the file", option,
                                            nlohmann::json(text).dump(-1, ' ', false, replace)));
  }
}

}  // namespace phalanx
