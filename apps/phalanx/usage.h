// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace phalanx {

/// @throws std::invalid_argument naming the option if one that takes a value was given an empty one. `--plot`
/// may stand without a value.
void refuse_empty_values(const CLI::App& command);

/// A number of an option that is more than 0 and finite; the refusal says that, and what was given.
[[nodiscard]] CLI::Validator positive();

/// One line that says what is wrong with the command line and what to type instead: an unknown command or
/// option is answered with the nearest known one.
[[nodiscard]] std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace phalanx
