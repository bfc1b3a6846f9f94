// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace phalanx {

/// Makes a TOML string of an option's value.
/// @param option  "--object", for the message
/// @throws std::invalid_argument if the text is not valid UTF-8
[[nodiscard]] std::string option_as_toml(const std::string& option, const std::string& text);

}  // namespace phalanx
