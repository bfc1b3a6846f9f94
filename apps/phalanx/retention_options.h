// SPDX-License-Identifier: Apache-2.0
// The options that state how long recordings are kept, of `phalanx run` and `phalanx session prune`.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

#include "phalanx/record/retention.h"

namespace phalanx {

/// @returns a check that a value is a number from 0 to `most`; CLI::Range takes "nan", too
[[nodiscard]] CLI::Validator number_up_to(double most);

/// Adds the options `<prefix>days` and `<prefix>gb` to a command.
void add_retention(CLI::App& command, std::optional<double>& days, std::optional<double>& gigabytes,
                   const std::string& prefix);
[[nodiscard]] RetentionRule retention_rule(const std::optional<double>& days,
                                           const std::optional<double>& gigabytes);

}  // namespace phalanx
