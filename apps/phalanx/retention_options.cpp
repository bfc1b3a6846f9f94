// SPDX-License-Identifier: Apache-2.0
#include "retention_options.h"

#include <fmt/format.h>

namespace phalanx {

CLI::Validator number_up_to(double most) {
  return CLI::Validator(
      [most](const std::string& text) {
        double value = 0.0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= 0.0 && value <= most;
        return good ? std::string() : fmt::format("{} is no number from 0 to {}", text, most);
      },
      "");
}

void add_retention(CLI::App& command, std::optional<double>& days, std::optional<double>& gigabytes,
                   const std::string& prefix) {
  command
      .add_option(prefix + "days", days, "recordings that began more days ago are deleted for good [none]")
      ->check(number_up_to(36525.0));
  command
      .add_option(
          prefix + "gb", gigabytes,
          "the oldest recordings are deleted for good until the others have at most so many GB [none]")
      ->check(number_up_to(1e6));
}

RetentionRule retention_rule(const std::optional<double>& days, const std::optional<double>& gigabytes) {
  RetentionRule rule;
  rule.days = days;
  if (gigabytes) rule.bytes = static_cast<std::uint64_t>(1e9 * *gigabytes);
  return rule;
}

}  // namespace phalanx
