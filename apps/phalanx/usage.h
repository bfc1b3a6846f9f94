// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace phalanx {

/// One line that says what is wrong with the command line and what to type instead: an unknown command or
/// option is answered with the nearest known one.
[[nodiscard]] std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace phalanx
