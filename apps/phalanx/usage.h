// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace phalanx {

/// Checks the values of options. `--plot` may have no value.
/// @throws std::invalid_argument naming an option that takes a value and was given an empty one
void refuse_empty_values(const CLI::App& command);

/// @returns a validator for a finite number above 0; its refusal states this, and the given value.
[[nodiscard]] CLI::Validator positive();

/// @returns the subcommands that a command's help names.
[[nodiscard]] std::vector<const CLI::App*> visible_commands(const CLI::App& command);

/// @returns every key that --set takes; "objects.0." stands for each object.
[[nodiscard]] std::vector<std::string> settable_keys();

/// Describes in one line what is wrong with the command line and what to type instead. For an unknown command
/// or option, it names the nearest known one.
[[nodiscard]] std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace phalanx
