// SPDX-License-Identifier: Apache-2.0
#include "option_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "phalanx/scene/scene_file.h"

namespace phalanx {

std::string option_as_toml(const std::string& option, const std::string& text) {
  const nlohmann::json checked(text);
  try {
    static_cast<void>(checked.dump());
  } catch (const nlohmann::json::type_error&) {
    const auto replace = nlohmann::json::error_handler_t::replace;
    throw std::invalid_argument(fmt::format("{} {}: the name is not valid UTF-8; rename the file", option,
                                            checked.dump(-1, ' ', false, replace)));
  }
  return toml_string(text);
}

}  // namespace phalanx
